/**
 * Where the stitches of a changed chart come from, and what its parts become.
 *
 * @import {PlacementItem} from "./design.js"
 * @import {Repeat} from "./repeats.js"
 * @import {Snapshot, State} from "./snapshot.js"
 *
 * @typedef {object} Reshape
 * @property {number} rows
 * @property {number} columns
 * @property {Int32Array} source for each new stitch the old one; -1 is a new knit
 * @property {Int32Array} [like] for each new stitch the old one whose regions and outline it takes
 * @property {boolean} [grow] whether repeats that spanned the chart span the new one, if they fit
 * @property {{change: (motif: Grid) => Grid, swapped: boolean}} [motif] what happens to motifs
 * @property {(code: string) => string} [image] what other stitches than knits and purls become
 */

import { Grid } from "../grid/grid.js";
import { IMAGES, kindOf } from "../grid/kinds.js";
import { Others, settleUnder } from "./others.js";
import { matching } from "./repeats.js";
import { snapshotOf } from "./snapshot.js";
import { Brush } from "../grid/stroke.js";

/**
 * @param {Grid} grid
 * @param {number} rows
 * @param {number} columns
 * @param {(row: number, column: number) => [row: number, column: number]} from may lie outside
 */
function sources(grid, rows, columns, from) {
  const source = new Int32Array(rows * columns);
  for (let row = 0, k = 0; row < rows; row++) {
    for (let column = 0; column < columns; column++, k++) {
      const [r, c] = from(row, column);
      source[k] = grid.has(r, c) ? grid.index(r, c) : -1;
    }
  }
  return source;
}

/**
 * The whole chart mirrored, turned in its plane, or seen from the back.
 *
 * @param {Grid} grid
 * @param {"mirrored" | "flipped" | "rotated" | "turnedOver" | "swapped"} how
 * @returns {Reshape}
 */
export function turned(grid, how) {
  const { rows, columns } = grid;
  const across = how === "mirrored" || how === "rotated" || how === "turnedOver";
  const up = how === "flipped" || how === "rotated";
  return {
    rows,
    columns,
    source: sources(grid, rows, columns, (row, column) => [
      up ? rows - 1 - row : row,
      across ? columns - 1 - column : column,
    ]),
    motif: { change: (motif) => motif[how](), swapped: how === "turnedOver" || how === "swapped" },
    image: IMAGES[how],
  };
}

/**
 * Cut, or filled up with knits.
 *
 * @param {Grid} grid
 * @param {number} rows
 * @param {number} columns
 * @param {readonly [up: number, across: number]} anchor where the old chart stays: 0 bottom or left,
 *   0.5 in the middle, 1 top or right
 * @returns {Reshape}
 */
export function resized(grid, rows, columns, [up, across] = [0, 0]) {
  const row0 = Math.floor((grid.rows - rows) * up);
  const column0 = Math.floor((grid.columns - columns) * across);
  const source = sources(grid, rows, columns, (row, column) => [row + row0, column + column0]);
  return { rows, columns, source, grow: true };
}

/**
 * New rows or columns; they belong to the regions of what they are put beside.
 *
 * @param {Grid} grid
 * @param {"rows" | "columns"} axis
 * @param {number} at put before this one (below, or at the left of it)
 * @param {number} count
 * @param {"before" | "after"} beside the neighbour whose regions continue
 * @returns {Reshape}
 */
export function inserted(grid, axis, at, count, beside) {
  const size = { rows: grid.rows, columns: grid.columns };
  size[axis] += count;
  const neighbour = Math.min(grid[axis] - 1, Math.max(0, beside === "before" ? at - 1 : at));
  /** @param {number} k @param {number} fresh */
  const from = (k, fresh) => (k < at ? k : k < at + count ? fresh : k - count);
  /** @param {number} fresh */
  const map = (fresh) =>
    sources(grid, size.rows, size.columns, (row, column) =>
      axis === "rows" ? [from(row, fresh), column] : [row, from(column, fresh)],
    );
  return { ...size, source: map(-1), like: map(neighbour) };
}

/**
 * Without some rows or columns.
 *
 * @param {Grid} grid
 * @param {"rows" | "columns"} axis
 * @param {number} from
 * @param {number} to the first that stays again
 * @returns {Reshape}
 */
export function deleted(grid, axis, from, to) {
  const size = { rows: grid.rows, columns: grid.columns };
  size[axis] -= to - from;
  /** @param {number} k */
  const old = (k) => (k < from ? k : k + to - from);
  const source = sources(grid, size.rows, size.columns, (row, column) =>
    axis === "rows" ? [old(row), column] : [row, old(column)],
  );
  return { ...size, source };
}

