/**
 * What the numbers are of: the whole chart, the selection, or a region.
 *
 * @import {Grid} from "../core/grid.js"
 * @import {ChartState} from "../core/state.js"
 * @import {Selection} from "../core/selection.js"
 * @import {Studio} from "../studio.js"
 *
 * @typedef {object} Scope
 * @property {"chart" | "selection" | "region"} kind
 * @property {string} title
 * @property {string} size in words
 * @property {Grid} grid the stitches whose moduli are shown, as a chart of their own
 * @property {{grid: Grid, mask: Uint8Array | null}} counted the stitches whose segments are counted
 * @property {string} note how the grid represents stitches that do not form a rectangle; "" if they do
 */

import { largestRectangle } from "../core/inscribed.js";
import { selectionOf } from "../core/selection.js";

/**
 * @param {Studio} studio
 * @returns {Scope}
 */
export function scopeOf(studio) {
  const { document: chart, selection, seeing } = studio;
  const box = selection.value;
  if (box) return partOf(box, chart.grid, "selection", "Selection");
  return scopeIn(chart, seeing.region.value);
}

/**
 * A region of a chart, or the whole.
 *
 * @param {ChartState} chart
 * @param {string | null} id of the region
 * @returns {Scope}
 */
export function scopeIn(chart, id) {
  const { grid } = chart;
  const region = id === null ? null : chart.region(id);
  if (!region?.count) {
    const size = `${grid.columns} × ${grid.rows}`;
    const counted = { grid, mask: chart.shaped ? chart.outline : null };
    const inside = chart.shaped ? largestRectangle(chart.outline, grid.columns) : null;
    const part = inside ? grid.region(inside) : grid;
    const note = inside
      ? `Of the largest rectangle inside the fabric, ${part.columns} × ${part.rows} stitches: its other parts are regions.`
      : "";
    return { kind: "chart", title: "Whole chart", size, grid: part, counted, note };
  }
  const around = /** @type {Selection} */ (selectionOf(region.cells, grid));
  const part = partOf(around, grid, "region", region.name);
  return region.fill ? { ...part, grid: region.fill, note: "Of the repeat that fills it." } : part;
}

/**
 * @param {Selection} box
 * @param {Grid} chart
 * @param {"selection" | "region"} kind
 * @param {string} title
 * @returns {Scope}
 */
function partOf(box, chart, kind, title) {
  const grid = chart.region(box);
  const { mask = null } = box;
  const counted = { grid, mask };
  const inside = mask && largestRectangle(mask, grid.columns);
  if (!mask || !inside) return { kind, title, size: `${grid.columns} × ${grid.rows}`, grid, counted, note: "" };
  const part = grid.region(inside);
  const stitches = mask.reduce((sum, one) => sum + one, 0);
  const note = `Moduli of the largest rectangle inside it, ${part.columns} × ${part.rows} stitches.`;
  return { kind, title, size: `${stitches} stitches`, grid: part, counted, note };
}
