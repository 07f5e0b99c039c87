/**
 * Stitches of a chart that are neither knit nor purl, by the place of their left column. Most charts
 * have none, and then nothing here costs anything. Under each the chart has the K or P that it shows.
 *
 * @import {DesignLayout} from "../types.js"
 * @import {Grid} from "../grid/grid.js"
 * @import {Brush} from "../grid/stroke.js"
 *
 * @typedef {DesignLayout["other_stitches"][number]} StitchRun
 * @typedef {[place: number, before: string | null, after: string | null]} OtherChange
 */

import { codesIn, isOther, kindOf } from "../grid/kinds.js";

export class Others {
  /** Codes by the place of the left column. @type {Map<number, string>} */ #codes = new Map();
  /** Left columns of the stitches by every place that they stand over. @type {Map<number, number>} */ #over =
    new Map();

  get size() {
    return this.#codes.size;
  }

  /** Places and codes, in any order. */
  get all() {
    return this.#codes.entries();
  }

  /** Places and codes, from the bottom left. @returns {[number, string][]} */
  get entries() {
    return [...this.#codes].sort(([a], [b]) => a - b);
  }

  /** The code at a left column. @param {number} i */
  code(i) {
    return this.#codes.get(i) ?? null;
  }

  /** The place of the left column of the stitch over a place. @param {number} i */
  start(i) {
    return this.#over.get(i);
  }

  /** The stitch over a place. @param {number} i */
  kind(i) {
    const start = this.#over.get(i);
    return start === undefined ? null : kindOf(/** @type {string} */ (this.#codes.get(start)));
  }

  /** Whether the stitch at a place holds the one below and looks like it. @param {number} i */
  holds(i) {
    return this.#over.size > 0 && this.kind(i)?.shown === "H";
  }

  /** @param {number} i @param {string | null} code null takes it away */
  put(i, code) {
    const old = this.#codes.get(i);
    if (old !== undefined) {
      for (let k = 0; k < kindOf(old).width; k++) this.#over.delete(i + k);
      this.#codes.delete(i);
    }
    if (code === null) return;
    this.#codes.set(i, code);
    for (let k = 0; k < kindOf(code).width; k++) this.#over.set(i + k, i);
  }

  /** @param {Iterable<readonly [number, string]>} entries */
  static of(entries) {
    const others = new Others();
    for (const [i, code] of entries) others.put(i, code);
    return others;
  }
}

/** As a design document has them. @param {Others} others @param {number} columns @returns {StitchRun[]} */
export function written(others, columns) {
  /** @type {StitchRun[]} */
  const runs = [];
  let end = -1;
  for (const [i, code] of others.entries) {
    const column = i % columns;
    if (i === end && column) runs[runs.length - 1].codes += code;
    else runs.push({ row: Math.floor(i / columns), column, codes: code });
    end = i + kindOf(code).width;
  }
  return runs;
}

/** @param {readonly StitchRun[]} runs well-formed @param {number} columns @returns {[number, string][]} */
export function entriesOf(runs, columns) {
  return runs.flatMap(({ row, column, codes }) => {
    let i = row * columns + column;
    return codesIn(codes).map((code) => {
      /** @type {[number, string]} */
      const entry = [i, code];
      i += kindOf(code).width;
      return entry;
    });
  });
}

/**
 * What is wrong with runs of a chart; "" if nothing is.
 *
 * @param {readonly Record<string, unknown>[]} runs
 * @param {number} rows
 * @param {number} columns
 */
export function faultOf(runs, rows, columns) {
  const taken = new Set();
  for (const { row, column, codes } of runs) {
    if (typeof row !== "number" || typeof column !== "number" || typeof codes !== "string") {
      return "Its other stitches are not runs of row, column and codes.";
    }
    const stitches = codesIn(codes);
    const unknown = stitches.find((code) => !isOther(code));
    if (unknown !== undefined || !stitches.length)
      return `${unknown ?? "An empty text"} is no stitch of lace or cables.`;
    const width = stitches.reduce((sum, code) => sum + kindOf(code).width, 0);
    const whole = Number.isInteger(row) && Number.isInteger(column);
    if (!whole || row < 0 || row >= rows || column < 0 || column + width > columns) {
      return `A stitch in row ${row + 1} reaches beyond the chart of ${columns} × ${rows} stitches.`;
    }
    for (let i = row * columns + column; width && i < row * columns + column + width; i++) {
      if (taken.has(i)) return `Two stitches in row ${row + 1} lie on each other.`;
      taken.add(i);
    }
  }
  return "";
}

/**
 * The codes of a chart, rows from the top, as the service reads them.
 *
 * @param {Grid} grid
 * @param {Others} others
 */
export function codesText({ rows, columns, purl }, others) {
  const lines = [];
  for (let row = rows - 1; row >= 0; row--) {
    let line = "";
    for (let i = row * columns; i < (row + 1) * columns; i++) {
      const code = others.code(i);
      if (code === null) line += purl[i] ? "P" : "K";
      else {
        line += code;
        i += kindOf(code).width - 1;
      }
    }
    lines.push(line);
  }
  return lines.join(";\n");
}

/**
 * The stitches of a box that lie wholly inside it, by their place in it.
 *
 * @param {Others} others
 * @param {number} columns of the chart
 * @param {import("../grid/grid.js").Box} box
 * @returns {{entries: [number, string][], cut: number}} and how many its sides cut
 */
export function within(others, columns, { row0, column0, row1, column1 }) {
  /** @type {[number, string][]} */
  const entries = [];
  let cut = 0;
  for (const [i, code] of others.size ? others.entries : []) {
    const [row, column] = [Math.floor(i / columns), i % columns];
    const end = column + kindOf(code).width;
    if (row < row0 || row >= row1 || column >= column1 || end <= column0) continue;
    if (column < column0 || end > column1) cut++;
    else entries.push([(row - row0) * (column1 - column0) + column - column0, code]);
  }
  return { entries, cut };
}

/**
 * The stitches of a chart that is repeated from the bottom left up to a size, as far as they are whole.
 *
 * @param {{grid: Grid, others: Others}} chart
 * @param {number} rows
 * @param {number} columns
 */
export function tiledStitches({ grid, others }, rows, columns) {
  /** @type {[number, string][]} */
  const put = [];
  for (const [i, code] of others.all) {
    for (let row = Math.floor(i / grid.columns); row < rows; row += grid.rows) {
      for (let column = i % grid.columns; column + kindOf(code).width <= columns; column += grid.columns) {
        put.push([row * columns + column, code]);
      }
    }
  }
  return put;
}

/**
 * Knits and purls under stitches that are put down, and under those above that hold what changes.
 *
 * @param {Brush} brush gets them
 * @param {Uint8Array} purl
 * @param {number} columns
 * @param {Others} others as they will be
 * @param {Iterable<readonly [number, string]>} put
 */
export function settleUnder(brush, purl, columns, others, put) {
  const value = (/** @type {number} */ i) => (brush.has(i) ? brush.values[i] : purl[i]);
  for (const [i, code] of put) {
    [...kindOf(code).shown].forEach((shown, k) => {
      if (shown !== "H") brush.set(i + k, shown === "P" ? 1 : 0);
      else if (i >= columns) brush.set(i + k, value(i + k - columns));
    });
  }
  for (const i of brush.touched.slice()) {
    for (let up = i + columns; up < purl.length && others.holds(up); up += columns) brush.set(up, value(i));
  }
}
