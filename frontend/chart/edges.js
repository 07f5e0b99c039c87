/**
 * Edges of sets of stitches: found once for each set, then drawn at any zoom.
 *
 * @import {Box, Grid} from "../grid/grid.js"
 * @import {Viewport} from "./viewport.js"
 *
 * @typedef {Int16Array} Edges six numbers a piece: 0 for level or 1 for upright, the line it lies on,
 *   from, to (in stitches from the lower left), side (1 if the set is above or at the right of it, else
 *   -1), and which of its ends are inner corners (1 the first, 2 the last)
 */

const PIECE = 6;

/**
 * @param {Uint8Array} cells 1 for what belongs to the set, row by row from the bottom
 * @param {number} rows
 * @param {number} columns
 * @returns {Edges}
 */
export function edgesOf(cells, rows, columns) {
  /** @type {number[]} */
  const pieces = [];
  /** @param {number} row @param {number} column */
  const has = (row, column) =>
    row >= 0 && column >= 0 && row < rows && column < columns && cells[row * columns + column] === 1;
  for (let row = 0; row <= rows; row++) {
    for (let column = 0; column < columns; column++) {
      const above = row < rows && cells[row * columns + column] === 1;
      const below = row > 0 && cells[(row - 1) * columns + column] === 1;
      if (above === below) continue;
      const from = column;
      do column++;
      while (column < columns && has(row, column) === above && has(row - 1, column) === below);
      const outer = above ? row - 1 : row;
      const inner = (has(outer, from - 1) ? 1 : 0) + (has(outer, column) ? 2 : 0);
      pieces.push(0, row, from, column, above ? 1 : -1, inner);
      column--;
    }
  }
  for (let column = 0; column <= columns; column++) {
    for (let row = 0; row < rows; row++) {
      const right = column < columns && cells[row * columns + column] === 1;
      const left = column > 0 && cells[row * columns + column - 1] === 1;
      if (right === left) continue;
      const from = row;
      do row++;
      while (row < rows && has(row, column) === right && has(row, column - 1) === left);
      const outer = right ? column - 1 : column;
      const inner = (has(from - 1, outer) ? 1 : 0) + (has(row, outer) ? 2 : 0);
      pieces.push(1, column, from, row, right ? 1 : -1, inner);
      row--;
    }
  }
  return Int16Array.from(pieces);
}

/**
 * The line along edges, drawn within the set.
 *
 * @param {Viewport} view
 * @param {Grid} grid
 * @param {Edges} edges
 * @param {Box} box edges beyond it are left out
 * @param {{row?: number, column?: number, inset?: number}} [options] where the set's lower left is in
 *   the chart; and how far within the set, in CSS pixels
 */
export function edgePath(view, grid, edges, box, { row = 0, column = 0, inset = 0 } = {}) {
  const { x, y, cellWidth: w, cellHeight: h } = view;
  const path = new Path2D();
  const left = x + column * w;
  const bottom = y + (grid.rows - row) * h;
  for (let k = 0; k < edges.length; k += PIECE) {
    const [at, from, to, side, inner] = [edges[k + 1], edges[k + 2], edges[k + 3], edges[k + 4], edges[k + 5]];
    // At an outer corner the line is shortened, at an inner one prolonged.
    const start = inset * (inner & 1 ? -1 : 1);
    const end = inset * (inner & 2 ? -1 : 1);
    if (edges[k]) {
      const column0 = at + column;
      if (column0 < box.column0 || column0 > box.column1 || from + row > box.row1 || to + row < box.row0) continue;
      const px = left + at * w + side * inset;
      path.moveTo(px, bottom - from * h - start);
      path.lineTo(px, bottom - to * h + end);
    } else {
      const row0 = at + row;
      if (row0 < box.row0 || row0 > box.row1 || from + column > box.column1 || to + column < box.column0) continue;
      const py = bottom - at * h - side * inset;
      path.moveTo(left + from * w + start, py);
      path.lineTo(left + to * w - end, py);
    }
  }
  return path;
}
