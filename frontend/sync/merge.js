/**
 * Two changed copies of a design made one. What only one side changed is taken from that side, stitch
 * by stitch in the chart and item by item in lists; what both changed differently is a conflict.
 *
 * @import {StitchRun} from "../design/others.js"
 * @import {DesignDocument} from "../types.js"
 *
 * @typedef {"name" | "material" | "note" | "machine" | "chart" | "outline" | "regions" | "repeats" | "shelf"} Part
 * @typedef {{document: DesignDocument, conflicts: Part[]}} Merged in a conflict `document` has our side
 */

import { Others, entriesOf, written } from "../design/others.js";
import { kindOf } from "../grid/kinds.js";

const PLAIN = /** @type {const} */ (["name", "material", "note", "machine", "outline"]);
const LISTS = /** @type {const} */ (["regions", "repeats", "shelf"]);

/**
 * @param {DesignDocument} base what both sides began with
 * @param {DesignDocument} mine
 * @param {DesignDocument} theirs
 * @returns {Merged}
 */
export function merge(base, mine, theirs) {
  /** @type {Part[]} */
  const conflicts = [];
  /** @type {DesignDocument} */
  const document = { ...mine };
  /** @param {Part} part @param {unknown} value */
  const take = (part, value) => {
    if (value === undefined) conflicts.push(part);
    else Object.assign(document, { [part]: value });
  };
  for (const part of PLAIN) take(part, either(base[part] ?? null, mine[part] ?? null, theirs[part] ?? null));
  const stitches = mergeStitches(base, mine, theirs);
  take("chart", stitches?.chart);
  if (stitches?.other_stitches.length || mine.other_stitches) {
    document.other_stitches = stitches?.other_stitches ?? mine.other_stitches;
  }
  for (const part of LISTS) {
    /** @param {DesignDocument} side @returns {{id?: string, name: string}[]} */
    const items = (side) => side[part];
    take(part, mergeItems(items(base), items(mine), items(theirs)));
  }
  return { document, conflicts };
}

/** Whether two documents are the same. @param {DesignDocument} first @param {DesignDocument} second */
export function same(first, second) {
  return (
    [...PLAIN, /** @type {const} */ ("chart")].every((part) => (first[part] ?? null) === (second[part] ?? null)) &&
    LISTS.every((part) => alike(first[part], second[part])) &&
    alike(first.other_stitches ?? [], second.other_stitches ?? [])
  );
}

/**
 * Stitches that differ between two charts of one size, as runs of what they become; null if the
 * charts are of different sizes.
 *
 * @param {string} before K/P lines, top row first
 * @param {string} after
 * @returns {{rows: number, columns: number, runs: {row: number, column: number, stitches: string}[]} | null}
 */
export function strokesBetween(before, after) {
  if (!sameShape(before, after)) return null;
  const columns = before.includes("\n") ? before.indexOf("\n") : before.length;
  const rows = (before.length + 1) / (columns + 1);
  const runs = [];
  for (let i = 0; i < after.length; i++) {
    if (before[i] === after[i]) continue;
    const start = i;
    while (i + 1 < after.length && before[i + 1] !== after[i + 1]) i++;
    const line = Math.floor(start / (columns + 1));
    runs.push({ row: rows - 1 - line, column: start % (columns + 1), stitches: after.slice(start, i + 1) });
  }
  return { rows, columns, runs };
}

/**
 * @typedef {Pick<DesignDocument, "chart"> & {other_stitches: StitchRun[]}} Stitches
 * @param {DesignDocument} base
 * @param {DesignDocument} mine
 * @param {DesignDocument} theirs
 * @returns {Stitches | undefined} undefined in a conflict
 */
