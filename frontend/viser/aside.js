/**
 * Without a GPU a browser that shows what WebGL drew waits until all of it is drawn, in a process that its
 * pages share: for as long as a frame of the 3D view takes, the page around shows nothing new. So frames are
 * drawn out of sight, and the canvas gets each as a picture once it is finished. A frame has rough edges, as smoothing it
 * at once would take two to four times as long; where nothing moves it is drawn again, each time shifted by another part
 * of a pixel, and the mean of all is shown.
 *
 * A plain script without imports, before frame.js: the service puts it into viser's page.
 */

/** Time between two looks whether a frame is finished. */
const LOOK_MS = 4;
/** Parts of a pixel by which the frames of a smooth picture are shifted, right and up: each eighth once, and the first not at all. */
const SHIFTS = /** @type {[number, number][]} */ (
  [
    [0, 0],
    [3, -1],
    [-1, 3],
    [1, -3],
    [-3, 1],
    [2, 2],
    [-2, -2],
    [-4, 4],
  ].map((place) => place.map((step) => step / 8))
);

// eslint-disable-next-line no-unused-vars -- frame.js has it
class Aside {
  /** What viser draws with. @type {WebGL2RenderingContext} */
  gl;
  /** Whether a frame is being drawn, or on its way to the canvas. */
  busy = false;
  #canvas;
  #shown;
  /** WebGL's own memory for the pixels of a frame, and ours. */
  #read;
  #bytes = new Uint8Array();
  /** Pixels of the frame of what is shown that was not shifted. */
  #plain = new Uint8Array();
  /** Sum of the frames that are shown. */
  #sum = new Uint16Array();
  /** How many they are. */
  #frames = 0;
  /** Number of the frame that was drawn last. */
  #frame = 0;

  /**
   * @param {HTMLCanvasElement} canvas as viser has it; its size is that of what is drawn
   * @param {(kind: string, options?: object) => any} getContext of canvases
   * @param {object} options of the context
   */
  constructor(canvas, getContext, options) {
    this.#canvas = canvas;
    this.#shown = /** @type {CanvasRenderingContext2D} */ (getContext.call(canvas, "2d"));
    const drawn = new OffscreenCanvas(canvas.width, canvas.height);
    this.gl = /** @type {WebGL2RenderingContext} */ (drawn.getContext("webgl2", options));
    this.#read = this.gl.createBuffer();
    const { readPixels } = this.gl;
    // At its start viser tries whether it can read a pixel, and would wait for the answer. It can.
    this.gl.readPixels = (/** @type {any[]} */ ...how) => {
      if (typeof how[6] === "number") readPixels.apply(this.gl, /** @type {any} */ (how));
      else how[6].fill(1);
    };
    for (const side of /** @type {const} */ (["width", "height"])) {
      const get = () => drawn[side];
      const set = (/** @type {number} */ value) => {
        drawn[side] = value;
      };
      Object.defineProperty(canvas, side, { get, set });
    }
    const { drawImage } = CanvasRenderingContext2D.prototype;
    const paint = () => this.#paint();
    CanvasRenderingContext2D.prototype.drawImage = function (/** @type {any[]} */ ...how) {
      if (how[0] === canvas) paint(); // viser takes a picture of it
      drawImage.apply(this, /** @type {any} */ (how));
    };
  }

  /** Have the pixels brought when they are finished; nobody waits for it. */
  #fetch() {
    const { gl } = this;
    const { drawingBufferWidth: width, drawingBufferHeight: height } = gl;
    const bytes = 4 * width * height;
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, this.#read);
    if (this.#bytes.length !== bytes) {
      this.#bytes = new Uint8Array(bytes);
      gl.bufferData(gl.PIXEL_PACK_BUFFER, bytes, gl.DYNAMIC_COPY);
    }
    const target = gl.getParameter(gl.READ_FRAMEBUFFER_BINDING);
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, null);
    gl.readPixels(0, 0, width, height, gl.RGBA, gl.UNSIGNED_BYTE, 0);
    gl.bindFramebuffer(gl.READ_FRAMEBUFFER, target);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
    return { width, height };
  }

  /** By how much the next frame of a smooth picture is to be shifted, in pixels; null once it is smooth. */
  get shift() {
    return SHIFTS[this.#frames] ?? null;
  }

  /** Take the pixels in, as a new picture or as one more frame of the last; false where nothing is new. @param {boolean} more */
  #take(more) {
    const { gl } = this;
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, this.#read);
    gl.getBufferSubData(gl.PIXEL_PACK_BUFFER, 0, this.#bytes);
    gl.bindBuffer(gl.PIXEL_PACK_BUFFER, null);
    if (more && this.#sum.length === this.#bytes.length) {
      for (let at = 0; at < this.#bytes.length; at++) this.#sum[at] += this.#bytes[at];
      this.#frames++;
      return true;
    }
    const [before, now] = [this.#plain, this.#bytes].map(({ buffer }) => new Uint32Array(buffer));
    if (before.length === now.length && before.every((pixel, at) => pixel === now[at])) return false;
    this.#plain = this.#bytes.slice();
    this.#sum = Uint16Array.from(this.#bytes);
    this.#frames = 1;
    return true;
  }

  /** Show the pixels. WebGL has the lowest row first, and colours that are multiplied by their cover. */
  #paint(size = this.#fetch(), more = false) {
    if (!this.#take(more)) return;
    const { width, height } = size;
    const image = new ImageData(width, height);
    const { data } = image;
    const long = 4 * width;
    for (let row = 0; row < height; row++) {
      const from = long * (height - 1 - row);
      for (let at = 0; at < long; at++) data[long * row + at] = Math.round(this.#sum[from + at] / this.#frames);
    }
    for (let alpha = 3; alpha < data.length; alpha += 4) {
      const cover = data[alpha] / 255;
      if (cover > 0 && cover < 1) for (let at = alpha - 3; at < alpha; at++) data[at] /= cover;
    }
    for (const [side, length] of Object.entries(size)) {
      const own = Object.getOwnPropertyDescriptor(HTMLCanvasElement.prototype, side);
      if (own?.get?.call(this.#canvas) !== length) own?.set?.call(this.#canvas, length);
    }
    this.#shown.putImageData(image, 0, 0);
  }

  /**
   * Show a frame when it is finished.
   *
   * @param {(paint: FrameRequestCallback) => unknown} request the browser's next frame
   * @param {() => void} then
   * @param {(() => boolean) | null} still of a shifted frame: whether what is shown is still the same
   */
  show(request, then, still = null) {
    const frame = ++this.#frame;
    const current = () => frame === this.#frame; // viser may draw several before the browser shows one
    this.busy = true;
    const end = () => {
      if (!current()) return;
      this.busy = false;
      then();
    };
    this.#finished(() => {
      if (!current()) return;
      const size = this.#fetch();
      const paint = () => {
        if (!current()) return;
        if (!this.gl.isContextLost() && (still?.() ?? true)) this.#paint(size, still !== null);
        setTimeout(end);
      };
      this.#finished(() => request(paint));
    });
  }

  /** When all that was asked of WebGL is done. @param {() => void} then */
  #finished(then) {
    const { gl } = this;
    const sync = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    const look = () => {
      if (sync && !gl.isContextLost() && gl.getSyncParameter(sync, gl.SYNC_STATUS) !== gl.SIGNALED) {
        setTimeout(look, LOOK_MS);
        return;
      }
      gl.deleteSync(sync);
      then();
    };
    setTimeout(look, LOOK_MS);
  }
}
