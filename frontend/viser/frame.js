/**
 * Runs before viser's client in the frame of the 3D view, which is sandboxed: it has no origin, no
 * cookies, and in most browsers a process of its own. It talks to the page around by messages:
 *
 *   page to frame    {pass} the right to watch, {hold} whether frames wait while somebody paints, {ink} colour of words
 *   frame to page    {view: "loaded" | "seen" | "none" where the browser draws nothing in 3D}, {slow} whether drawing takes long
 *
 * A plain script without imports, after aside.js: the service puts it into viser's page.
 */

/* global Aside */

(() => {
  /** Frames that take longer mean a slow machine. */
  const SHORT_MS = 30;
  /** viser draws a frame every second even if nothing is new. On a slow machine such a frame waits this long, because a
   * stroke made while it is drawn is not shown before it is done. */
  const PAUSE_MS = 30_000;
  /** Frames in which a first scene is taken in; viser shows its own axes until then. */
  const FIRST_FRAMES = 3;
  /** Over viser's speed of turning. */
  const TURNING = 0.5;
  /** How long something new takes to be drawn. */
  const NEWS_MS = 1500;
  /** After this time without anything new the view is drawn smooth, where a frame is rough. */
  const REST_MS = 300;
  /** After this time it is looked whether something was drawn. */
  const ANSWER_MS = 20;
  /** Frames that shapes have to be built in, before the cloth is drawn without them. */
  const PATIENCE = 300;
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

  // --- cloth --------------------------------------------------------------------------------------
  // viser takes several frames to build new shapes of stitches. Until then those that are there neither move nor go,
  // or there would be holes in the cloth, or none to see. Everything else is handed on at once. Nothing is drawn meanwhile:
  // the canvas keeps what it has, and a frame without a GPU may take a second.
  /** @typedef {{type: string, name?: string, props?: Stitches, updates?: Stitches}} Message */
  /** Places, sizes, turns and colours of a shape's stitches. @typedef {Record<string, ArrayBufferView>} Stitches */
  /** Bytes of a stitch in each. @type {[string, number][]} */
  const BYTES = [
    ["batched_positions", 12],
    ["batched_scales", 12],
    ["batched_wxyzs", 16],
    ["batched_colors", 3],
  ];
  /** Nodes of stitches, by name. @type {Map<string, Stitches>} */
  const cloth = new Map();
  /** Names of pictures of the cloth, which viser draws white until they are decoded. @type {Set<string>} */
  const pictures = new Set();
  /** Updates of a shape that do not yet agree on the number of its stitches. @type {Map<string, Stitches>} */
  const early = new Map();
  /** What waits for new ones to be built. @type {Message[]} */
  let later = [];
  /** Frames that it has waited. */
  let waited = 0;
  /** Whether it has just been handed on, so that some of it is drawn in the next frame and the rest in the one after. */
  let mixed = false;
  /** @type {(messages: Message[]) => void} */
  let handOn = () => {};

  /** Whether stitches of this shape are drawn. @param {string} name */
  function built(name) {
    let stitches = 0;
    viser()?.nodeRefFromName[name]?.traverse((/** @type {any} */ part) => (stitches += part.instancesCount ?? 0));
    return stitches > 0;
  }

  /** Whether a picture of the cloth can be drawn. @param {string} name */
  function decoded(name) {
    let there = false;
    viser()?.nodeRefFromName[name]?.traverse((/** @type {any} */ part) => (there ||= Boolean(part.material?.map)));
    return there;
  }

  /** Whether a picture is requested. @param {Message} message */
  const isPicture = ({ type }) => type === "GetRenderRequestMessage";
  /**
   * All that is new of a shape at once, when it is of the same number of stitches: where a browser is behind, the service leaves
   * out what is outdated, and sends the colours of more stitches before their places.
   *
   * @param {Message[]} messages
   */
  function gathered(messages) {
    const names = new Set();
    const others = messages.filter(({ type, name = "", props, updates }) => {
      if (type === "BatchedMeshesMessage" && props) cloth.set(name, props);
      if (type !== "SceneNodeUpdateMessage" || !cloth.has(name)) return true;
      early.set(name, { ...early.get(name), ...updates });
      names.add(name);
      return false;
    });
    const moved = [...names].flatMap((name) => {
      const whole = { ...cloth.get(name), ...early.get(name) };
      const [count, ...counts] = BYTES.map(([what, bytes]) => (whole[what]?.byteLength ?? NaN) / bytes);
      if (counts.some((other) => other !== count)) return [];
      const updates = early.get(name);
      early.delete(name);
      cloth.set(name, whole);
      return [{ type: "SceneNodeUpdateMessage", name, updates, owner: "" }];
    });
    return [...moved, ...others];
  }

  /** Whether it must not come before new shapes are built; a picture is of the whole cloth. @param {Message} message */
  const changes = (message) =>
    isPicture(message) ||
    (["SceneNodeUpdateMessage", "RemoveSceneNodeMessage"].includes(message.type) && cloth.has(message.name ?? ""));

  /** What of some messages is handed on at once. @param {Message[]} sent */
  function prompt(sent) {
    const messages = gathered(sent);
    const added = messages.filter(({ type }) => type === "BatchedMeshesMessage");
    // A page that nobody looks at has no frames to wait for.
    const wait = !document.hidden && (later.length > 0 || (added.length > 0 && [...cloth.keys()].some(built)));
    const held = wait ? messages.filter(changes) : [];
    const rest = wait ? messages.filter((message) => !changes(message)) : [...later.splice(0), ...messages];
    later.push(...held);
    for (const { type, name = "" } of messages) {
      if (type === "ImageMessage") pictures.add(name);
      if (type !== "RemoveSceneNodeMessage") continue;
      cloth.delete(name);
      pictures.delete(name);
    }
    return rest;
  }

  /** Whether all shapes are built, and their pictures decoded. */
  const complete = () => [...cloth.keys()].every(built) && [...pictures].every(decoded);

  /** After each frame. */
  function catchUp() {
    if (!complete() && ++waited < PATIENCE) return;
    if (waited === PATIENCE) {
      for (const name of cloth.keys()) if (!built(name)) cloth.delete(name);
      for (const name of pictures) if (!decoded(name)) pictures.delete(name);
    }
    waited = 0;
    if (!later.length) return;
    mixed = !later.some(isPicture);
    handOn(later.splice(0));
  }

  const Threads = Worker;
  window.Worker = class extends Threads {
    /** Once an attempt has failed the client begins a new one every second and drops the one before. A busy
     * machine needs longer, and would never be connected: an attempt has the time the client allows it. */
    #connecting = false;

    /** @param {string | URL} url @param {WorkerOptions} [options] */
    constructor(url, options) {
      super(plain(url), { ...options, type: "classic" });
      handOn = (messages) => {
        this.onmessage?.(new MessageEvent("message", { data: { type: "message_batch", messages } }));
        wake(true);
      };
      this.addEventListener("message", ({ data }) => {
        if (data.type === "message_batch") {
          data.messages = prompt(data.messages);
          wake(true);
        }
        if (data.type === "connected" || data.type === "closed") this.#connecting = false;
        if (data.type === "connected") {
          cloth.clear();
          pictures.clear();
          early.clear();
          later = [];
        }
      });
    }

    /** @param {any} message @param {any} [rest] @override */
    postMessage(message, rest) {
      if (message.type === "retry" && this.#connecting) return;
      if (message.type === "set_server" || message.type === "retry") this.#connecting = true;
      if (message.type !== "set_server") super.postMessage(message, rest);
      // The service lets in who has a pass; the page brings it when there is something to see.
      // The service sends fewer triangles to a browser without a GPU.
      else
        void pass.then((code) => {
          const server = `${message.server}?pass=${code}${withoutGpu() ? "&coarse=1" : ""}`;
          super.postMessage({ ...message, server });
        });
    }
  };

  // --- frames -------------------------------------------------------------------------------------
  /** Callbacks that wait. @type {Map<number, FrameRequestCallback>} */
  const waiting = new Map();
  const request = window.requestAnimationFrame.bind(window);
  const cancel = window.cancelAnimationFrame.bind(window);
  /** Far from the browser's own numbers, and from those below 0 by which viser's libraries mean none. */
  let next = 1e9;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let pause;
  /** When something new came last. */
  let news = 0;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let smoothing;
  /** Where the camera was in the last frame that was not shifted. */
  let from = "";
  let lastEnd = 0;
  let held = false;
  let seen = false;
  let slow = false;
  /** Where viser draws. @type {WebGL2RenderingContext | null} */
  let gl = null;
  /** Shows what is drawn, without a GPU. @type {Aside | null} */
  let aside = null;
  /** The canvas on which it is shown. @type {HTMLCanvasElement | null} */
  let canvas = null;
  /** Frames since the first scene came; below 0 there is none. */
  let fed = -1;
  /** How long a frame takes, in ms. */
  let cost = 0;
  /** Whether what viser draws now is left out. */
  let muted = false;
  /** Have viser draw though nothing is new. */
  let drawAgain = () => {};
  /** Whether it has begun to draw; it asks for more frames than it draws. */
  let begun = false;

  window.requestAnimationFrame = (callback) => {
    if (!held && !aside?.busy && rest() === 0) return request((time) => frame(callback, time));
    const id = next++;
    waiting.set(id, callback);
    release();
    return id;
  };
  window.cancelAnimationFrame = (id) => {
    if (!waiting.delete(id)) cancel(id);
  };

  /** Time until the next frame may be drawn, in ms: on a slow machine viser's idle frames wait. */
  function rest() {
    const now = performance.now();
    if (!slow || !seen || now < news + NEWS_MS || aside?.shift) return 0;
    return Math.max(0, lastEnd + PAUSE_MS - now);
  }

  function release() {
    clearTimeout(pause);
    if (held || aside?.busy) return;
    const left = rest();
    if (left > 0) pause = setTimeout(release, left);
    else draw();
  }

  /** What waits, in the browser's next frame. */
  function draw() {
    const callbacks = [...waiting.values()];
    waiting.clear();
    for (const callback of callbacks) request((time) => frame(callback, time));
  }

  /** @param {FrameRequestCallback} callback @param {number} time */
  function frame(callback, time) {
    const start = performance.now();
    const query = !seen && fed >= FIRST_FRAMES ? gl?.createQuery() : null;
    if (query) gl?.beginQuery(gl.ANY_SAMPLES_PASSED, query);
    const idle = mixed || !complete();
    muted = idle;
    begun = false;
    const shift =
      seen && !idle && start >= news + REST_MS && from && seenFrom() === from ? (aside?.shift ?? null) : null;
    if (shift) drawShifted(shift, () => callback(time));
    else callback(time);
    const drawn = begun && !idle;
    if (begun) mixed = false;
    if (drawn && seenFrom() !== from) wake(false); // it glides to its rest
    if (drawn && !shift) from = seenFrom();
    muted = false;
    if (query) gl?.endQuery(gl.ANY_SAMPLES_PASSED);
    steer();
    if (fed >= 0) fed++;
    const ended = () => {
      if (idle) viser()?.requestRender();
      else timed(start);
      if (query) answer(query);
      catchUp();
      smooth();
      release();
    };
    // What the browser itself does for the frame counts, too.
    if (aside && drawn) aside.show(request, ended, shift ? () => news < start : null);
    else setTimeout(ended);
  }

  /** Ask for a frame more of a smooth picture, once nothing new has come for a while. */
  function smooth() {
    clearTimeout(smoothing);
    if (aside?.shift) smoothing = setTimeout(() => drawAgain(), Math.max(0, news + REST_MS - performance.now()));
  }

  /** Draw with what the camera sees shifted, in pixels. @param {[number, number]} shift @param {() => void} draws */
  function drawShifted([right, up], draws) {
    const { elements } = viser().camera.projectionMatrix;
    const [x, y] = [elements[8], elements[9]];
    elements[8] += (2 * right) / /** @type {WebGL2RenderingContext} */ (gl).drawingBufferWidth;
    elements[9] += (2 * up) / /** @type {WebGL2RenderingContext} */ (gl).drawingBufferHeight;
    draws();
    [elements[8], elements[9]] = [x, y];
  }

  /** Where the camera is. */
  const seenFrom = () => String(viser()?.camera?.matrixWorld.elements ?? "");

  /** A frame ends that was begun at this time. @param {number} start */
  function timed(start) {
    lastEnd = performance.now();
    cost = (cost + lastEnd - start) / 2;
    if (slow === cost > SHORT_MS) return;
    slow = !slow;
    tell({ slow });
  }

  /** Zoom to the pointer, not to the middle, and turn half as fast as viser does. A frame that viser requests shows something
   * new, and is not left to wait. */
  function steer() {
    const client = viser();
    const control = client?.cameraControl;
    if (!control || control.dollyToCursor) return;
    const { requestRender } = client;
    drawAgain = requestRender;
    client.requestRender = () => {
      wake(false);
      requestRender();
    };
    Object.assign(control, { dollyToCursor: true, azimuthRotateSpeed: TURNING, polarRotateSpeed: TURNING });
  }

  /** Something new is to be drawn. @param {boolean} scene sent by the service */
  function wake(scene) {
    if (scene && fed < 0) fed = 0;
    news = performance.now();
    smooth();
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
    const isSoftware = info && SOFTWARE.test(gl?.getParameter(info.UNMASKED_RENDERER_WEBGL));
    gl?.getExtension("WEBGL_lose_context")?.loseContext();
    return Boolean(isSoftware);
  };
  const withoutGpu = () =>
    (software ??= drawnBySoftware(
      /** @type {WebGL2RenderingContext | null} */ (context.call(document.createElement("canvas"), "webgl2")),
    ));
  /** Let it draw only what is to be seen, and whatever there is where a canvas of another size has lost its picture. @param {any} gl */
  function mutable(gl) {
    let drawn = "";
    for (const name of ["clear", "drawArrays", "drawArraysInstanced", "drawElements", "drawElementsInstanced"]) {
      const draw = gl[name].bind(gl);
      gl[name] = (/** @type {any[]} */ ...how) => {
        begun = true;
        const size = `${gl.drawingBufferWidth}×${gl.drawingBufferHeight}`;
        if (!aside && drawn !== size) muted = false;
        if (muted) return;
        drawn = size;
        draw(...how);
      };
    }
  }

  /** @param {string} kind @param {any} [options] @returns {any} */
  HTMLCanvasElement.prototype.getContext = function (kind, options) {
    if (this === canvas && kind === "webgl2") return gl;
    if (!options?.antialias || !kind.startsWith("webgl")) {
      const made = context.call(this, kind, options);
      if (!made && kind === "webgl2") tell({ view: "none" });
      return made;
    }
    canvas = this;
    if (withoutGpu()) aside = new Aside(this, context, { ...options, antialias: false });
    gl = aside ? aside.gl : /** @type {WebGL2RenderingContext | null} */ (context.call(this, kind, options));
    if (gl) mutable(gl);
    // On a slow machine viser draws fewer pixels, and a canvas of another size is empty until it is drawn again:
    // that is not left to wait, even while somebody paints.
    if (!aside) new MutationObserver(draw).observe(this, { attributeFilter: ["width", "height"] });
    return gl;
  };

  // --- the page around ----------------------------------------------------------------------------
  addEventListener("message", ({ source, data }) => {
    if (source !== parent) return;
    if (typeof data.pass === "string") givePass(data.pass);
    if (typeof data.hold === "boolean") {
      held = data.hold;
      release();
    }
  });
  tell({ view: "loaded" });
})();
