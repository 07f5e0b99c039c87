/**
 * Keeps the 3D viewer from taking the page's time. The viewer draws without pause and shares our
 * thread; where there is no GPU one of its frames takes longer than a brush stroke may. So its frames
 * wait while somebody paints, and on a slow machine they are drawn only when there is news.
 */

/** Frames further apart than this on average mean a slow machine. */
const SLOW_MS = 45;
/**
 * A sleeping viewer still draws after this time, for news that came late or from elsewhere; then
 * after twice as long, as a frame may keep such a machine busy for seconds. Not more: on a busy
 * machine the cloth itself comes late, and the view would stay empty.
 */
const HEARTBEAT_MS = 2500;
const LONGEST_HEARTBEAT_MS = 5000;
/** Side of the small picture that tells whether something is drawn. */
const SAMPLE = 24;

export class FrameGovernor {
  /** Callbacks that wait. @type {Map<number, FrameRequestCallback>} */ #waiting = new Map();
  /** @type {((callback: FrameRequestCallback) => number) | null} */ #request = null;
  #next = 1;
  /** @type {ReturnType<typeof setTimeout> | undefined} */ #heart;
  #awakeUntil = 0;
  #held = false;
  #lastFrame = 0;
  /** Mean time between frames, in ms; begins neither slow nor fast. */
  #pace = SLOW_MS;

  /** What to call when the viewer shows something; null once it was called. @type {(() => void) | null} */ #seen =
    null;
  /** @type {Document | null} */ #document = null;

  /**
   * Take over the frames of a viewer that was just loaded.
   *
   * @param {Window} viewer of our own origin
   * @param {() => void} seen called when its first picture is there
   */
  govern(viewer, seen) {
    this.#waiting.clear();
    this.#seen = seen;
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
    this.#beat(HEARTBEAT_MS);
    for (const name of ["pointerdown", "pointermove", "wheel", "keydown", "resize"]) {
      viewer.addEventListener(name, () => this.wake(1200), { passive: true });
    }
  }

  /**
   * Something has to be drawn.
   *
   * @param {number} milliseconds for how long at least
   */
  wake(milliseconds) {
    this.#awakeUntil = Math.max(this.#awakeUntil, performance.now() + milliseconds);
    this.#beat(HEARTBEAT_MS);
    this.#release();
  }

  /** Let frames wait, or go on. @param {boolean} held */
  hold(held) {
    this.#held = held;
    if (!held) this.#release();
  }

  /** Whether frames wait. */
  get held() {
    return this.#held;
  }

  /** Whether this machine draws too slowly to follow the pointer. */
  get slow() {
    return this.#pace >= SLOW_MS;
  }

  /** @param {number} milliseconds to the next heartbeat */
  #beat(milliseconds) {
    clearTimeout(this.#heart);
    this.#heart = setTimeout(() => {
      if (!this.#held) this.#draw();
      this.#beat(Math.min(2 * milliseconds, LONGEST_HEARTBEAT_MS));
    }, milliseconds);
  }

  #open() {
    return !this.#held && (performance.now() < this.#awakeUntil || this.#pace < SLOW_MS);
  }

  #release() {
    if (this.#open()) this.#draw();
  }

  #draw() {
    if (!this.#request) return;
    const waiting = [...this.#waiting.values()];
    this.#waiting.clear();
    for (const callback of waiting) this.#request((time) => this.#frame(callback, time));
  }

  /**
   * @param {FrameRequestCallback} callback
   * @param {number} time
   */
  #frame(callback, time) {
    const gap = time - this.#lastFrame;
    // Several callbacks share a frame; pauses that we make ourselves do not count.
    if (gap > 0 && gap < 2000) this.#pace += 0.1 * (gap - this.#pace);
    this.#lastFrame = time;
    callback(time);
    if (this.#seen && hasPicture(this.#document)) {
      this.#seen();
      this.#seen = null;
    }
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
