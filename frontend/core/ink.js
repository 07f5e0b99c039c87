/**
 * What a tool paints with: knit, purl, the opposite of the stitch first touched, or a repeat, so
 * that one can paint with a fabric.
 *
 * @import {Grid} from "./grid.js"
 * @import {Cell} from "./raster.js"
 * @typedef {"none" | "across" | "up" | "both"} Symmetry "across": the left half mirrored to the right
 */

import { Grid as ChartGrid } from "./grid.js";

export class Ink {
  /**
   * @param {string} id
   * @param {string} name
   * @param {Grid | null} repeat null: the opposite of the stitch first touched
   * @param {string} [note]
   */
  constructor(id, name, repeat, note = "") {
    this.id = id;
    this.name = name;
    this.repeat = repeat;
    this.note = note;
  }

  /**
   * The stitch that this ink puts at a place.
   *
   * @param {Cell} cell
   * @param {Cell} origin where the repeat begins
   */
  at([row, column], [originRow, originColumn]) {
    const repeat = /** @type {Grid} */ (this.repeat);
    const r = modulo(row - originRow, repeat.rows);
    const c = modulo(column - originColumn, repeat.columns);
    return repeat.purl[r * repeat.columns + c];
  }

  /** @param {number} first the stitch first touched: its opposite is painted, if the ink says so */
  resolved(first) {
    return this.repeat ? this : first ? KNIT : PURL;
  }

  /** The ink of the right mouse button. */
  opposite() {
    return this.repeat ? new Ink(`${this.id}-swapped`, this.name, this.repeat.swapped()) : this;
  }
}

export const FLIP = new Ink("flip", "Flip", null, "The opposite of the stitch you touch first");
export const KNIT = new Ink("knit", "Knit", new ChartGrid(1, 1, Uint8Array.of(0)));
export const PURL = new Ink("purl", "Purl", new ChartGrid(1, 1, Uint8Array.of(1)));

/**
 * Stitches to set: the ink at each cell, and its mirror images.
 *
 * @param {Grid} grid
 * @param {Iterable<Cell>} cells may lie outside
 * @param {Ink} ink with a repeat
 * @param {Cell} origin
 * @param {Symmetry} symmetry
 * @returns {Map<number, number>}
 */
export function inked(grid, cells, ink, origin, symmetry) {
  /** @type {Map<number, number>} */
  const result = new Map();
  const across = symmetry === "across" || symmetry === "both";
  const up = symmetry === "up" || symmetry === "both";
  for (const cell of cells) {
    const [row, column] = cell;
    if (!grid.has(row, column)) continue;
    const value = ink.at(cell, origin);
    const otherColumn = grid.columns - 1 - column;
    const otherRow = grid.rows - 1 - row;
    result.set(grid.index(row, column), value);
    if (across) result.set(grid.index(row, otherColumn), value);
    if (up) result.set(grid.index(otherRow, column), value);
    if (across && up) result.set(grid.index(otherRow, otherColumn), value);
  }
  return result;
}

/**
 * @param {number} a
 * @param {number} n
 */
function modulo(a, n) {
  return ((a % n) + n) % n;
}
