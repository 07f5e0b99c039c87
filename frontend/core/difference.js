/**
 * Two answers beside each other: how far apart they are, and whether that can be told from them.
 *
 * @typedef {{value: number | undefined, interval?: readonly [number, number] | null}} Answer
 */

import { percent } from "./format.js";

/**
 * @param {Answer} a
 * @param {Answer} b
 * @returns {{text: string, clear: boolean, meet: boolean}} how much more or less b is, in percent of a;
 *   clear where their 90 % intervals do not meet; meet where they do, though the values differ
 */
export function difference(a, b) {
  if (!a.value || b.value === undefined) return { text: "–", clear: false, meet: false };
  const share = b.value / a.value - 1;
  if (Math.abs(share) < 0.005) return { text: "the same", clear: false, meet: false };
  const known = Boolean(a.interval && b.interval);
  const apart = a.interval && b.interval && (a.interval[1] < b.interval[0] || b.interval[1] < a.interval[0]);
  const factor = b.value / a.value;
  const text = factor >= 2 ? `× ${factor.toFixed(1)}` : `${share > 0 ? "+" : ""}${percent(share)}`;
  return { text, clear: Boolean(apart), meet: known && !apart };
}
