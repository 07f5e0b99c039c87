/**
 * Without a GPU a browser that shows what WebGL drew waits until all of it is drawn, in a process that its
 * pages share: for as long as a frame of the 3D view takes, the page around shows nothing new. So frames are
 * drawn beside the canvas, which gets a frame, and its size, once it is finished.
 *
 * A plain script without imports, before frame.js: the service puts it into viser's page.
 */

/** Time between two looks whether a frame is finished. */
const LOOK_MS = 4;

// eslint-disable-next-line no-unused-vars -- frame.js has it
class Aside {
  #gl;
  #canvas;
  #bind;
  /** The framebuffer that is drawn to, and what it consists of. */
  #beside;
  #colour;
  #depth;
  /** The size that viser gave the canvas last, and that of the framebuffer. */
  #wanted;
  #size = { width: 0, height: 0 };
  /** Where viser draws to and reads from: our framebuffer, or one of its own. */
  #target;
  #source;
  /** Number of the frame that was drawn last. */
  #frame = 0;
  /** Whether a frame is being drawn, or on its way to the canvas. */
  busy = false;

  /** @param {WebGL2RenderingContext} gl */
  constructor(gl) {
    this.#gl = gl;
    this.#canvas = /** @type {HTMLCanvasElement} */ (gl.canvas);
    const { width, height } = this.#canvas;
    const wanted = (this.#wanted = { width, height });
    for (const side of /** @type {const} */ (["width", "height"])) {
      const get = () => wanted[side];
      const set = (/** @type {number} */ value) => {
        wanted[side] = value;
      };
      Object.defineProperty(this.#canvas, side, { get, set });
      Object.defineProperty(gl, side === "width" ? "drawingBufferWidth" : "drawingBufferHeight", { get });
    }
    const { bindFramebuffer, drawBuffers, clear } = gl;
    this.#bind = bindFramebuffer.bind(gl);
    this.#beside = this.#target = this.#source = gl.createFramebuffer();
    this.#colour = gl.createRenderbuffer();
    this.#depth = gl.createRenderbuffer();
    gl.bindFramebuffer = (where, framebuffer) => {
      framebuffer ??= this.#beside;
      if (where !== gl.READ_FRAMEBUFFER) this.#target = framebuffer;
      if (where !== gl.DRAW_FRAMEBUFFER) this.#source = framebuffer;
      this.#bind(where, framebuffer);
    };
    gl.drawBuffers = (buffers) => {
      const named = [...buffers].map((buffer) => (buffer === gl.BACK ? gl.COLOR_ATTACHMENT0 : buffer));
      drawBuffers.call(gl, named);
    };
    gl.clear = (what) => {
      this.#fit(); // each frame begins with this
      clear.call(gl, what);
    };
    this.#fit();
    const { drawImage } = CanvasRenderingContext2D.prototype;
    const copy = () => this.#copy();
    CanvasRenderingContext2D.prototype.drawImage = function (/** @type {any[]} */ ...how) {
      if (how[0] === gl.canvas) copy(); // viser takes a picture of it
      drawImage.apply(this, /** @type {any} */ (how));
    };
  }

  /** As large as the canvas should be. */
  #fit() {
    const gl = this.#gl;
    const { width, height } = this.#wanted;
    if (width === this.#size.width && height === this.#size.height) return;
    this.#size = { width, height };
    this.#bind(gl.FRAMEBUFFER, this.#beside);
    for (const [buffer, place, format] of /** @type {const} */ ([
      [this.#colour, gl.COLOR_ATTACHMENT0, gl.RGBA8],
      [this.#depth, gl.DEPTH_ATTACHMENT, gl.DEPTH_COMPONENT24],
    ])) {
      gl.bindRenderbuffer(gl.RENDERBUFFER, buffer);
      gl.renderbufferStorage(gl.RENDERBUFFER, format, width, height);
      gl.framebufferRenderbuffer(gl.FRAMEBUFFER, place, gl.RENDERBUFFER, buffer);
    }
    this.#back();
  }

  /** Bind what viser has bound. */
  #back() {
    this.#bind(this.#gl.DRAW_FRAMEBUFFER, this.#target);
    this.#bind(this.#gl.READ_FRAMEBUFFER, this.#source);
  }

  /** Give the canvas what was drawn last. */
  #copy() {
    const gl = this.#gl;
    const { width, height } = this.#size;
    for (const side of /** @type {const} */ (["width", "height"])) {
      const own = Object.getOwnPropertyDescriptor(HTMLCanvasElement.prototype, side);
      if (own?.get?.call(this.#canvas) !== this.#size[side]) own?.set?.call(this.#canvas, this.#size[side]);
    }
    this.#bind(gl.READ_FRAMEBUFFER, this.#beside);
    this.#bind(gl.DRAW_FRAMEBUFFER, null);
    gl.blitFramebuffer(0, 0, width, height, 0, 0, width, height, gl.COLOR_BUFFER_BIT, gl.NEAREST);
    this.#back();
  }

  /**
   * Give the canvas a frame when it is finished.
   *
   * @param {(paint: FrameRequestCallback) => unknown} request the browser's next frame
   * @param {() => void} then
   */
  show(request, then) {
    const gl = this.#gl;
    const frame = ++this.#frame;
    const sync = gl.fenceSync(gl.SYNC_GPU_COMMANDS_COMPLETE, 0);
    gl.flush();
    this.busy = true;
    const end = () => {
      if (frame !== this.#frame) return; // several draw in one of the browser's frames
      this.busy = false;
      then();
    };
    const look = () => {
      const drawing = sync && !gl.isContextLost() && gl.getSyncParameter(sync, gl.SYNC_STATUS) !== gl.SIGNALED;
      if (drawing && frame === this.#frame) {
        setTimeout(look, LOOK_MS);
        return;
      }
      gl.deleteSync(sync);
      if (frame !== this.#frame) end();
      else
        request(() => {
          this.#copy();
          setTimeout(end); // the browser shows it before more is drawn, for which it would wait
        });
    };
    setTimeout(look, LOOK_MS);
  }
}
