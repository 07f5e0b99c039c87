/**
 * Rows that take more or fewer stitches than the row below has, and what can be done about them.
 *
 * @import {Grid} from "../grid/grid.js"
 * @import {Put} from "./document.js"
 * @import {Others} from "./others.js"
 *
 * @typedef {{row: number, over: number}} Imbalance by how many stitches the row takes too many; too few below 0
 * @typedef {{words: string, cells: [number, number][], put: Put}} Remedy what to paint and to put
 */

import { kindOf } from "../grid/kinds.js";

/** @param {{grid: Grid, others: Others}} chart @returns {Imbalance[]} from the bottom */
export function imbalances({ grid: { columns }, others }) {
  if (!others.size) return [];
  /** @type {Map<number, number>} */
  const over = new Map();
  for (const [i, code] of others.all) {
    const { takes, width } = kindOf(code);
    if (takes === width) continue;
    const row = Math.floor(i / columns);
    over.set(row, (over.get(row) ?? 0) + takes - width);
  }
  return [...over]
    .filter(([, count]) => count)
    .map(([row, count]) => ({ row, over: count }))
    .sort((a, b) => a.row - b.row);
}

/** What is wrong with a row, in words. @param {Imbalance} imbalance @param {number} columns */
export function balanceWords({ row, over }, columns) {
  const below = row ? `row ${row}` : "the cast-on";
  const count = Math.abs(over);
  const needs = `Row ${row + 1} takes ${columns + over} stitches, ${below} has ${columns}`;
  if (over > 0) return `${needs}: ${count > 1 ? `${count} decreases` : "a decrease"} too many.`;
  return `${needs}: ${count > 1 ? `${count} yarn overs` : "a yarn over"} too many.`;
}

/**
 * Two ways to mend a row: to add what is lacking, or to undo what is too much.
 *
 * @param {{grid: Grid, others: Others, outline: Uint8Array}} chart
 * @param {Imbalance} imbalance
 * @returns {Remedy[]}
 */
export function remediesOf({ grid, others, outline }, { row, over }) {
  const { columns, purl } = grid;
  const at = (/** @type {number} */ column) => row * columns + column;
  const line = Array.from({ length: columns }, (_, column) => column);
  const plain = line.filter((column) => others.start(at(column)) === undefined && outline[at(column)]);
  const changing = line.filter((column) => {
    const kind = others.code(at(column)) === null ? null : others.kind(at(column));
    return kind && Math.sign(kind.takes - kind.width) === Math.sign(over);
  });
  const count = Math.abs(over);
  const [lacking, extra] = over > 0 ? ["yarn over", "decrease"] : ["decrease", "yarn over"];

  /** @type {Remedy[]} */
  const remedies = [];
  const near = (/** @type {number} */ column) => Math.min(...changing.map((other) => Math.abs(other - column)));
  const chosen = plain.sort((a, b) => near(a) - near(b) || a - b).slice(0, count);
  if (chosen.length === count) {
    remedies.push({
      words: count > 1 ? `Add ${count} ${lacking}s` : `Add a ${lacking}`,
      cells: chosen.map((column) => [at(column), 0]),
      put: chosen.map((column) => [at(column), over > 0 ? "O" : changing.some((other) => other < column) ? "\\" : "/"]),
    });
  }

  // a row on the right side is worked from the right: its last stitch is at the left
  const last = row % 2 ? changing.reverse() : changing;
  /** @type {[number, number][]} */
  const cells = [];
  /** @type {(readonly [number, string])[]} */
  const put = [];
  let left = count;
  for (const column of last) {
    if (!left) break;
    const kind = /** @type {import("../grid/kinds.js").Kind} */ (others.kind(at(column)));
    const change = Math.abs(kind.takes - kind.width);
    if (change > left) put.push([at(column), kind.shown === "P" ? ")" : "/"]); // of a double decrease a single stays
    cells.push([at(column), purl[at(column)]]);
    left -= change > left ? change - 1 : change;
  }
  if (left === 0)
    remedies.push({ words: `Undo ${count > 1 ? `${count} ${extra}s` : `the last ${extra}`}`, cells, put });
  return remedies;
}
