/**
 * What a tool paints with: knit, purl, the opposite of the stitch first touched, a repeat (so that
 * one can paint with a fabric), "no stitch", or a region.
 *
 * @import {Target} from "./document.js"
 * @import {Grid} from "../grid/grid.js"
 * @import {Cell, Span} from "../grid/raster.js"
 * @typedef {"none" | "across" | "up" | "both"} Symmetry "across": the left half mirrored to the right
 */

import { besides } from "../core/pointing.js";
import { Grid as ChartGrid } from "../grid/grid.js";
import { Brush } from "../grid/stroke.js";

export class Ink {
  /**
   * @param {string} id
   * @param {string} name
   * @param {Grid | null} repeat null: the opposite of the stitch first touched
   * @param {string} [note]
   * @param {Target} [target] what it changes
   */
  constructor(id, name, repeat, note = "", target = "stitches") {
    this.id = id;
    this.name = name;
    this.repeat = repeat;
    this.note = note;
    this.target = target;
  }

  /** The stitch that this ink puts at a place. @param {Cell} cell @param {Cell} origin where the repeat begins */
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
    if (!this.repeat) return this;
    return new Ink(`${this.id}-swapped`, this.name, this.repeat.swapped(), this.note, this.target);
  }
}

/** @param {number} value */
const stitch = (value) => new ChartGrid(1, 1, Uint8Array.of(value));

export const FLIP = new Ink("flip", "Flip", null, "The opposite of the stitch you touch first");
export const KNIT = new Ink("knit", "Knit", stitch(0));
export const PURL = new Ink("purl", "Purl", stitch(1));
export const NO_STITCH = new Ink(
  "no-stitch",
  "No stitch",
  stitch(0),
  besides("Cut the chart's outline", "the right button puts stitches back"),
  "outline",
);

/** Painting with a region adds stitches to it, the right button takes them out. @param {{id: string, name: string}} region */
export function regionInk({ id, name }) {
  return new Ink(`region-${id}`, name, stitch(1), `Add stitches to ${name}`, `region:${id}`);
}

/**
 * Stitches to set: the ink at each cell, and its mirror images.
 *
 * @param {Grid} grid
 * @param {Span[]} spans may lie outside
 * @param {Ink} ink with a repeat
 * @param {Cell} origin
 * @param {Symmetry} symmetry
 * @returns {Brush}
 */
export function inked(grid, spans, ink, origin, symmetry) {
  const { rows, columns } = grid;
  const brush = new Brush(rows * columns);
  const across = symmetry === "across" || symmetry === "both";
  const up = symmetry === "up" || symmetry === "both";
  const repeat = /** @type {Grid} */ (ink.repeat);
  for (const [row, start, end] of spans) {
    if (row < 0 || row >= rows) continue;
    const [from, to] = [Math.max(0, start), Math.min(columns, end)];
    const base = row * columns;
    const mirrored = (rows - 1 - row) * columns;
    const line = modulo(row - origin[0], repeat.rows) * repeat.columns;
    let c = modulo(from - origin[1], repeat.columns);
    for (let column = from; column < to; column++) {
      const value = repeat.purl[line + c];
      if (++c === repeat.columns) c = 0;
      const other = columns - 1 - column;
      brush.set(base + column, value);
      if (across) brush.set(base + other, value);
      if (up) brush.set(mirrored + column, value);
      if (across && up) brush.set(mirrored + other, value);
    }
  }
  return brush;
}

/** @param {number} a @param {number} n */
function modulo(a, n) {
  return ((a % n) + n) % n;
}
