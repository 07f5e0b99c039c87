/**
 * Where the stitches of a changed chart come from.
 *
 * @import {Grid} from "./grid.js"
 *
 * @typedef {object} Reshape
 * @property {number} rows
 * @property {number} columns
 * @property {Int32Array} source for each new stitch the old one; -1 is a new knit
 * @property {Int32Array} [like] for each new stitch the old one whose regions and outline it takes
 * @property {boolean} [grow] whether repeats that spanned the chart span the new one, if they fit
 * @property {{change: (motif: Grid) => Grid, swapped: boolean}} [motif] what happens to motifs
 */

/**
 * @param {Grid} grid
 * @param {number} rows
 * @param {number} columns
 * @param {(row: number, column: number) => [row: number, column: number]} from may lie outside
 */
function sources(grid, rows, columns, from) {
  const source = new Int32Array(rows * columns);
  for (let row = 0, k = 0; row < rows; row++) {
    for (let column = 0; column < columns; column++, k++) {
      const [r, c] = from(row, column);
      source[k] = grid.has(r, c) ? grid.index(r, c) : -1;
    }
  }
  return source;
}

/**
 * The whole chart mirrored, turned in its plane, or seen from the back.
 *
 * @param {Grid} grid
 * @param {"mirrored" | "flipped" | "rotated" | "turnedOver" | "swapped"} how
 * @returns {Reshape}
 */
export function turned(grid, how) {
  const { rows, columns } = grid;
  const across = how === "mirrored" || how === "rotated" || how === "turnedOver";
  const up = how === "flipped" || how === "rotated";
  return {
    rows,
    columns,
    source: sources(grid, rows, columns, (row, column) => [
      up ? rows - 1 - row : row,
      across ? columns - 1 - column : column,
    ]),
    motif: { change: (motif) => motif[how](), swapped: how === "turnedOver" || how === "swapped" },
  };
}

/**
 * Cut, or filled up with knits.
 *
 * @param {Grid} grid
 * @param {number} rows
 * @param {number} columns
 * @param {readonly [up: number, across: number]} anchor where the old chart stays: 0 bottom or left,
 *   0.5 in the middle, 1 top or right
 * @returns {Reshape}
 */
export function resized(grid, rows, columns, [up, across] = [0, 0]) {
  const row0 = Math.floor((grid.rows - rows) * up);
  const column0 = Math.floor((grid.columns - columns) * across);
  const source = sources(grid, rows, columns, (row, column) => [row + row0, column + column0]);
  return { rows, columns, source, grow: true };
}

/**
 * New rows or columns; they belong to the regions of what they are put beside.
 *
 * @param {Grid} grid
 * @param {"rows" | "columns"} axis
 * @param {number} at put before this one (below, or at the left of it)
 * @param {number} count
 * @param {"before" | "after"} beside the neighbour whose regions continue
 * @returns {Reshape}
 */
export function inserted(grid, axis, at, count, beside) {
  const size = { rows: grid.rows, columns: grid.columns };
  size[axis] += count;
  const neighbour = Math.min(grid[axis] - 1, Math.max(0, beside === "before" ? at - 1 : at));
  /** @param {number} k @param {number} fresh */
  const from = (k, fresh) => (k < at ? k : k < at + count ? fresh : k - count);
  /** @param {number} fresh */
  const map = (fresh) =>
    sources(grid, size.rows, size.columns, (row, column) =>
      axis === "rows" ? [from(row, fresh), column] : [row, from(column, fresh)],
    );
  return { ...size, source: map(-1), like: map(neighbour) };
}

/**
 * Without some rows or columns.
 *
 * @param {Grid} grid
 * @param {"rows" | "columns"} axis
 * @param {number} from
 * @param {number} to the first that stays again
 * @returns {Reshape}
 */
export function deleted(grid, axis, from, to) {
  const size = { rows: grid.rows, columns: grid.columns };
  size[axis] -= to - from;
  /** @param {number} k */
  const old = (k) => (k < from ? k : k + to - from);
  const source = sources(grid, size.rows, size.columns, (row, column) =>
    axis === "rows" ? [old(row), column] : [row, old(column)],
  );
  return { ...size, source };
}
