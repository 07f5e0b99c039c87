/**
 * Pictures of inks that have other stitches than knits and purls.
 *
 * @import {Ink} from "../../design/ink.js"
 * @import {Symbols} from "../../state/editing.js"
 */

import { addSign, signOf } from "../../chart/symbols.js";
import { h } from "../../elements/dom.js";
import { kindOf } from "../../grid/kinds.js";
import { readPalette } from "../../state/palette.js";

const SIDE = 96;
/** Cells of more than this many pixels would be larger than those of single stitches. */
const LARGEST = 48;

/** Address of an image of one repeat, on the colours of its stitches. @param {Ink} ink @param {Symbols} symbols */
export function motifPicture({ repeat, others }, symbols) {
  const canvas = h("canvas", { width: SIDE, height: SIDE });
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d", { willReadFrequently: true }));
  const palette = readPalette();
  const css = (/** @type {number[]} */ rgb) => `rgb(${rgb.join(" ")})`;
  const { rows, columns, purl } = /** @type {import("../../grid/grid.js").Grid} */ (repeat);
  const cell = Math.min(LARGEST, SIDE / Math.max(rows, columns));
  const [left, bottom] = [(SIDE - columns * cell) / 2, (SIDE + rows * cell) / 2];
  const paths = { stroke: new Path2D(), fill: new Path2D() };
  const covered = new Set(
    others.flatMap(([row, column, code]) => [...kindOf(code).shown].map((_, k) => row * columns + column + k)),
  );
  purl.forEach((p, i) => {
    const [x, y] = [left + (i % columns) * cell, bottom - (Math.floor(i / columns) + 1) * cell];
    context.fillStyle = css(p ? palette.purl : palette.knit);
    context.fillRect(x, y, cell + 0.3, cell + 0.3);
    if (!covered.has(i) && p) addSign(paths, signOf("P", symbols), x, y, cell, cell);
  });
  for (const [row, column, code] of others) {
    const { width, group } = kindOf(code);
    const [x, y] = [left + column * cell, bottom - (row + 1) * cell];
    context.fillStyle = palette.groups[group];
    context.fillRect(x, y, width * cell, cell);
    addSign(paths, signOf(code, symbols), x, y, cell, cell);
  }
  context.strokeStyle = context.fillStyle = palette.text;
  context.lineWidth = Math.max(1.4, cell * 0.09);
  context.lineCap = context.lineJoin = "round";
  context.stroke(paths.stroke);
  context.fill(paths.fill);
  return canvas.toDataURL();
}
