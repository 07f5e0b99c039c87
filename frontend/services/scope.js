/**
 * What the numbers are of: the whole chart, the selection, or a region.
 *
 * @import {Grid} from "../core/grid.js"
 * @import {Studio} from "../studio.js"
 *
 * @typedef {object} Scope
 * @property {"chart" | "selection" | "region"} kind
 * @property {string} title
 * @property {Grid} grid the stitches, as a chart of their own
 * @property {string} note how the grid stands for stitches that are no rectangle; "" where it is them
 */

import { largestRectangle } from "../core/inscribed.js";
import { selectionOf } from "../core/selection.js";

/**
 * @param {Studio} studio
 * @returns {Scope}
 */
export function scopeOf(studio) {
  const { document: chart, selection, seeing } = studio;
  const { grid } = chart;
  const box = selection.value;
  if (box) {
    const note = box.mask ? "Of the rectangle around the selected stitches." : "";
    return { kind: "selection", title: "Selection", grid: grid.region(box), note };
  }
  const region = seeing.region.value === null ? null : chart.region(seeing.region.value);
  if (!region?.count) {
    const inside = chart.shaped ? largestRectangle(chart.outline, grid.columns) : null;
    if (!inside) return { kind: "chart", title: "Whole chart", grid, note: "" };
    const part = grid.region(inside);
    const note = `Of the largest rectangle inside the fabric, ${part.columns} × ${part.rows} stitches: its other parts are regions.`;
    return { kind: "chart", title: "Whole chart", grid: part, note };
  }
  const title = region.name;
  if (region.fill) return { kind: "region", title, grid: region.fill, note: "Of the repeat that fills it." };
  const around = /** @type {import("../core/selection.js").Selection} */ (selectionOf(region.cells, grid));
  const note = around.mask ? "Of the rectangle around the region." : "";
  return { kind: "region", title, grid: grid.region(around), note };
}

/**
 * Stitches of the smallest repeat whose continuation, cut anywhere, gives this chart.
 *
 * @param {Grid} grid
 */
export function repeatSize({ rows, columns, purl }) {
  /**
   * @param {number} length
   * @param {number} stride between neighbours along it
   */
  const period = (length, stride) => {
    for (let p = 1; 2 * p <= length; p++) {
      const same = purl.every((stitch, i) => {
        const at = stride === 1 ? i % columns : Math.floor(i / columns);
        return at + p >= length || stitch === purl[i + p * stride];
      });
      if (same) return p;
    }
    return length;
  };
  return period(columns, 1) * period(rows, columns);
}
