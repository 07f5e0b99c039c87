/**
 * Undo and redo as deltas. Bitmaps (stitches, outline, a region's cells, a motif) are flipped, and
 * flipping again takes it back; lists are exchanged, naming by id what stayed; only a change of size
 * keeps both charts. Of stitches that are neither knit nor purl, it has the code before and after.
 *
 * @import {OtherChange} from "./others.js"
 * @import {RegionItem, RepeatItem, ShelfItem} from "./design.js"
 * @import {Snapshot} from "./snapshot.js"
 *
 * @typedef {{on: string, runs: number[]}} FlipPatch on "stitches", "outline", "region:ID", "motif:ID";
 *   [start, length, start, length, …]
 * @typedef {RegionItem | RepeatItem | ShelfItem | string} Entry a string is the id of what stays
 * @typedef {{list: "regions" | "repeats" | "shelf", before: Entry[], after: Entry[]}} ListPatch
 * @typedef {{before: Snapshot, after: Snapshot}} WholePatch
 * @typedef {{others: OtherChange[]}} OthersPatch
 * @typedef {FlipPatch | ListPatch | WholePatch | OthersPatch} Patch
 * @typedef {{label: string, patches: Patch[]}} Step
 */

import { pack } from "../grid/bits.js";
import { Grid } from "../grid/grid.js";

/** Steps beyond this number are forgotten. */
const MAX_STEPS = 500;

export class History {
  /** @param {Step[]} [done] @param {Step[]} [undone] */
  constructor(done = [], undone = []) {
    this.done = done;
    this.undone = undone;
  }

  /** @param {Step} step */
  push(step) {
    this.done.push(step);
    if (this.done.length > MAX_STEPS) this.done.shift();
    this.undone.length = 0;
  }

  undo() {
    const step = this.done.pop();
    if (step) this.undone.push(step);
    return step;
  }

  redo() {
    const step = this.undone.pop();
    if (step) this.done.push(step);
    return step;
  }

  /** As JSON of at most `limit` characters: the oldest steps are left out. @param {number} limit */
  serialised(limit) {
    const done = [...this.done];
    const undone = [...this.undone];
    let json = JSON.stringify({ done, undone });
    while (json.length > limit && (done.length || undone.length)) {
      if (done.length) done.splice(0, Math.ceil(done.length / 2));
      else undone.splice(0, Math.ceil(undone.length / 2));
      json = JSON.stringify({ done, undone });
    }
    return json;
  }

  /** @param {string | null} json */
  static parse(json) {
    try {
      const { done, undone } = JSON.parse(json ?? "");
      return new History(done.map(migrated), undone.map(migrated));
    } catch {
      return new History(); // nothing stored, or damaged: the chart itself is stored elsewhere
    }
  }
}

/**
 * A step as it is written now; earlier pages kept only flips of stitches and whole charts.
 *
 * @param {Step | {label: string, runs: number[]} | {label: string, before: string, after: string}} step
 * @returns {Step}
 */
function migrated(step) {
  if ("patches" in step) return step;
  const { label } = step;
  if ("runs" in step) return { label, patches: [{ on: "stitches", runs: step.runs }] };
  return { label, patches: [{ before: bare(step.before), after: bare(step.after) }] };
}

/** @param {string} chart @returns {Snapshot} */
function bare(chart) {
  const { rows, columns, purl } = Grid.fromText(chart);
  return { rows, columns, stitches: pack(purl), outline: null, regions: [], repeats: [] };
}
