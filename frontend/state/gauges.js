/**
 * Gauges that somebody counted on knitted cloth, or that a relaxation found. Each is known for its
 * stitches and yarn: painting leaves it behind, and undoing finds it again. The browser keeps those
 * that were counted.
 *
 * @import {GaugeInput} from "../types.js"
 *
 * @typedef {{chart: string, material: string}} Cloth
 */

import { Signal } from "../core/signal.js";
import { loadGauges, saveGauges } from "../design/store.js";

export class Gauges {
  /** @type {Map<string, GaugeInput>} */ #known = new Map(loadGauges());
  /** How often one was given or taken back. */
  changes = new Signal(this.#known.size);

  /** @param {Cloth} cloth @returns {GaugeInput | null} */
  of({ chart, material }) {
    return this.#known.size ? (this.#known.get(`${material}\n${chart}`) ?? null) : null;
  }

  /** @param {Cloth} cloth @param {GaugeInput | null} gauge null if it is not known any more */
  keep({ chart, material }, gauge) {
    const key = `${material}\n${chart}`;
    if (gauge) this.#known.set(key, gauge);
    else this.#known.delete(key);
    saveGauges([...this.#known].filter(([, { known_by }]) => known_by !== "relaxation"));
    this.changes.value += 1;
  }
}
