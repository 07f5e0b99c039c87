/**
 * Runs before viser's client in the frame of the 3D view, which is sandboxed: it has no origin, no
 * cookies, and in most browsers a process of its own. It talks to the page around by messages:
 *
 *   page to frame    {pass} the right to watch, {hold} whether frames wait while somebody paints
 *   frame to page    {view: "loaded" | "seen" | "lost", its connection | "none" where the browser draws nothing in 3D},
 *                    {slow} whether drawing takes long
 *
 * A plain script without imports: the service puts it into viser's page.
 */

(() => {
  /** Frames that take longer mean a slow machine. */
  const SHORT_MS = 30;
  /** After an idle frame others wait so many times as long as it took, at most so long. */
  const IDLE = 8;
  const MAX_PAUSE_MS = 4000;
  /** Frames in which a first scene is taken in; viser shows its own axes until then. */
  const FIRST_FRAMES = 3;
  /** Over viser's speed of turning. */
  const TURNING = 0.5;
  /** How long something new takes to be drawn. */
  const NEWS_MS = 1500;
  /** After this time it is looked whether something was drawn. */
  const ANSWER_MS = 20;
  /** Frames that a cloth has to be built in, before the one on show may be taken away all the same. */
  const PATIENCE = 100;
  /** Drawn without a GPU: smoothing edges would take three times as long as all the rest. */
  const SOFTWARE = /swiftshader|llvmpipe|software|basic render/i;

  /** viser's own state, once it runs. @returns {any} */
  const viser = () => /** @type {any} */ (window).__viserMutable;
  /** @param {Record<string, unknown>} message */
  const tell = (message) => parent !== window && parent.postMessage(message, "*");

  // --- connection ---------------------------------------------------------------------------------
  // viser's client connects again only while its window has the focus, which a frame rarely has: a
  // first connection that took too long, or one that was lost, would leave the view empty.
  document.hasFocus = () => true;

  /** @type {(pass: string) => void} */
  let givePass = () => {};
  /** @type {Promise<string>} */
  const pass = new Promise((give) => (givePass = give));
  if (location.hash) givePass(location.hash.slice(1));

  /** A worker's module as a plain script: Chromium starts no module in a frame without origin. @param {string | URL} url */
  const plain = (url) => {
    const reading = new XMLHttpRequest();
    reading.open("GET", url, false); // of a blob in memory
    reading.send();
    return URL.createObjectURL(new Blob([reading.responseText.replaceAll("import.meta.url", "''")]));
  };

  // The service sends a new cloth; a moment later it shows that and takes the one before it away. A browser that
  // is behind learns of both at once, and would show no cloth in the frames that it builds the new one in.
  /** @typedef {{type: string, name: string, visible?: boolean}} Message */
  /** Parts of cloths that viser was told of, by name. @type {Set<string>} */
  const cloths = new Set();
  /** Called after each frame. */
  let drawn = () => {};

  /** Whether viser has built all of them. */
  function built() {
    return [...cloths].every((name) => {
      let stitches = 0;
      viser()?.nodeRefFromName[name]?.traverse((/** @type {any} */ part) => (stitches += part.instancesCount ?? 0));
      return stitches > 0;
    });
  }

  /** Whether it changes which cloth is seen. @param {Message} message */
  function changes({ type, name, visible }) {
    const seen = type === "RemoveSceneNodeMessage" || (type === "SetSceneNodeVisibilityMessage" && visible);
    return seen && cloths.has(name);
  }

  const Threads = Worker;
  window.Worker = class extends Threads {
    /** Once an attempt has failed the client begins a new one every second and drops the one before. A busy
     * machine needs longer, and would never be connected: an attempt has the time the client allows it. */
    #connecting = false;
    /** What waits for a cloth to be built. @type {Message[]} */
    #later = [];
    /** Frames that it has waited. */
    #frames = 0;

    /** @param {string | URL} url @param {WorkerOptions} [options] */
    constructor(url, options) {
      super(plain(url), { ...options, type: "classic" });
      this.addEventListener("message", (event) => {
        const { type, messages } = event.data;
        if (type === "message_batch") {
          event.stopImmediatePropagation();
          this.#later.push(...messages);
          this.#pass();
          return;
        }
        if (type === "connected") {
          this.#connecting = false;
          this.#later = [];
          cloths.clear();
          drawn = () => this.#drawn();
        }
        if (type === "closed") {
          this.#connecting = false;
          if (seen) tell({ view: "lost" });
          [seen, fed] = [false, -1];
        }
      });
    }

    #drawn() {
      if (!this.#later.length) return;
      this.#frames++;
      this.#pass();
      if (this.#later.length) viser()?.requestRender();
    }

    /** Hand on what need not wait. A page that nobody looks at draws no frames to wait for. */
    #pass() {
      const patient = this.#frames < PATIENCE && !document.hidden;
      let count = 0;
      for (const message of this.#later) {
        if (patient && changes(message) && !built()) break;
        if (message.type === "BatchedMeshesMessage") cloths.add(message.name);
        if (message.type === "RemoveSceneNodeMessage") cloths.delete(message.name);
        count++;
      }
      if (!count) return;
      this.#frames = 0;
      const data = { type: "message_batch", messages: this.#later.splice(0, count) };
      this.onmessage?.(new MessageEvent("message", { data }));
      wake(true);
    }

    /** @param {any} message @param {any} [rest] @override */
    postMessage(message, rest) {
      if (message.type === "retry" && this.#connecting) return;
      if (message.type === "set_server" || message.type === "retry") this.#connecting = true;
      if (message.type !== "set_server") super.postMessage(message, rest);
      // The service lets in who has a pass; the page brings it when there is something to see.
      else void pass.then((code) => super.postMessage({ ...message, server: `${message.server}?pass=${code}` }));
    }
  };

  // --- frames -------------------------------------------------------------------------------------
  /** Callbacks that wait. @type {Map<number, FrameRequestCallback>} */
  const waiting = new Map();
  const request = window.requestAnimationFrame.bind(window);
  let next = 1;
  /** Whether the browser was asked for its next frame. */
  let asked = false;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let pause;
  let newsUntil = 0;
  let lastEnd = 0;
  let held = false;
  let seen = false;
  let slow = false;
  /** Where viser draws. @type {WebGL2RenderingContext | null} */
  let gl = null;
  /** A canvas of another size is empty until it is drawn. */
  const resized = new MutationObserver(() => frame(performance.now()));
  /** Frames since the first scene came; below 0 there is none. */
  let fed = -1;
  /** How long a frame takes, in ms. */
  let cost = 0;

  window.requestAnimationFrame = (callback) => {
    waiting.set(next, callback);
    release();
    return next++;
  };
  window.cancelAnimationFrame = (id) => void waiting.delete(id);

  /** Time until the next frame may be drawn, in ms: on a slow machine viser's idle frames wait. */
  function rest() {
    const now = performance.now();
    if (!slow || !seen || now < newsUntil) return 0;
    return Math.max(0, lastEnd + Math.min(IDLE * cost, MAX_PAUSE_MS) - now);
  }

  function release() {
    clearTimeout(pause);
    if (held || asked || !waiting.size) return;
    const left = rest();
    if (left > 0) pause = setTimeout(release, left);
    else {
      asked = true;
      request((time) => {
        asked = false;
        if (!held) frame(time);
      });
    }
  }

  /** Everything that waits. @param {number} time */
  function frame(time) {
    const start = performance.now();
    const callbacks = [...waiting.values()];
    waiting.clear();
    const query = !seen && fed >= FIRST_FRAMES ? gl?.createQuery() : null;
    if (query) gl?.beginQuery(gl.ANY_SAMPLES_PASSED, query);
    for (const callback of callbacks) callback(time);
    if (query) {
      gl?.endQuery(gl.ANY_SAMPLES_PASSED);
      answer(query);
    }
    resized.takeRecords(); // of another size now, and drawn
    steer();
    if (fed >= 0) fed++;
    // What the browser itself does for the frame counts, too.
    setTimeout(() => {
      lastEnd = performance.now();
      cost = (cost + lastEnd - start) / 2;
      if (slow !== cost > SHORT_MS) {
        slow = !slow;
        tell({ slow });
      }
      drawn();
    });
  }

  /** Zoom to the pointer, not to the middle, and turn half as fast as viser does. */
  function steer() {
    const control = viser()?.cameraControl;
    if (!control || control.dollyToCursor) return;
    Object.assign(control, { dollyToCursor: true, azimuthRotateSpeed: TURNING, polarRotateSpeed: TURNING });
  }

  /** Something new is to be drawn. @param {boolean} scene sent by the service */
  function wake(scene) {
    if (scene && fed < 0) fed = 0;
    newsUntil = performance.now() + NEWS_MS;
    release();
  }
  for (const name of ["pointerdown", "pointermove", "wheel", "keydown", "resize"]) {
    addEventListener(name, () => wake(false), { passive: true });
  }

  /** Tell the page once a frame has drawn anything; reading its picture would stop the GPU. @param {WebGLQuery} query */
  function answer(query) {
    setTimeout(() => {
      if (!gl?.getQueryParameter(query, gl.QUERY_RESULT_AVAILABLE)) {
        answer(query);
        return;
      }
      const drawn = gl.getQueryParameter(query, gl.QUERY_RESULT);
      gl.deleteQuery(query);
      if (!drawn || seen) return;
      seen = true;
      tell({ view: "seen" });
    }, ANSWER_MS);
  }

  // --- without a GPU ------------------------------------------------------------------------------
  /** @type {boolean | null} */
  let software = null;
  const context = HTMLCanvasElement.prototype.getContext;
  /** @param {WebGL2RenderingContext | null} gl */
  const drawnBySoftware = (gl) => {
    const info = gl?.getExtension("WEBGL_debug_renderer_info");
    const found = info && SOFTWARE.test(gl?.getParameter(info.UNMASKED_RENDERER_WEBGL));
    gl?.getExtension("WEBGL_lose_context")?.loseContext();
    return Boolean(found);
  };
  /** @param {string} kind @param {any} [options] @returns {any} */
  HTMLCanvasElement.prototype.getContext = function (kind, options) {
    if (!options?.antialias || !kind.startsWith("webgl")) {
      const made = context.call(this, kind, options);
      if (!made && kind === "webgl2") tell({ view: "none" });
      return made;
    }
    const probe = document.createElement("canvas");
    software ??= drawnBySoftware(/** @type {WebGL2RenderingContext | null} */ (context.call(probe, "webgl2")));
    gl = /** @type {WebGL2RenderingContext | null} */ (context.call(this, kind, { ...options, antialias: !software }));
    // On a slow machine viser draws fewer pixels. That is not left to wait, even while somebody paints.
    resized.observe(this, { attributeFilter: ["width", "height"] });
    return gl;
  };

  // --- the page around ----------------------------------------------------------------------------
  addEventListener("message", ({ source, data }) => {
    if (source !== parent) return;
    if (typeof data.pass === "string") givePass(data.pass);
    if (typeof data.hold === "boolean") {
      held = data.hold;
      if (!held) wake(false); // what came meanwhile is news now
    }
  });
  tell({ view: "loaded" });
})();
