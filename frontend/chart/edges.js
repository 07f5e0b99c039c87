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
  /** @param {boolean} upright whether lines go up, and lie between columns @param {number} lines @param {number} length */
  const scan = (upright, lines, length) => {
    /** @param {number} line @param {number} place along it */
    const has = (line, place) =>
      line >= 0 &&
      line < lines &&
      place >= 0 &&
      place < length &&
      cells[upright ? place * columns + line : line * columns + place] === 1;
    for (let line = 0; line <= lines; line++) {
      for (let place = 0; place < length; place++) {
        const beyond = has(line, place);
        const before = has(line - 1, place);
        if (beyond === before) continue;
        const from = place;
        do place++;
        while (place < length && has(line, place) === beyond && has(line - 1, place) === before);
        const outer = beyond ? line - 1 : line;
        const inner = (has(outer, from - 1) ? 1 : 0) + (has(outer, place) ? 2 : 0);
        pieces.push(upright ? 1 : 0, line, from, place, beyond ? 1 : -1, inner);
        place--;
      }
    }
  };
  scan(false, rows, columns);
  scan(true, columns, rows);
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