function mergeStitches(base, mine, theirs) {
  const sides = [base, mine, theirs].map(({ chart, other_stitches = [] }) => ({ chart, other_stitches }));
  if (sides.every(({ other_stitches: runs }) => !runs.length)) {
    const chart = mergeCharts(base.chart, mine.chart, theirs.chart);
    return chart === undefined ? undefined : { chart, other_stitches: [] };
  }
  const whole = either(sides[0], sides[1], sides[2]);
  if (whole !== undefined) return whole;
  if (!sameShape(base.chart, mine.chart) || !sameShape(base.chart, theirs.chart)) return undefined;
  const columns = base.chart.indexOf("\n") < 0 ? base.chart.length : base.chart.indexOf("\n");
  const [was, ours, others] = sides.map((side) => cellsOf(side, columns));
  /** @type {[number, string][]} */
  const kept = [];
  let chart = "";
  for (let i = 0; i < ours.length; i++) {
    const cell = either(was[i], ours[i], others[i]);
    if (cell === undefined) return undefined; // both changed the same stitch, and not alike
    if (cell.code && !cell.column) kept.push([i, cell.code]);
    chart += cell.shown;
  }
  const lines = chart.match(new RegExp(`.{${columns}}`, "g")) ?? [];
  return { chart: lines.reverse().join("\n"), other_stitches: written(Others.of(kept), columns) };
}

/** Every place from the bottom left: what it shows, and which column of which other stitch it is. @param {Stitches} side @param {number} columns */
function cellsOf({ chart, other_stitches: runs }, columns) {
  const cells = [...chart.split("\n").reverse().join("")].map((shown) => ({ shown, code: "", column: 0 }));
  for (const [i, code] of entriesOf(runs, columns)) {
    for (let column = 0; column < kindOf(code).width; column++) Object.assign(cells[i + column], { code, column });
  }
  return cells;
}

/**
 * @param {string} base
 * @param {string} mine
 * @param {string} theirs
 * @returns {string | undefined} undefined in a conflict: both changed, and not on the same grid
 */
function mergeCharts(base, mine, theirs) {
  const whole = either(base, mine, theirs);
  if (whole !== undefined) return whole;
  if (!sameShape(base, mine) || !sameShape(base, theirs)) return undefined;
  let chart = "";
  for (let i = 0; i < mine.length; i++) chart += mine[i] === base[i] ? theirs[i] : mine[i];
  return chart; // a stitch is K or P: where both changed it, both made it the same
}

/**
 * @typedef {{id?: string, name: string}} Item
 * @param {Item[]} base
 * @param {Item[]} mine
 * @param {Item[]} theirs
 * @returns {Item[] | undefined}
 */
function mergeItems(base, mine, theirs) {
  const whole = either(base, mine, theirs);
  if (whole !== undefined) return whole;
  /** @param {Item[]} items */
  const keyed = (items) => new Map(items.map((item) => [item.id ?? item.name, item]));
  const [was, ours, others] = [keyed(base), keyed(mine), keyed(theirs)];
  const order = [...others.keys(), ...[...ours.keys()].filter((key) => !others.has(key))];
  const merged = [];
  for (const key of order) {
    const [before, own, other] = [was.get(key), ours.get(key), others.get(key)];
    const item = either(before ?? null, own ?? null, other ?? null);
    if (item === undefined) return undefined;
    if (item !== null) merged.push(item);
  }
  return merged;
}

/**
 * The side that changed, or what both agree on; undefined if both changed differently.
 *
 * @template T
 * @param {T} base
 * @param {T} mine
 * @param {T} theirs
 * @returns {T | undefined}
 */
function either(base, mine, theirs) {
  if (alike(mine, theirs) || alike(theirs, base)) return mine;
  return alike(mine, base) ? theirs : undefined;
}

/**
 * Whether two values say the same, in whatever order their fields are.
 *
 * @param {unknown} first
 * @param {unknown} second
 */
function alike(first, second) {
  if (first === second) return true;
  if (typeof first !== "object" || typeof second !== "object") return false;
  return JSON.stringify(first, inOrder) === JSON.stringify(second, inOrder);
}

/** @param {string} _key @param {unknown} value */
function inOrder(_key, value) {
  if (typeof value !== "object" || value === null || Array.isArray(value)) return value;
  return Object.fromEntries(Object.entries(value).sort(([a], [b]) => (a < b ? -1 : 1)));
}

/** @param {string} first @param {string} second */
function sameShape(first, second) {
  return first.length === second.length && first.indexOf("\n") === second.indexOf("\n");
}
