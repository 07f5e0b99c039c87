/**
 * The chart being designed: its grid, the kinds of its stitches, and the history of changes. All
 * changes go through here, and listeners hear which stitches to draw anew.
 *
 * @import {Box} from "./grid.js"
 * @typedef {{box: Box, resized: boolean}} Change `box` holds all stitches whose look may differ
 */

import { Grid } from "./grid.js";
import { History, fromRuns, toRuns } from "./history.js";
import { surroundings, updateSurroundings } from "./segments.js";

export class ChartDocument {
  /** @type {Set<(change: Change) => void>} */ #changed = new Set();
  /** @type {Set<() => void>} */ #settled = new Set();
  /** Stitches flipped by the stroke under way. @type {Set<number> | null} */ #stroke = null;

  /**
   * @param {Grid} grid
   * @param {History} [history]
   */
  constructor(grid, history = new History()) {
    this.grid = grid;
    this.codes = surroundings(grid);
    this.history = history;
  }

  /**
   * Every visible change, also within a stroke.
   *
   * @param {(change: Change) => void} listener
   */
  onChange(listener) {
    this.#changed.add(listener);
  }

  /**
   * After a whole step: a stroke ended, an undo, a new chart.
   *
   * @param {() => void} listener
   */
  onSettle(listener) {
    this.#settled.add(listener);
  }

  get painting() {
    return this.#stroke !== null;
  }

  begin() {
    this.#stroke = new Set();
  }

  /**
   * Set stitches within the stroke.
   *
   * @param {Map<number, number>} cells stitch -> 1 for purl, 0 for knit
   * @param {boolean} fresh whether the stroke is only these (a shape being dragged)
   */
  paint(cells, fresh) {
    const stroke = this.#stroke;
    if (!stroke) return;
    const { purl } = this.grid;
    /** @type {number[]} */
    const flips = [];
    if (fresh) {
      for (const i of stroke) {
        if (cells.get(i) !== purl[i]) flips.push(i);
      }
    }
    for (const [i, value] of cells) {
      if (purl[i] !== value) flips.push(i);
    }
    const once = fresh ? new Set(flips) : flips;
    for (const i of once) {
      if (!stroke.delete(i)) stroke.add(i);
    }
    this.#flip(once);
  }

  /**
   * End the stroke and remember it as one step.
   *
   * @param {string} label
   */
  commit(label) {
    const stroke = this.#stroke;
    this.#stroke = null;
    if (!stroke?.size) return;
    this.history.push({ label, runs: toRuns(stroke) });
    this.#settle();
  }

  /** End the stroke and take it back. */
  cancel() {
    const stroke = this.#stroke;
    this.#stroke = null;
    if (stroke?.size) this.#flip(stroke);
  }

  /**
   * Make the chart another one, as one step. Does nothing if it is the same.
   *
   * @param {Grid} next
   * @param {string} label
   */
  replace(next, label) {
    this.cancel();
    if (next.equals(this.grid)) return;
    if (next.rows === this.grid.rows && next.columns === this.grid.columns) {
      const flips = [];
      for (let i = 0; i < next.purl.length; i++) if (next.purl[i] !== this.grid.purl[i]) flips.push(i);
      this.history.push({ label, runs: toRuns(flips) });
      this.#flip(flips);
    } else {
      this.history.push({ label, before: this.grid.text, after: next.text });
      this.#load(next);
    }
    this.#settle();
  }

  /**
   * Show the chart of another design, with its own history.
   *
   * @param {Grid} grid
   * @param {History} [history]
   */
  open(grid, history = new History()) {
    this.cancel();
    this.history = history;
    this.#load(grid);
    this.#settle();
  }

  /** @returns {string | undefined} what was undone */
  undo() {
    this.cancel();
    const step = this.history.undo();
    if (!step) return undefined;
    if ("runs" in step) this.#flip([...fromRuns(step.runs)]);
    else this.#load(Grid.fromText(step.before));
    this.#settle();
    return step.label;
  }

  /** @returns {string | undefined} what was done again */
  redo() {
    this.cancel();
    const step = this.history.redo();
    if (!step) return undefined;
    if ("runs" in step) this.#flip([...fromRuns(step.runs)]);
    else this.#load(Grid.fromText(step.after));
    this.#settle();
    return step.label;
  }

  /** @param {Grid} grid */
  #load(grid) {
    this.grid = grid;
    this.codes = surroundings(grid);
    this.#tell({ box: grid.box, resized: true });
  }

  /** @param {Iterable<number>} indices */
  #flip(indices) {
    const { purl, rows, columns } = this.grid;
    const box = { row0: rows, column0: columns, row1: 0, column1: 0 };
    for (const i of indices) {
      purl[i] ^= 1;
      const row = Math.floor(i / columns);
      const column = i - row * columns;
      box.row0 = Math.min(box.row0, row);
      box.row1 = Math.max(box.row1, row + 1);
      box.column0 = Math.min(box.column0, column);
      box.column1 = Math.max(box.column1, column + 1);
    }
    if (box.row1 === 0) return;
    // A flip changes its own segments and so the kinds of its four neighbours.
    const wider = {
      row0: Math.max(0, box.row0 - 1),
      column0: Math.max(0, box.column0 - 1),
      row1: Math.min(rows, box.row1 + 1),
      column1: Math.min(columns, box.column1 + 1),
    };
    updateSurroundings(this.grid, this.codes, wider);
    this.#tell({ box: wider, resized: false });
  }

  /** @param {Change} change */
  #tell(change) {
    for (const listener of this.#changed) listener(change);
  }

  #settle() {
    for (const listener of this.#settled) listener();
  }
}
