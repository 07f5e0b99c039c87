/** Keeps the screen on while something is read at arm's length, where the browser can do so. */

export class Awake {
  /** @type {WakeLockSentinel | null} */ #lock = null;
  #kept = false;

  constructor() {
    // A page that was hidden has lost its lock.
    document.addEventListener("visibilitychange", () => {
      if (this.#kept && document.visibilityState === "visible") void this.keep();
    });
  }

  /** @returns {Promise<boolean>} whether the screen stays on */
  async keep() {
    this.#kept = true;
    try {
      const lock = (await navigator.wakeLock?.request("screen")) ?? null;
      if (this.#kept) this.#lock = lock;
      else await lock?.release();
      return lock !== null;
    } catch (error) {
      if (!(error instanceof DOMException)) throw error; // refused, as with a low battery
      return false;
    }
  }

  async release() {
    this.#kept = false;
    const lock = this.#lock;
    this.#lock = null;
    await lock?.release();
  }
}