/**
 * A chart with its stitches at other places: outline, regions and repeats move with them; copies of
 * repeats that are torn are unlinked.
 *
 * @param {State} chart
 * @param {Reshape} how
 * @returns {{after: Snapshot, cut: number}} and how many cables are cut, which become knits and purls
 */
export function reshaped({ grid: old, outline, regions, repeats, others: oldOthers }, how) {
  const { rows, columns, source, like = source, motif } = how;
  /** @param {Uint8Array} bitmap @param {Int32Array} from @param {number} other */
  const moved = (bitmap, from, other) => Uint8Array.from(from, (i) => (i < 0 ? other : bitmap[i]));
  const stitches = moved(old.purl, source, 0);
  const grid = new Grid(rows, columns, motif?.swapped ? stitches.map((p) => 1 - p) : stitches);
  const { others, cut } = movedStitches(oldOthers, old, how);
  if (others.size) {
    const under = new Brush(grid.purl.length);
    settleUnder(under, grid.purl, columns, others, others.entries);
    for (const i of under.touched) grid.purl[i] = under.values[i];
  }
  const carried = carrier(old, how);
  const turned = repeats.map((repeat) => {
    const size = { rows: repeat.motif.rows + repeat.edgeRows, columns: repeat.motif.columns + repeat.edgeColumns };
    const next = motif ? motif.change(repeat.laid(size)) : repeat.motif;
    return repeat.with({
      motif: next.resized(repeat.motif.rows, repeat.motif.columns),
      placements: repeat.placements.flatMap((place) => {
        const whole = how.grow ? grown(repeat, place, old, grid, carried) : null;
        if (whole) grid.put(repeat.laid(whole), whole.row, whole.column);
        return whole ?? carried(place) ?? [];
      }),
    });
  });
  const after = snapshotOf({
    grid,
    others,
    outline: moved(outline, like, 1),
    regions: regions.map((region) => region.withCells(moved(region.cells, like, 0))),
    repeats: matching(turned, grid),
  });
  return { after, cut };
}

/** For each old stitch its new place; -1 is none. @param {Grid} old @param {Reshape} how */
function targets(old, { source }) {
  const target = new Int32Array(old.purl.length).fill(-1);
  source.forEach((i, k) => {
    if (i >= 0) target[i] = k;
  });
  return target;
}

/**
 * Stitches that are neither knit nor purl, at their new places.
 *
 * @param {Others} old
 * @param {Grid} grid
 * @param {Reshape} how
 */
function movedStitches(old, grid, how) {
  const others = new Others();
  let cut = 0;
  if (!old.size) return { others, cut };
  const target = targets(grid, how);
  for (const [i, code] of old.entries) {
    const { width } = kindOf(code);
    const places = Array.from({ length: width }, (_, k) => target[i + k]);
    const [first, last] = [Math.min(...places), Math.max(...places)];
    const there = places.filter((place) => place >= 0).length;
    if (there === width && last - first === width - 1) others.put(first, how.image?.(code) ?? code);
    else if (there) cut++;
  }
  return { others, cut };
}

/**
 * Where placements are afterwards; null if one of their corners is gone.
 *
 * @param {Grid} old
 * @param {Reshape} how
 * @returns {(place: PlacementItem) => PlacementItem | null}
 */
function carrier(old, how) {
  const target = targets(old, how);
  const { columns } = how;
  return ({ row, column, rows: high, columns: wide }) => {
    const ends = [target[old.index(row, column)], target[old.index(row + high - 1, column + wide - 1)]];
    if (Math.min(...ends) < 0) return null;
    const [a, b] = ends.map((k) => [Math.floor(k / columns), k % columns]);
    return {
      row: Math.min(a[0], b[0]),
      column: Math.min(a[1], b[1]),
      rows: Math.abs(a[0] - b[0]) + 1,
      columns: Math.abs(a[1] - b[1]) + 1,
    };
  };
}

/**
 * A placement that spanned the old chart, spanning the new one if that holds whole motifs.
 *
 * @param {Repeat} repeat
 * @param {PlacementItem} place
 * @param {Grid} old
 * @param {Grid} grid
 * @param {(place: PlacementItem) => PlacementItem | null} carried
 * @returns {PlacementItem | null}
 */
function grown(repeat, place, old, grid, carried) {
  const wide = place.columns === old.columns;
  const high = place.rows === old.rows;
  const corner = carried({ ...place, rows: 1, columns: 1 });
  const row = high ? 0 : corner?.row;
  const column = wide ? 0 : corner?.column;
  if (row === undefined || column === undefined || (!wide && !high)) return null;
  const rows = high ? grid.rows : place.rows;
  const columns = wide ? grid.columns : place.columns;
  const fits = repeat.snapped(rows, columns);
  const inside = row + rows <= grid.rows && column + columns <= grid.columns;
  return inside && fits.rows === rows && fits.columns === columns ? { row, column, rows, columns } : null;
}
