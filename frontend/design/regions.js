/**
 * Named parts of the chart. Later regions lie on top of earlier ones.
 *
 * @import {RegionItem} from "./design.js"
 * @import {Grid} from "../grid/grid.js"
 * @import {Layer} from "../grid/stroke.js"
 */

import { rowRuns } from "../grid/bits.js";
import { motifGrid, motifText } from "../grid/grid.js";
import { Brush } from "../grid/stroke.js";

/**
 * @typedef {object} RegionLook
 * @property {string} name
 * @property {string} colour #rrggbb
 * @property {string | null} yarn of intarsia; null is the main yarn
 * @property {Grid | null} fill repeat that fills it, laid from the chart's corner
 * @property {boolean} locked its stitches cannot be painted
 * @property {boolean} hidden its outline is not drawn
 */

/** The look never changes: {@link Region.with} makes another one. The cells do, while painting. */
export class Region {
  /**
   * @param {string} id
   * @param {RegionLook} look
   * @param {Uint8Array} cells 1 where the stitch belongs to the region
   */
  constructor(id, look, cells) {
    this.id = id;
    this.name = look.name;
    this.colour = look.colour;
    this.yarn = look.yarn;
    this.fill = look.fill;
    this.locked = look.locked;
    this.hidden = look.hidden;
    this.cells = cells;
  }

  /** The same stitches with another name, colour, yarn, fill or lock. @param {Partial<RegionLook>} changes */
  with(changes) {
    return new Region(this.id, { ...this, ...changes }, this.cells);
  }

  /** @param {Uint8Array} cells */
  withCells(cells) {
    return new Region(this.id, this, cells);
  }

  /** Indices of its stitches. @returns {number[]} */
  get stitches() {
    const stitches = [];
    for (let i = 0; i < this.cells.length; i++) if (this.cells[i]) stitches.push(i);
    return stitches;
  }

  get count() {
    let count = 0;
    for (const cell of this.cells) count += cell;
    return count;
  }

  /** The stitch that its fill puts at a place. @param {number} row @param {number} column */
  filling(row, column) {
    const fill = /** @type {Grid} */ (this.fill);
    return fill.purl[(row % fill.rows) * fill.columns + (column % fill.columns)];
  }

  /** @param {RegionItem} item @param {number} rows @param {number} columns */
  static read(item, rows, columns) {
    const cells = new Uint8Array(rows * columns);
    for (const [row, column, length] of item.runs) {
      cells.fill(1, row * columns + column, row * columns + column + length);
    }
    return new Region(item.id, { ...item, fill: item.fill === null ? null : motifGrid(item.fill) }, cells);
  }

  /** @param {number} columns @returns {RegionItem} */
  written(columns) {
    const { id, name, colour, yarn, fill, locked, hidden } = this;
    const runs = rowRuns(this.cells, columns);
    return { id, name, colour, yarn, fill: fill && motifText(fill), runs, locked, hidden };
  }
}

/**
 * The stitches of a region's fill, without those of filled regions above it; under a stroke, only
 * where it has added to the region.
 *
 * @param {Region} region
 * @param {{grid: Grid, regions: readonly Region[]}} chart
 * @param {Layer} [added]
 */
export function filling(region, { grid, regions }, added) {
  const at = regions.findIndex(({ id }) => id === region.id);
  const above = regions.slice(at + 1).filter(({ fill }) => fill);
  const brush = new Brush(region.cells.length);
  const { row0, row1, column0, column1 } = (added ? added.reach : null) ?? grid.box;
  for (let row = row0; row < row1; row++) {
    for (let column = column0; column < column1; column++) {
      const i = grid.index(row, column);
      if (!region.cells[i] || (added && !added.has(i)) || above.some(({ cells }) => cells[i])) continue;
      brush.set(i, region.filling(row, column));
    }
  }
  return brush;
}

/**
 * Whether a region looks as its fill says, or was painted over since.
 *
 * @param {Region} region
 * @param {{grid: Grid, regions: readonly Region[]}} chart
 */
export function isFilled(region, chart) {
  const { touched, values } = filling(region, chart);
  return [...touched].every((i) => chart.grid.purl[i] === values[i]);
}

/**
 * The stitches of fills that lie on top once the regions are in another order, but did not before.
 *
 * @param {{grid: Grid, regions: readonly Region[]}} chart
 * @param {readonly Region[]} regions the same in their new order
 */
export function uncovered(chart, regions) {
  const brush = new Brush(chart.grid.purl.length);
  for (const region of regions) {
    if (!region.fill) continue;
    const before = new Set(filling(region, chart).touched);
    const after = filling(region, { grid: chart.grid, regions });
    for (const i of after.touched) if (!before.has(i)) brush.set(i, after.values[i]);
  }
  return brush;
}
