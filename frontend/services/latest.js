import { ApiError, isAbort } from "../api.js";

/** Runs only the newest of many requests: waits a little, gives up what is under way. */
export class Latest {
  /** @type {ReturnType<typeof setTimeout> | undefined} */ #timer;
  /** @type {AbortController | undefined} */ #controller;

  /** @param {number} delay ms to wait for a newer request */
  constructor(delay) {
    this.delay = delay;
  }

  /**
   * @param {(signal: AbortSignal) => Promise<void>} work
   * @param {(error: ApiError) => void} refused called if the service refuses, not if it was given up
   */
  run(work, refused) {
    this.cancel();
    this.#controller = new AbortController();
    const { signal } = this.#controller;
    this.#timer = setTimeout(async () => {
      try {
        await work(signal);
      } catch (error) {
        if (signal.aborted || isAbort(error)) return;
        if (!(error instanceof ApiError)) throw error;
        refused(error);
      }
    }, this.delay);
  }

  cancel() {
    clearTimeout(this.#timer);
    this.#controller?.abort();
  }
}
