/**
 * The parts of a chart: what lies outside its outline, the edges of regions, and linked repeats. All
 * in face coordinates but the labels.
 *
 * @import {ChartDocument} from "../design/document.js"
 * @import {Box, Grid} from "../grid/grid.js"
 * @import {Edges} from "./edges.js"
 * @import {Viewport} from "./viewport.js"
 * @import {Palette} from "../state/palette.js"
 */

import { edgePath, edgesOf } from "./edges.js";

/**
 * Paint over cells that are not stitches.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {Viewport} view
 * @param {ChartDocument} chart
 * @param {Box} box
 * @param {Palette} palette
 */
export function drawAbsent(context, view, chart, box, palette) {
  const { grid, outline } = chart;
  const { cellWidth: w, cellHeight: h } = view;
  const path = new Path2D();
  for (let row = box.row0; row < box.row1; row++) {
    for (let column = box.column0; column < box.column1; column++) {
      if (outline[row * grid.columns + column]) continue;
      const from = column;
      while (column < box.column1 && !outline[row * grid.columns + column]) column++;
      path.rect(view.x + from * w - 1, view.y + (grid.rows - 1 - row) * h - 1, (column - from) * w + 1, h + 1);
    }
  }
  context.fillStyle = palette.pane;
  context.fill(path);
  context.lineWidth = 1.5;
  context.strokeStyle = palette.muted;
  context.stroke(edgePath(view, grid, known(outline, chart), box));
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {Viewport} view
 * @param {ChartDocument} chart
 * @param {Box} box in view
 * @param {Palette} palette
 */
export function drawRegions(context, view, chart, box, palette) {
  const { grid, regions } = chart;
  const thin = Math.min(view.cellWidth, view.cellHeight) < 6;
  for (const { cells, colour, hidden, locked } of regions) {
    if (hidden) continue;
    const path = edgePath(view, grid, known(cells, chart), box, { inset: thin ? 0.5 : 2 });
    context.setLineDash(locked ? [7, 4] : []);
    context.lineWidth = thin ? 2.5 : 5;
    context.strokeStyle = palette.pane;
    context.stroke(path);
    context.lineWidth = thin ? 1.5 : 3;
    context.strokeStyle = colour;
    context.stroke(path);
  }
  context.setLineDash([]);
}

/**
 * Heavy borders around the copies of linked repeats, fine ones between their motifs.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {Viewport} view
 * @param {ChartDocument} chart
 * @param {Palette} palette
 */
export function drawRepeats(context, view, { grid, repeats }, palette) {
  const { x, y, cellWidth: w, cellHeight: h } = view;
  for (const { motif, placements } of repeats) {
    const heavy = new Path2D();
    const fine = new Path2D();
    for (const { row, column, rows, columns } of placements) {
      const top = y + (grid.rows - row - rows) * h;
      // Inside its stitches, so that redrawing them erases it.
      heavy.rect(x + column * w + 2.25, top + 2.25, columns * w - 4.5, rows * h - 4.5);
      if (motif.columns * w < 14 || motif.rows * h < 14) continue;
      for (let c = column + motif.columns; c < column + columns; c += motif.columns) {
        fine.moveTo(x + c * w, top);
        fine.lineTo(x + c * w, top + rows * h);
      }
      for (let r = row + motif.rows; r < row + rows; r += motif.rows) {
        fine.moveTo(x + column * w, y + (grid.rows - r) * h);
        fine.lineTo(x + (column + columns) * w, y + (grid.rows - r) * h);
      }
    }
    context.strokeStyle = palette.text;
    context.lineWidth = 1;
    context.setLineDash([4, 3]);
    context.stroke(fine);
    context.setLineDash([]);
    context.lineWidth = 4.5;
    context.strokeStyle = palette.pane;
    context.stroke(heavy);
    context.lineWidth = 2.5;
    context.strokeStyle = palette.text;
    context.stroke(heavy);
  }
}

/**
 * Names of repeats with their numbers of motifs, on copies so large that these can still be seen. Not
 * mirrored: text must be read.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {Viewport} view
 * @param {ChartDocument} chart
 * @param {Palette} palette
 */
export function drawRepeatLabels(context, view, { grid, repeats }, palette) {
  if (!repeats.length) return; // setting a font is slow
  context.font = "600 13px system-ui, sans-serif";
  context.textAlign = "left";
  context.textBaseline = "middle";
  for (const { name, motif, placements } of repeats) {
    for (const { row, column, rows, columns } of placements) {
      const box = { row0: row, column0: column, row1: row + rows, column1: column + columns };
      const { x, y, width, height } = view.place(box, grid);
      /** @param {number} n @param {number} of */
      const times = (n, of) => String(Math.floor(n / of));
      const count = `${times(columns, motif.columns)} × ${times(rows, motif.rows)}`;
      const text = [`${name}  ${count}`, count].find((label) => context.measureText(label).width + 12 <= width);
      if (!text || height < 57) continue;
      const wide = context.measureText(text).width + 10;
      context.fillStyle = palette.text;
      context.fillRect(x + 1, y + 1, wide, 19);
      context.fillStyle = palette.pane;
      context.fillText(text, x + 6, y + 11);
    }
  }
}

/** Edges of bitmaps, as long as these do not change. @type {WeakMap<Uint8Array, {edition: number, edges: Edges}>} */
const knownEdges = new WeakMap();

/** @param {Uint8Array} cells of the chart @param {ChartDocument} chart */
function known(cells, chart) {
  const edition = chart.edition(cells);
  let entry = knownEdges.get(cells);
  if (entry?.edition !== edition) {
    entry = { edition, edges: edgesOf(cells, chart.grid.rows, chart.grid.columns) };
    knownEdges.set(cells, entry);
  }
  return entry.edges;
}

/**
 * The edge of a selection that is not a whole box.
 *
 * @param {Viewport} view
 * @param {Grid} grid
 * @param {Box & {mask: Uint8Array}} selection
 */
export function selectionEdge(view, grid, { mask, row0, column0, row1, column1 }) {
  let entry = knownEdges.get(mask);
  if (!entry) knownEdges.set(mask, (entry = { edition: 0, edges: edgesOf(mask, row1 - row0, column1 - column0) }));
  return edgePath(view, grid, entry.edges, view.visible(grid), { row: row0, column: column0 });
}
