/**
 * Where the chart lies on its canvas, in CSS pixels, and which stitch is where. Cells have the
 * proportions of real stitches.
 *
 * @import {Box, Grid} from "../grid/grid.js"
 * @import {Cell} from "../grid/raster.js"
 */

/** Room for the rulers. */
export const MARGIN = { left: 50, right: 50, top: 42, bottom: 32 };
const LARGEST = 44;
const MAX_ENLARGED = 72;

export class Viewport {
  width = 1;
  height = 1;
  dpr = 1;
  /** Height of a stitch over its width. */
  aspect = 0.8;
  cellWidth = 10;
  cellHeight = 8;
  /** The exact zoom: cells are rounded, and small steps would be lost. */
  #preferredWidth = 10;
  /** Upper left corner of the chart. */
  x = 0;
  y = 0;
  /** Whether the whole chart is kept in view. */
  fitted = true;
  /** Whether left and right are exchanged, as on the cloth's back. */
  mirrored = false;

  /** @param {Grid} grid */
  fit({ rows, columns }) {
    const wide = this.width - MARGIN.left - MARGIN.right;
    const high = this.height - MARGIN.top - MARGIN.bottom;
    this.#size(Math.min(LARGEST, wide / columns, high / (rows * this.aspect)));
    this.x = this.#whole(MARGIN.left + (wide - this.cellWidth * columns) / 2);
    this.y = this.#whole(MARGIN.top + (high - this.cellHeight * rows) / 2);
    this.fitted = true;
  }

  /**
   * @param {number} factor
   * @param {number} px point that stays, in CSS pixels
   * @param {number} py
   * @param {Grid} grid
   */
  zoom(factor, px, py, grid) {
    const smallest = Math.min(this.#fittedWidth(grid), LARGEST);
    const width = Math.min(MAX_ENLARGED, Math.max(smallest, this.#preferredWidth * factor));
    if (width <= smallest * 1.001) {
      this.fit(grid);
      return;
    }
    const column = (px - this.x) / this.cellWidth;
    const row = (py - this.y) / this.cellHeight;
    this.#size(width);
    this.x = px - column * this.cellWidth;
    this.y = py - row * this.cellHeight;
    this.fitted = false;
    this.#keepInView(grid);
  }

  /** @param {number} dx @param {number} dy @param {Grid} grid */
  pan(dx, dy, grid) {
    this.x += dx;
    this.y += dy;
    this.fitted = false;
    this.#keepInView(grid);
  }

  /**
   * The stitch at a point; may lie outside the chart.
   *
   * @param {number} px
   * @param {number} py
   * @param {Grid} grid
   * @returns {Cell}
   */
  cellAt(px, py, grid) {
    const column = Math.floor((px - this.x) / this.cellWidth);
    return [
      grid.rows - 1 - Math.floor((py - this.y) / this.cellHeight),
      this.mirrored ? grid.columns - 1 - column : column,
    ];
  }

  /** Where a box of stitches lies on the canvas. @param {Box} box @param {Grid} grid */
  place({ row0, column0, row1, column1 }, grid) {
    const first = this.mirrored ? grid.columns - column1 : column0;
    return {
      x: this.x + first * this.cellWidth,
      y: this.y + (grid.rows - row1) * this.cellHeight,
      width: (column1 - column0) * this.cellWidth,
      height: (row1 - row0) * this.cellHeight,
    };
  }

  /** Stitches at least partly in view. @param {Grid} grid @returns {Box} */
  visible(grid) {
    const [row1, a] = this.cellAt(MARGIN.left, MARGIN.top, grid);
    const [row0, b] = this.cellAt(this.width - MARGIN.right, this.height - MARGIN.bottom, grid);
    return {
      row0: Math.max(0, row0),
      column0: Math.max(0, Math.min(a, b)),
      row1: Math.min(grid.rows, row1 + 1),
      column1: Math.min(grid.columns, Math.max(a, b) + 1),
    };
  }

  /** @param {Grid} grid */
  #fittedWidth({ rows, columns }) {
    const wide = this.width - MARGIN.left - MARGIN.right;
    const high = this.height - MARGIN.top - MARGIN.bottom;
    return Math.min(wide / columns, high / (rows * this.aspect));
  }

  /** Cells of whole device pixels, where that matters. @param {number} width */
  #size(width) {
    this.#preferredWidth = width;
    const crisp = width * this.dpr > 5;
    this.cellWidth = crisp ? Math.floor(width * this.dpr) / this.dpr : Math.max(width, 0.5);
    const height = this.cellWidth * this.aspect;
    this.cellHeight = crisp ? Math.round(height * this.dpr) / this.dpr : height;
  }

  /** @param {Grid} grid */
  #keepInView({ rows, columns }) {
    const reach = 80;
    const wide = this.cellWidth * columns;
    const high = this.cellHeight * rows;
    this.x = Math.min(this.width - reach, Math.max(reach - wide, this.x));
    this.y = Math.min(this.height - reach, Math.max(reach - high, this.y));
    this.x = this.#whole(this.x);
    this.y = this.#whole(this.y);
  }

  /** @param {number} value */
  #whole(value) {
    return Math.round(value * this.dpr) / this.dpr;
  }
}
