/**
 * Follows a design at the service: on how many other machines or browsers it is open, and when it changes. One
 * window of a browser does so for all of them, as a browser opens few connections to one place.
 */

export class Follower {
  /** @type {string | null} */ #design = null;
  #stop = () => {};

  /**
   * @param {object} heard
   * @param {(others: number) => void} heard.others
   * @param {(revision: number) => void} heard.changed
   */
  constructor(heard) {
    this.heard = heard;
  }

  /** @param {string | null} design as the service calls it */
  follow(design) {
    if (design === this.#design) return;
    this.#design = design;
    this.#stop();
    // Without locks, as on plain http, the design is asked for from time to time only.
    if (!design || !navigator.locks) return;
    const wait = new AbortController();
    const over = new Promise((resolve) => (this.#stop = () => resolve(wait.abort())));
    navigator.locks
      .request(`knitcore-follows-${design}`, { signal: wait.signal }, async () => {
        const events = new EventSource(`/api/v1/designs/${encodeURIComponent(design)}/events`);
        events.addEventListener("others", ({ data }) => this.heard.others(Number(data)));
        events.addEventListener("changed", ({ data }) => this.heard.changed(Number(data)));
        await over;
        events.close();
        this.heard.others(0);
      })
      .catch((error) => {
        if (!wait.signal.aborted) throw error; // another design is followed before the lock was there
      });
  }
}
