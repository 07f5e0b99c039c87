/**
 * What is drawn over the cells' colours: symbols, the grid, segments. All
 * of it in face coordinates: the view exchanges left and right for the back.
 *
 * @import {Box, Grid} from "../grid/grid.js"
 * @import {Viewport} from "./viewport.js"
 * @import {ColourLayer} from "./layer.js"
 * @import {Palette} from "../state/palette.js"
 */

import { lightness } from "../state/palette.js";

/** Symbols are left out on cells narrower than this. */
const MIN_SYMBOL = 7;

/**
 * The symbols of knits and purls, or every stitch as it looks in the cloth.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {Viewport} view
 * @param {Grid} grid
 * @param {ColourLayer} layer
 * @param {Box} box
 * @param {import("../state/editing.js").Symbols | "loops"} style
 * @param {boolean} back
 * @param {import("../design/others.js").Others} others stitches with symbols of their own
 */
export function drawSymbols(context, view, grid, layer, box, style, back, others) {
  const { cellWidth: w, cellHeight: h } = view;
  if (Math.min(w, h) < MIN_SYMBOL) return;
  const onLight = new Path2D();
  const onDark = new Path2D();
  const radius = Math.min(w, h) * 0.15;
  const thick = Math.max(1, Math.min(w, h) * 0.12);
  const turned = back ? 1 : 0;
  for (let row = box.row0; row < box.row1; row++) {
    const y = view.y + (grid.rows - 1 - row) * h;
    for (let column = box.column0; column < box.column1; column++) {
      const purl = grid.purl[row * grid.columns + column] !== turned;
      if (!purl && (style === "dots" || style === "dashes")) continue;
      if (others.size && others.start(row * grid.columns + column) !== undefined) continue;
      const x = view.x + column * w;
      const path = lightness(layer.pixelAt(grid, row, column)) > 0.5 ? onLight : onDark;
      if (style === "dots") {
        path.moveTo(x + w / 2 + radius, y + h / 2);
        path.arc(x + w / 2, y + h / 2, radius, 0, 2 * Math.PI);
      } else if (style !== "loops") {
        if (purl) path.rect(x + 0.22 * w, y + (h - thick) / 2, 0.56 * w, thick);
        else path.rect(x + (w - thick) / 2, y + 0.22 * h, thick, 0.56 * h);
      } else if (purl) {
        path.moveTo(x + 0.12 * w, y + 0.62 * h);
        path.bezierCurveTo(x + 0.2 * w, y + 0.2 * h, x + 0.8 * w, y + 0.2 * h, x + 0.88 * w, y + 0.62 * h);
        path.moveTo(x + 0.3 * w, y + 0.78 * h);
        path.quadraticCurveTo(x + 0.5 * w, y + 0.6 * h, x + 0.7 * w, y + 0.78 * h);
      } else {
        path.moveTo(x + 0.16 * w, y + 0.14 * h);
        path.quadraticCurveTo(x + 0.3 * w, y + 0.6 * h, x + 0.47 * w, y + 0.86 * h);
        path.moveTo(x + 0.84 * w, y + 0.14 * h);
        path.quadraticCurveTo(x + 0.7 * w, y + 0.6 * h, x + 0.53 * w, y + 0.86 * h);
      }
    }
  }
  if (style !== "loops") {
    context.fillStyle = "rgb(20 16 12 / 0.62)";
    context.fill(onLight);
    context.fillStyle = "rgb(255 252 246 / 0.8)";
    context.fill(onDark);
    return;
  }
  context.lineCap = "round";
  context.lineWidth = Math.max(1, Math.min(w, h) * 0.11);
  context.strokeStyle = "rgb(20 16 12 / 0.5)";
  context.stroke(onLight);
  context.strokeStyle = "rgb(255 252 246 / 0.6)";
  context.stroke(onDark);
}

/**
 * Fine lines between stitches, stronger ones every ten (counted from the right and the bottom).
 *
 * @param {CanvasRenderingContext2D} context
 * @param {Viewport} view
 * @param {Grid} grid
 * @param {Box} box
 * @param {Palette} palette
 */
export function drawGrid(context, view, grid, box, palette) {
  const { cellWidth: w, cellHeight: h } = view;
  const tone = palette.dark ? "0 0 0" : "60 45 30";
  const fine = new Path2D();
  const strong = new Path2D();
  const left = view.x + box.column0 * w;
  const right = view.x + box.column1 * w;
  const top = view.y + (grid.rows - box.row1) * h;
  const bottom = view.y + (grid.rows - box.row0) * h;
  const half = 0.5 / view.dpr;
  for (let column = box.column0; column <= box.column1; column++) {
    const ten = (grid.columns - column) % 10 === 0;
    if (!ten && w < 5) continue;
    const path = ten ? strong : fine;
    path.moveTo(view.x + column * w - half, top);
    path.lineTo(view.x + column * w - half, bottom);
  }
  for (let row = box.row0; row <= box.row1; row++) {
    const ten = row % 10 === 0;
    if (!ten && h < 5) continue;
    const path = ten ? strong : fine;
    path.moveTo(left, view.y + (grid.rows - row) * h - half);
    path.lineTo(right, view.y + (grid.rows - row) * h - half);
  }
  context.lineWidth = 1 / view.dpr;
  context.strokeStyle = `rgb(${tone} / ${palette.dark ? 0.35 : 0.16})`;
  context.stroke(fine);
  context.strokeStyle = `rgb(${tone} / ${palette.dark ? 0.6 : 0.38})`;
  context.stroke(strong);
}

/**
 * Every segment as a short bar across the border of the two stitches that it joins.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {Viewport} view
 * @param {Grid} grid
 * @param {Box} box
 * @param {Palette} palette
 */
export function drawSegments(context, view, grid, box, palette) {
  const { cellWidth: w, cellHeight: h } = view;
  const even = new Path2D();
  const odd = new Path2D();
  const thick = Math.max(1.2, Math.min(w, h) * 0.2);
  const along = 0.5 * w;
  const up = 0.5 * h;
  for (let row = box.row0; row < box.row1; row++) {
    const y = view.y + (grid.rows - 1 - row) * h;
    for (let column = box.column0; column < box.column1; column++) {
      const i = row * grid.columns + column;
      const x = view.x + column * w;
      if (column + 1 < grid.columns) {
        const path = grid.purl[i] === grid.purl[i + 1] ? even : odd;
        path.rect(x + w - along / 2, y + h / 2 - thick / 2, along, thick);
      }
      if (row + 1 < grid.rows) {
        const path = grid.purl[i] === grid.purl[i + grid.columns] ? even : odd;
        path.rect(x + w / 2 - thick / 2, y - up / 2, thick, up);
      }
    }
  }
  context.fillStyle = palette.even;
  context.fill(even);
  context.fillStyle = palette.odd;
  context.fill(odd);
}
