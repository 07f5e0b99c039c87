/**
 * What a tool paints with: knit, purl, the opposite of the stitch first touched, a repeat (so that
 * one can paint with a fabric), "no stitch", or a region.
 *
 * @import {Put, Target} from "./document.js"
 * @import {Grid} from "../grid/grid.js"
 * @import {Cell, Span} from "../grid/raster.js"
 * @typedef {"none" | "across" | "up" | "both"} Symmetry "across": the left half mirrored to the right
 */

import { besides } from "../core/pointing.js";
import { Grid as ChartGrid } from "../grid/grid.js";
import { IMAGES, kindOf, readCodes } from "../grid/kinds.js";
import { Brush } from "../grid/stroke.js";

export class Ink {
  /**
   * @param {string} id
   * @param {string} name
   * @param {Grid | null} repeat null: the opposite of the stitch first touched
   * @param {string} [note]
   * @param {Target} [target] what it changes
   * @param {readonly [row: number, column: number, code: string][]} [others] its stitches that are neither knit nor purl
   */
  constructor(id, name, repeat, note = "", target = "stitches", others = []) {
    this.id = id;
    this.name = name;
    this.repeat = repeat;
    this.note = note;
    this.target = target;
    this.others = others;
  }

  /** Whether it is one stitch over several columns: it begins where the pointer is pressed. */
  get isWide() {
    return this.others.length === 1 && this.repeat?.rows === 1 && this.repeat.columns > 1;
  }

  /**
   * Where its stamp is put for a pointer: one of lace or cables is moved into the chart, so that its rows stay whole.
   *
   * @param {Cell} cell
   * @param {Grid} grid
   * @returns {Cell | null} null where the chart is too small for it
   */
  stampAt([row, column], grid) {
    if (!this.repeat || !this.others.length) return [row, column];
    const [high, wide] = [grid.rows - this.repeat.rows, grid.columns - this.repeat.columns];
    return high < 0 || wide < 0 ? null : [Math.min(row, high), Math.min(column, wide)];
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

  /** The ink of the right mouse button; other stitches it takes away. */
  opposite() {
    if (!this.repeat) return this;
    if (this.others.length) return new Ink(`${this.id}-away`, this.name, this.repeat, this.note, this.target);
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

/** An ink of any stitches. @param {string} id @param {string} name @param {string} codes such as "KO/;KKK" @param {string} [note] */
export function codesInk(id, name, codes, note) {
  const { chart, others } = /** @type {NonNullable<ReturnType<typeof readCodes>>} */ (readCodes(codes));
  return new Ink(id, name, ChartGrid.fromText(chart), note, "stitches", others);
}

/** An ink of one stitch. @param {string} code @param {[name: string, words: string, deed: string]} words */
export const stitchInk = (code, [name, words, deed]) => codesInk(`stitch-${code}`, words, code, `${name}: ${deed}`);

/**
 * Stitches to set: the ink at each cell, and its mirror images; and those of them that are neither knit nor purl.
 *
 * @param {Grid} grid
 * @param {Span[]} spans may lie outside
 * @param {Ink} ink with a repeat
 * @param {Cell} origin
 * @param {Symmetry} symmetry
 * @returns {[Brush, Put]}
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
  return [brush, ink.others.length ? otherStitches(grid, brush, ink, origin, { across, up }) : []];
}

/**
 * The other stitches that an ink puts down; its wide ones add their columns to the brush.
 *
 * @param {Grid} grid
 * @param {Brush} brush of the places that are painted
 * @param {Ink} ink
 * @param {Cell} origin
 * @param {{across: boolean, up: boolean}} symmetry
 * @returns {Put}
 */
function otherStitches({ rows, columns, purl }, brush, { repeat, others }, origin, { across, up }) {
  const { rows: high, columns: wide } = /** @type {Grid} */ (repeat);
  const codes = new Map(others.map(([row, column, code]) => [row * wide + column, code]));
  /** @type {Map<number, string>} */
  const put = new Map();
  /** @param {number} row @param {number} column @param {string} code */
  const add = (row, column, code) => {
    const { width } = kindOf(code);
    if (column < 0 || column + width > columns) return;
    put.set(row * columns + column, code);
    for (let i = row * columns + column, k = 0; k < width; k++)
      brush.set(i + k, brush.has(i + k) ? brush.values[i + k] : purl[i + k]);
  };
  for (const i of brush.touched.slice()) {
    const [row, column] = [Math.floor(i / columns), i % columns];
    const code = codes.get(modulo(row - origin[0], high) * wide + modulo(column - origin[1], wide));
    // what symmetry painted is put down with its origin
    const mirror = (across && 2 * column >= columns && columns > 1) || (up && 2 * row >= rows && rows > 1);
    if (code === undefined || mirror) continue;
    const other = columns - column - kindOf(code).width;
    add(row, column, code);
    if (across) add(row, other, IMAGES.mirrored(code));
    if (up) add(rows - 1 - row, column, code);
    if (across && up) add(rows - 1 - row, other, IMAGES.mirrored(code));
  }
  return [...put];
}

/** @param {number} a @param {number} n */
function modulo(a, n) {
  return ((a % n) + n) % n;
}
