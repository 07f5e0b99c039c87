/**
 * A part of a chart in the hand: lifted from its place or pasted, it can be put down again and again,
 * and what lay under it comes back.
 *
 * @import {Grid} from "../grid/grid.js"
 * @import {Cell} from "../grid/raster.js"
 * @import {Selection} from "./selection.js"
 */

import { selects, selectionOf } from "./selection.js";

/** Some stitches of a box, to be copied elsewhere. */
export class Clip {
  /** @param {Grid} part @param {Uint8Array | null} mask 1 where the clip has a stitch; null: everywhere */
  constructor(part, mask = null) {
    this.part = part;
    this.mask = mask;
  }

  /** @param {Grid} grid @param {Selection} selection */
  static of(grid, selection) {
    return new Clip(grid.region(selection), selection.mask ?? null);
  }

  /**
   * Stitches of the clip when its lower left corner lies at a place: index in the chart and value.
   *
   * @param {Grid} grid
   * @param {Cell} place
   * @returns {[number, number][]} only those within the chart
   */
  at(grid, [row0, column0]) {
    const { part, mask } = this;
    /** @type {[number, number][]} */
    const cells = [];
    for (let row = 0, k = 0; row < part.rows; row++) {
      for (let column = 0; column < part.columns; column++, k++) {
        if (mask && !mask[k]) continue;
        if (grid.has(row0 + row, column0 + column)) {
          cells.push([grid.index(row0 + row, column0 + column), part.purl[k]]);
        }
      }
    }
    return cells;
  }
}

export class Floating {
  /**
   * @param {Clip} clip
   * @param {Cell} place of its lower left corner
   * @param {Uint8Array} under all stitches of the chart without it
   */
  constructor(clip, place, under) {
    this.clip = clip;
    this.place = place;
    this.under = under;
  }

  /**
   * @param {Grid} grid
   * @param {Selection} selection
   * @param {boolean} copy whether the stitches stay behind, too; else knits do
   */
  static lift(grid, selection, copy) {
    const clip = Clip.of(grid, selection);
    /** @type {Cell} */
    const place = [selection.row0, selection.column0];
    const under = grid.purl.slice();
    if (!copy) for (const [i] of clip.at(grid, place)) under[i] = 0;
    return new Floating(clip, place, under);
  }

  /**
   * What stitches become when it is put elsewhere.
   *
   * @param {Grid} grid
   * @param {Cell} place
   * @returns {Map<number, number>}
   */
  moved(grid, place) {
    const cells = new Map();
    for (const [i] of this.clip.at(grid, this.place)) cells.set(i, this.under[i]);
    for (const [i, value] of this.clip.at(grid, place)) cells.set(i, value);
    return cells;
  }

  /** @param {Grid} grid @param {Cell} place @returns {Selection | null} what of it lies within the chart */
  selection(grid, place) {
    const bitmap = new Uint8Array(grid.purl.length);
    for (const [i] of this.clip.at(grid, place)) bitmap[i] = 1;
    return selectionOf(bitmap, grid);
  }
}

/**
 * A selection's stitches changed within its box, such as mirrored: index and value. What the changed
 * shape leaves becomes knit.
 *
 * @param {Grid} grid
 * @param {Selection} selection
 * @param {(part: Grid) => Grid} change keeps the size
 * @param {(mask: Grid) => Grid} [move] how the shape changes; as it is if left out
 * @returns {Map<number, number>}
 */
export function changed(grid, selection, change, move = (mask) => mask) {
  const part = change(grid.region(selection));
  const { row0, column0 } = selection;
  const shape = grid.region(selection);
  shape.purl.forEach((_, k) => {
    const [row, column] = [Math.floor(k / shape.columns), k % shape.columns];
    shape.purl[k] = selects(selection, row0 + row, column0 + column) ? 1 : 0;
  });
  const moved = move(shape);
  const cells = new Map();
  shape.purl.forEach((before, k) => {
    const i = grid.index(row0 + Math.floor(k / shape.columns), column0 + (k % shape.columns));
    if (moved.purl[k]) cells.set(i, part.purl[k]);
    else if (before) cells.set(i, 0);
  });
  return cells;
}
