/**
 * Keeps the 3D viewer from taking the page's time. The viewer draws when it has something new, and
 * shares our thread; where there is no GPU one of its frames takes longer than a brush stroke may. So
 * its frames wait while somebody paints, and after a long frame the page has the thread for a while.
 */

/** Frames that take longer mean a slow machine. */
const SHORT_MS = 30;
/** So many times as long as a long frame took the page has the thread: with news from the service, and without. */
const PAUSE = { news: 1, idle: 8 };
/** At most; the first cloth is not kept waiting. */
const MAX_PAUSE_MS = 4000;
/** Frames in which a first scene is taken in; viser shows its own axes until then. */
const FIRST_FRAMES = 3;
/** How long something new takes to be drawn. */
const NEWS_MS = 1500;
/** Side of the small picture that tells whether something is drawn. */
const SAMPLE = 24;

export class FrameGovernor {
  /** Callbacks that wait. @type {Map<number, FrameRequestCallback>} */ #waiting = new Map();
  /** @type {((callback: FrameRequestCallback) => number) | null} */ #request = null;
  #next = 1;
  /** @type {ReturnType<typeof setTimeout> | undefined} */ #pause;
  #newsUntil = 0;
  #lastEnd = 0;
  #held = false;
  /** Frames since the first scene came; below 0 there is none. */
  #fed = -1;
  /** How long a frame keeps the thread, in ms. */
  #cost = 0;

  /** What to call when the viewer shows something; null once it was called. @type {(() => void) | null} */ #seen =
    null;
  /** @type {(() => void) | null} */ #started = null;
  /** @type {Document | null} */ #document = null;

  /**
   * Take over the frames of a viewer that was just loaded.
   *
   * @param {Window} viewer of our own origin; its event `news` tells that the service sent something
   * @param {() => void} seen called when its first picture is there
   * @param {() => void} started called when it draws for the first time, even if there is nothing yet
   */
  govern(viewer, seen, started) {
    this.#waiting.clear();
    this.#seen = seen;
    this.#started = started;
    this.#fed = -1;
    this.#document = viewer.document;
    const own = viewer.requestAnimationFrame.bind(viewer);
    const cancel = viewer.cancelAnimationFrame.bind(viewer);
    this.#request = own;
    viewer.requestAnimationFrame = (callback) => {
      if (this.#open()) return own((time) => this.#frame(callback, time));
      // Our own numbers are far from the browser's, so the two never meet.
      const id = -this.#next++;
      this.#waiting.set(id, callback);
      return id;
    };
    viewer.cancelAnimationFrame = (id) => {
      if (!this.#waiting.delete(id)) cancel(id);
    };
    for (const name of ["news", "pointerdown", "pointermove", "wheel", "keydown", "resize"]) {
      viewer.addEventListener(name, () => this.#wake(), { passive: true });
    }
    viewer.addEventListener("news", () => (this.#fed = 0), { once: true });
    this.#wake();
  }

  get held() {
    return this.#held;
  }

  /** Let frames wait, or go on. @param {boolean} held */
  hold(held) {
    this.#held = held;
    this.#release();
  }

  /** Whether this machine draws too slowly to follow the pointer. */
  get slow() {
    return this.#cost > SHORT_MS;
  }

  #wake() {
    this.#newsUntil = performance.now() + NEWS_MS;
    this.#release();
  }

  /** Time until the next frame may be drawn, in ms. */
  #rest() {
    if (!this.slow || this.#seen) return 0;
    const now = performance.now();
    const pause = this.#cost * (now < this.#newsUntil ? PAUSE.news : PAUSE.idle);
    return Math.max(0, this.#lastEnd + Math.min(pause, MAX_PAUSE_MS) - now);
  }

  #open() {
    return !this.#held && this.#rest() === 0;
  }

  #release() {
    clearTimeout(this.#pause);
    if (this.#held || !this.#request) return;
    const rest = this.#rest();
    if (rest > 0) {
      this.#pause = setTimeout(() => this.#release(), rest);
      return;
    }
    const waiting = [...this.#waiting.values()];
    this.#waiting.clear();
    for (const callback of waiting) this.#request((time) => this.#frame(callback, time));
  }

  /**
   * @param {FrameRequestCallback} callback
   * @param {number} time
   */
  #frame(callback, time) {
    const start = performance.now();
    callback(time);
    this.#started?.();
    this.#started = null;
    if (this.#fed >= 0) this.#fed++;
    if (this.#seen && this.#fed >= FIRST_FRAMES && hasPicture(this.#document)) {
      this.#seen();
      this.#seen = null;
    }
    // What the browser itself does for the frame counts, too.
    setTimeout(() => {
      this.#lastEnd = performance.now();
      this.#cost = (this.#cost + this.#lastEnd - start) / 2;
      this.#release();
    });
  }
}

/**
 * Whether anything is drawn; only to be asked within a frame, as a drawing buffer is empty afterwards.
 *
 * @param {Document | null} viewer
 */
function hasPicture(viewer) {
  const drawn = [...(viewer?.querySelectorAll("canvas") ?? [])].find(({ width, height }) => width && height);
  if (!drawn) return false;
  const small = new OffscreenCanvas(SAMPLE, SAMPLE);
  const context = /** @type {OffscreenCanvasRenderingContext2D} */ (small.getContext("2d"));
  context.drawImage(drawn, 0, 0, SAMPLE, SAMPLE);
  return context.getImageData(0, 0, SAMPLE, SAMPLE).data.some((value, i) => i % 4 === 3 && value > 0);
}
