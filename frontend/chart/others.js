/**
 * Stitches that are neither knit nor purl, on the canvas: a ground in the colour of their group, and their
 * symbol where there is room for it. In face coordinates.
 *
 * @import {Box} from "../grid/grid.js"
 * @import {ChartDocument} from "../design/document.js"
 * @import {ColourLayer} from "./layer.js"
 * @import {Viewport} from "./viewport.js"
 * @import {Symbols} from "../state/editing.js"
 * @import {Palette} from "../state/palette.js"
 */

import { IMAGES, kindOf } from "../grid/kinds.js";
import { lightness } from "../state/palette.js";
import { addSign, loadSigns, signOf } from "./symbols.js";

/** Colourings that are no maps of numbers: there these stitches have the colours of their groups. */
export const GROUNDED = new Set(["stitches", "fabrics", "segments"]);
/** Symbols are left out on cells narrower than this. */
const MIN_SYMBOL = 7;

/**
 * Those of a box, with where each is drawn.
 *
 * @param {Viewport} view
 * @param {ChartDocument} chart
 * @param {Box} box
 */
function* seen({ x, y, cellWidth: w, cellHeight: h }, { grid, others }, { row0, column0, row1, column1 }) {
  for (const [i, code] of others.all) {
    const [row, column] = [Math.floor(i / grid.columns), i % grid.columns];
    const kind = kindOf(code);
    if (row < row0 || row >= row1 || column >= column1 || column + kind.width <= column0) continue;
    yield { row, column, kind, left: x + column * w, top: y + (grid.rows - 1 - row) * h };
  }
}

/**
 * The ground of each in the colour of its group; one of several columns has no lines within.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {Viewport} view
 * @param {ChartDocument} chart
 * @param {Box} box
 * @param {Palette} palette
 */
export function drawGrounds(context, view, chart, box, palette) {
  const line = view.cellWidth < 5 ? 0 : 1 / view.dpr;
  /** @type {Record<string, Path2D>} */
  const paths = {};
  for (const { kind, left, top } of seen(view, chart, box)) {
    const path = (paths[kind.group] ??= new Path2D());
    path.rect(left, top, kind.width * view.cellWidth - line, view.cellHeight - line);
  }
  for (const [group, path] of Object.entries(paths)) {
    context.fillStyle = palette.groups[group];
    context.fill(path);
  }
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {Viewport} view
 * @param {ChartDocument} chart
 * @param {Box} box
 * @param {{layer: ColourLayer | null, palette: Palette, symbols: Symbols, back: boolean}} how the layer's colours
 *   are below them; none where they have grounds of their own
 */
export function drawSigns(context, view, chart, box, { layer, palette, symbols, back }) {
  const { cellWidth: w, cellHeight: h } = view;
  if (Math.min(w, h) < MIN_SYMBOL) return;
  void loadSigns();
  const onLight = { stroke: new Path2D(), fill: new Path2D() };
  const onDark = { stroke: new Path2D(), fill: new Path2D() };
  for (const { row, column, kind, left, top } of seen(view, chart, box)) {
    const light = layer ? lightness(layer.pixelAt(chart.grid, row, column)) > 0.5 : !palette.dark;
    // the view exchanges left and right for the back
    const sign = signOf(back ? IMAGES.swapped(kind.code) : kind.code, symbols);
    const wide = kind.width > 1 ? w : Math.min(w, 1.15 * h); // a ring stays round
    addSign(light ? onLight : onDark, sign, left + (kind.width > 1 ? 0 : (w - wide) / 2), top, wide, h);
  }
  context.lineCap = context.lineJoin = "round";
  context.lineWidth = Math.min(2.6, Math.max(1.25, Math.min(w, h) * 0.09));
  for (const [paths, colour] of /** @type {const} */ ([
    [onLight, "rgb(24 18 14 / 0.92)"],
    [onDark, "rgb(255 252 246 / 0.95)"],
  ])) {
    context.strokeStyle = context.fillStyle = colour;
    context.stroke(paths.stroke);
    context.fill(paths.fill);
  }
}
