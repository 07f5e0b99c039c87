/**
 * All that a chart shows at one moment, as the history keeps it: bitmaps packed, lists as a design
 * document has them.
 *
 * @import {Content, RegionItem, RepeatItem, ShelfItem} from "./design.js"
 * @import {Others} from "./others.js"
 * @import {Region} from "./regions.js"
 * @import {Repeat} from "./repeats.js"
 *
 * @typedef {{rows: number, columns: number, stitches: string, outline: string | null,
 *   regions: RegionItem[], repeats: RepeatItem[], shelf?: ShelfItem[], others?: [number, string][]}} Snapshot
 *   `others` are places and codes of stitches that are neither knit nor purl, if there are any
 * @typedef {{grid: Grid, outline: Uint8Array, regions: readonly Region[], repeats: readonly Repeat[],
 *   others: Others}} State
 */

import { pack } from "../grid/bits.js";
import { Grid } from "../grid/grid.js";
import { entriesOf } from "./others.js";

/** @param {State} state @returns {Snapshot} */
export function snapshotOf({ grid: { rows, columns, purl }, outline, regions, repeats, others }) {
  return {
    ...(others.size && { others: others.entries }),
    rows,
    columns,
    stitches: pack(purl),
    outline: outline.includes(0) ? pack(outline) : null,
    regions: regions.map((region) => region.written(columns)),
    repeats: repeats.map((repeat) => repeat.written()),
  };
}

/** @param {Content} content @returns {Snapshot} */
export function snapshotFrom({ chart, other_stitches: runs = [], outline, regions, repeats, shelf }) {
  const { rows, columns, purl } = Grid.fromText(chart);
  const marks = outline?.split("\n").toReversed().join("");
  return {
    ...(runs.length && { others: entriesOf(runs, columns) }),
    rows,
    columns,
    stitches: pack(purl),
    outline: marks?.includes(".") ? pack(Uint8Array.from(marks, (mark) => (mark === "x" ? 1 : 0))) : null,
    regions,
    repeats,
    shelf,
  };
}

/** Lines of x and dots, top row first. @param {Uint8Array} outline @param {number} columns */
export function outlineText(outline, columns) {
  const lines = [];
  for (let i = outline.length - columns; i >= 0; i -= columns) {
    lines.push(Array.from(outline.subarray(i, i + columns), (stitch) => (stitch ? "x" : ".")).join(""));
  }
  return lines.join("\n");
}
