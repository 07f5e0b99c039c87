/** Runs only the newest of many requests: waits a little, gives up what is under way. */
export class Latest {
  /** @type {ReturnType<typeof setTimeout> | undefined} */ #timer;
  /** @type {AbortController | undefined} */ #controller;

  /** @param {number} delay ms to wait for a newer request */
  constructor(delay) {
    this.delay = delay;
  }

  /**
   * @param {(signal: AbortSignal) => Promise<void>} work must handle its own errors
   */
  run(work) {
    this.cancel();
    const controller = new AbortController();
    this.#controller = controller;
    this.#timer = setTimeout(() => void work(controller.signal), this.delay);
  }

  cancel() {
    clearTimeout(this.#timer);
    this.#controller?.abort();
  }
}
