/**
 * What is selected: a box, and if not all of it, which of its stitches.
 *
 * @import {Box, Grid} from "../grid/grid.js"
 * @import {Span} from "../grid/raster.js"
 * @import {Symmetry} from "./ink.js"
 *
 * @typedef {Box & {mask?: Uint8Array}} Selection `mask` has a 1 for every stitch of the box that is
 *   selected, row by row from the bottom; without it all are
 * @typedef {"replace" | "add" | "subtract" | "intersect"} Combination
 */

/** Whether a stitch is selected. @param {Selection} selection @param {number} row @param {number} column */
export function selects({ row0, column0, row1, column1, mask }, row, column) {
  if (row < row0 || row >= row1 || column < column0 || column >= column1) return false;
  return !mask || mask[(row - row0) * (column1 - column0) + column - column0] === 1;
}

/** Lines of x and . of a selection's box, the top row first; null if all is selected. @param {Selection} selection */
export function selectedLines({ row0, column0, row1, column1, mask }) {
  if (!mask) return null;
  const [rows, columns] = [row1 - row0, column1 - column0];
  const line = (/** @type {number} */ row) =>
    Array.from(mask.subarray(row * columns, (row + 1) * columns), (marked) => (marked ? "x" : ".")).join("");
  return Array.from({ length: rows }, (_, k) => line(rows - 1 - k)).join("\n");
}

/** The selected stitches of a chart, by index. @param {Selection} selection @param {Grid} grid @returns {number[]} */
export function selectedCells(selection, grid) {
  const cells = [];
  for (let row = selection.row0; row < selection.row1; row++) {
    for (let column = selection.column0; column < selection.column1; column++) {
      if (selects(selection, row, column)) cells.push(grid.index(row, column));
    }
  }
  return cells;
}

/**
 * @param {Uint8Array} bitmap of the whole chart
 * @param {Grid} grid
 * @returns {Selection | null} null if nothing is selected
 */
export function selectionOf(bitmap, { rows, columns }) {
  let [row0, row1, column0, column1] = [rows, 0, columns, 0];
  let count = 0;
  for (let row = 0; row < rows; row++) {
    const line = bitmap.subarray(row * columns, (row + 1) * columns);
    const first = line.indexOf(1);
    if (first < 0) continue;
    row0 = Math.min(row0, row);
    row1 = row + 1;
    column0 = Math.min(column0, first);
    column1 = Math.max(column1, line.lastIndexOf(1) + 1);
    for (const selected of line) count += selected;
  }
  if (!count) return null;
  const box = { row0, column0, row1, column1 };
  if (count === (row1 - row0) * (column1 - column0)) return box;
  const mask = new Uint8Array((row1 - row0) * (column1 - column0));
  for (let row = row0; row < row1; row++) {
    mask.set(bitmap.subarray(row * columns + column0, row * columns + column1), (row - row0) * (column1 - column0));
  }
  return { ...box, mask };
}

/**
 * @param {Selection | null} selection
 * @param {Span[]} spans may reach beyond the chart
 * @param {Grid} grid
 * @param {Combination} how
 * @param {Symmetry} [symmetry]
 * @returns {Selection | null}
 */
export function combined(selection, spans, grid, how, symmetry = "none") {
  const { rows, columns } = grid;
  const fresh = new Uint8Array(rows * columns);
  const across = symmetry === "across" || symmetry === "both";
  const up = symmetry === "up" || symmetry === "both";
  for (const [row, start, end] of spans) {
    const [from, to] = [Math.max(0, start), Math.min(columns, end)];
    if (row < 0 || row >= rows || from >= to) continue;
    for (const r of up ? [row, rows - 1 - row] : [row]) {
      fresh.fill(1, r * columns + from, r * columns + to);
      if (across) fresh.fill(1, (r + 1) * columns - to, (r + 1) * columns - from);
    }
  }
  if (how !== "replace") {
    const old = new Uint8Array(rows * columns);
    if (selection) for (const i of selectedCells(selection, grid)) old[i] = 1;
    for (let i = 0; i < fresh.length; i++) {
      if (how === "add") fresh[i] |= old[i];
      else if (how === "intersect") fresh[i] &= old[i];
      else fresh[i] = old[i] & (1 - fresh[i]);
    }
  }
  return selectionOf(fresh, grid);
}
