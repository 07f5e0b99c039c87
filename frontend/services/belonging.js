/**
 * A result belongs to what it was made for: the design, the yarn, and what else it depends on. As soon as
 * the page holds something else, the result says so and fades; when the page holds that again, it
 * counts again.
 *
 * @import {Studio} from "../state/studio.js"
 *
 * @typedef {Record<string, unknown>} Basis what a result depends on, by the names in `CHANGED`; the first that
 *   differs is told
 */

import { paced } from "../core/paced.js";
import { Signal } from "../core/signal.js";
import { scopeOf } from "./scope.js";
import { anyClothIn } from "./stitches.js";

/** What to say of a result once its basis is another. @type {Record<string, string>} */
const CHANGED = {
  design: "Of another design",
  part: "Of another part of the chart",
  chart: "Of the chart before it was changed",
  yarn: "With another yarn",
  gauge: "With another gauge",
  weight: "With another weight of the yarn",
  limb: "On another limb",
  direction: "Pulled in the other direction",
  wish: "For another wish",
};

export class Belonging {
  /** Why the result on show does not count; "" if it does, or if there is none. */
  stale = new Signal("");
  /** @type {Record<string, string> | null} */ #made = null;
  #now;

  /** @param {Studio} studio @param {() => Basis} now what a result would be made for now */
  constructor(studio, now) {
    this.#now = () =>
      Object.fromEntries(Object.entries(now()).map(([name, value]) => [name, JSON.stringify(value) ?? ""]));
    // In a task of its own, so that the end of a stroke does not wait for it.
    const check = paced(() => this.check(), 0);
    const { selection, materialId, weight, gauges, seeing } = studio;
    studio.document.onSettle(check);
    const signals = [selection, materialId, weight, gauges.changes, seeing.region, seeing.limb, seeing.pull];
    for (const signal of signals) /** @type {Signal<unknown>} */ (signal).listen(check);
  }

  /** What a result that is asked for now will belong to; to be handed to `show`. */
  get basis() {
    return this.#now();
  }

  /** A result is on show. @param {Record<string, string>} basis for which it was made */
  show(basis) {
    this.#made = basis;
    this.check();
  }

  /** Nothing is on show. */
  clear() {
    this.#made = null;
    this.check();
  }

  /** Compare again, after a change of something that only the result's panel knows of. */
  check() {
    const made = this.#made;
    if (!made) return void (this.stale.value = "");
    const now = this.#now();
    const changed = Object.keys(now).find((name) => now[name] !== made[name]);
    this.stale.value = changed ? CHANGED[changed] : "";
  }

  /**
   * Let an element fade and say why while its result does not count.
   *
   * @param {HTMLElement} element
   * @param {string} name of the result
   */
  marks(element, name) {
    element.dataset.result = name;
    this.stale.watch((words) => {
      if (words) element.dataset.stale = words;
      else delete element.dataset.stale;
    });
  }

  /** Let nothing be done with a result while it does not count. @param {HTMLElement} element */
  bars(element) {
    this.stale.watch((words) => (element.inert = words !== ""));
  }
}

/** What the numbers of a part of the chart depend on. @param {Studio} studio */
export function clothOf(studio) {
  const scope = scopeOf(studio);
  const { chart, material, gauge } = anyClothIn(studio, scope);
  return { part: [scope.kind, scope.title, placeOf(studio)], chart, yarn: material, gauge };
}

/** Where the part of the chart is that numbers are asked of. @param {Studio} studio */
export function placeOf({ selection, seeing }) {
  const { row0, column0, row1, column1 } = selection.value ?? {};
  return [row0, column0, row1, column1, seeing.region.value].join();
}

/** Whether the predicted numbers are of what is on the page now. @param {Studio} studio */
export const predictionOf = (studio) =>
  new Belonging(studio, () => {
    const cloth = clothOf(studio);
    return { ...cloth, chart: [cloth.chart, scopeOf(studio).shaped] };
  });
