/** A value that tells its listeners when it changes. @template T */
export class Signal {
  /** @type {T} */ #value;
  /** @type {Set<(value: T) => void>} */ #listeners = new Set();

  /** @param {T} value */
  constructor(value) {
    this.#value = value;
  }

  get value() {
    return this.#value;
  }

  set value(next) {
    if (Object.is(next, this.#value)) return;
    this.#value = next;
    for (const listener of this.#listeners) listener(this.#value); // one of them may have changed it again
  }

  /**
   * Call `listener` now and whenever the value changes.
   *
   * @param {(value: T) => void} listener
   * @returns {() => void} ends the subscription
   */
  watch(listener) {
    listener(this.#value);
    return this.listen(listener);
  }

  /**
   * Call `listener` whenever the value changes.
   *
   * @param {(value: T) => void} listener
   * @returns {() => void} ends the subscription
   */
  listen(listener) {
    this.#listeners.add(listener);
    return () => this.#listeners.delete(listener);
  }
}
