/**
 * A part of a chart in the hand: lifted from its place or pasted, it can be put down again and again,
 * and what lay under it comes back.
 *
 * @import {Grid} from "../grid/grid.js"
 * @import {Cell} from "../grid/raster.js"
 * @import {Selection} from "./selection.js"
 */

import { IMAGES, kindOf } from "../grid/kinds.js";
import { Others, codesText, within } from "./others.js";
import { selects, selectionOf } from "./selection.js";

/** Some stitches of a box, to be copied elsewhere. */
export class Clip {
  /**
   * @param {Grid} part
   * @param {Uint8Array | null} mask 1 where the clip has a stitch; null: everywhere
   * @param {[number, string][]} [others] its stitches that are neither knit nor purl
   */
  constructor(part, mask = null, others = []) {
    this.part = part;
    this.mask = mask;
    this.others = others;
  }

  /** Its stitches as text for other programs. */
  get text() {
    return this.others.length ? codesText(this.part, Others.of(this.others)) : this.part.text;
  }

  /** @param {{grid: Grid, others: Others}} chart @param {Selection} selection */
  static of({ grid, others }, selection) {
    return new Clip(grid.region(selection), selection.mask ?? null, selected(others, grid, selection));
  }

  /**
   * Its other stitches when its lower left corner lies at a place, as far as they are wholly within the chart.
   *
   * @param {Grid} grid
   * @param {Cell} place
   * @returns {[number, string][]}
   */
  stitchesAt(grid, [row0, column0]) {
    const { columns } = this.part;
    return this.others.flatMap(([k, code]) => {
      const [row, column] = [row0 + Math.floor(k / columns), column0 + (k % columns)];
      const fits = grid.has(row, column) && grid.has(row, column + kindOf(code).width - 1);
      return fits ? [/** @type {[number, string]} */ ([grid.index(row, column), code])] : [];
    });
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
   * @param {readonly (readonly [number, string])[]} [others] those that are neither knit nor purl
   */
  constructor(clip, place, under, others = []) {
    this.clip = clip;
    this.place = place;
    this.under = under;
    this.others = others;
  }

  /**
   * @param {{grid: Grid, others: Others}} chart
   * @param {Selection} selection
   * @param {boolean} copy whether the stitches stay behind, too; else knits do
   */
  static lift(chart, selection, copy) {
    const { grid } = chart;
    const clip = Clip.of(chart, selection);
    /** @type {Cell} */
    const place = [selection.row0, selection.column0];
    const under = grid.purl.slice();
    const lifted = new Set();
    if (!copy) {
      for (const [i] of clip.at(grid, place)) {
        under[i] = 0;
        lifted.add(chart.others.start(i));
      }
    }
    const left = chart.others.entries.filter(([i]) => !lifted.has(i));
    return new Floating(clip, place, under, left);
  }

  /**
   * Other stitches to put when it is put elsewhere: those that lay under it, and its own.
   *
   * @param {Grid} grid
   * @param {Cell} place
   */
  put(grid, place) {
    const was = new Set(this.clip.at(grid, this.place).map(([i]) => i));
    const now = new Set(this.clip.at(grid, place).map(([i]) => i));
    const back = this.others.filter(([i, code]) => {
      const cells = Array.from({ length: kindOf(code).width }, (_, k) => i + k);
      return cells.some((cell) => was.has(cell)) && !cells.some((cell) => now.has(cell));
    });
    return [...back, ...this.clip.stitchesAt(grid, place)];
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
 * The stitches that are neither knit nor purl and wholly selected, by their place in the selection's box.
 *
 * @param {Others} others
 * @param {Grid} grid
 * @param {Selection} selection
 */
function selected(others, { columns }, selection) {
  const { row0, column0, column1 } = selection;
  const wide = column1 - column0;
  return within(others, columns, selection).entries.filter(([k, code]) =>
    Array.from({ length: kindOf(code).width }, (_, w) => k + w).every((cell) =>
      selects(selection, row0 + Math.floor(cell / wide), column0 + (cell % wide)),
    ),
  );
}

/**
 * A selection's other stitches changed within its box, such as mirrored: index and code.
 *
 * @param {{grid: Grid, others: Others}} chart
 * @param {Selection} selection
 * @param {"mirrored" | "flipped" | "rotated" | "turnedOver" | "swapped"} how
 * @returns {[number, string][]}
 */
export function changedStitches({ grid, others }, selection, how) {
  const { row0, column0, row1, column1 } = selection;
  const wide = column1 - column0;
  return selected(others, grid, selection).map(([k, code]) => {
    const [row, column] = [Math.floor(k / wide), k % wide];
    const across = how !== "flipped" && how !== "swapped";
    const up = how === "flipped" || how === "rotated";
    const to = [up ? row1 - row0 - 1 - row : row, across ? wide - column - kindOf(code).width : column];
    return [grid.index(row0 + to[0], column0 + to[1]), IMAGES[how](code)];
  });
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
