/**
 * What the chart shows: its stitches and their kinds, outline, regions, linked repeats and own
 * patterns; and how patches change it. The document built on it adds strokes, steps and history.
 *
 * @import {Box} from "../grid/grid.js"
 * @import {Content, RegionItem, ShelfItem} from "./design.js"
 * @import {Entry, ListPatch, Patch} from "./history.js"
 * @import {Snapshot} from "./snapshot.js"
 *
 * @typedef {{box: Box, resized: boolean}} Change `box` holds all stitches whose look may differ
 */

import { boxOfRuns, flip, unpack } from "../grid/bits.js";
import { Grid } from "../grid/grid.js";
import { Others, codesText, written } from "./others.js";
import { Region } from "./regions.js";
import { Links, Repeat } from "./repeats.js";
import { surroundings, updateSurroundings } from "../grid/segments.js";
import { outlineText } from "./snapshot.js";

export class ChartState {
  /** 1 where there is a stitch. @type {Uint8Array} */ outline;
  /** Stitches that are neither knit nor purl. */
  others = new Others();
  /** Whether any stitch is absent. */
  shaped = false;
  /** @type {readonly Region[]} */ regions = [];
  /** @type {readonly Repeat[]} */ repeats = [];
  /** Patterns of one's own that travel with the design. @type {readonly ShelfItem[]} */ shelf = [];

  /** @type {Set<(change: Change) => void>} */ #changed = new Set();
  /** @type {Links | null} */ #links = null;
  /** @type {WeakMap<Region, {edition: number, item: RegionItem}>} */ #items = new WeakMap();
  /** How often each bitmap was changed. @type {WeakMap<Uint8Array, number>} */ #editions = new WeakMap();

  /** @param {Grid} grid */
  constructor(grid) {
    this.grid = grid;
    this.outline = new Uint8Array(grid.purl.length).fill(1);
    /** Kind of each stitch, see segments.js. */
    this.codes = surroundings(grid);
  }

  /** Every visible change, also within a stroke. @param {(change: Change) => void} listener */
  onChange(listener) {
    this.#changed.add(listener);
  }

  /** @param {string} id */
  region(id) {
    return this.regions.find((region) => region.id === id) ?? null;
  }

  /** The uppermost region that a stitch belongs to. @param {number} i */
  regionAt(i) {
    return this.regions.findLast((region) => region.cells[i]) ?? null;
  }

  /** @param {string} id */
  repeat(id) {
    return this.repeats.find((repeat) => repeat.id === id) ?? null;
  }

  /** Lines of x and ., the top row first; null if every stitch is there. */
  get outlineText() {
    return this.shaped ? outlineText(this.outline, this.grid.columns) : null;
  }

  /** Its stitches in lines: K and P, or codes where there are others; the top row first. */
  get text() {
    return this.others.size ? codesText(this.grid, this.others) : this.grid.text;
  }

  /** @returns {Content} */
  get content() {
    return {
      chart: this.grid.text,
      other_stitches: written(this.others, this.grid.columns),
      outline: this.outlineText,
      regions: this.regions.map((region) => this.#item(region)),
      repeats: this.repeats.map((repeat) => repeat.written()),
      shelf: [...this.shelf],
    };
  }

  /** A region as it is written; computed again only when it has changed. @param {Region} region */
  #item(region) {
    const edition = this.edition(region.cells);
    let known = this.#items.get(region);
    if (known?.edition !== edition) {
      known = { edition, item: region.written(this.grid.columns) };
      this.#items.set(region, known);
    }
    return known.item;
  }

  /** Grows whenever a bitmap (a region's cells, the outline) changes. @param {Uint8Array} bitmap */
  edition(bitmap) {
    return this.#editions.get(bitmap) ?? 0;
  }

  /** Which stitches are linked, and which are locked. */
  get links() {
    this.#links ??= new Links(this.grid, this.repeats, this.regions);
    return this.#links;
  }

  /** @param {string} on @returns {Uint8Array | undefined} */
  bitmap(on) {
    if (on === "stitches") return this.grid.purl;
    if (on === "outline") return this.outline;
    const id = on.slice(on.indexOf(":") + 1);
    return on.startsWith("region:") ? this.region(id)?.cells : this.repeat(id)?.motif.purl;
  }

  /** @param {string} on @param {number[]} runs */
  flipRuns(on, runs) {
    const bitmap = this.bitmap(on);
    if (!bitmap || !runs.length) return;
    flip(bitmap, runs);
    if (!on.startsWith("motif:")) this.refresh(on, boxOfRuns(runs, this.grid.columns));
  }

  /**
   * Bitmaps changed in a box: bring what is derived from them up to date, and tell.
   *
   * @param {string} on
   * @param {Box | null} box
   */
  refresh(on, box) {
    if (!box) return;
    const { rows, columns } = this.grid;
    const bitmap = this.bitmap(on);
    if (bitmap) this.#editions.set(bitmap, this.edition(bitmap) + 1);
    if (on === "outline") this.shaped = this.outline.includes(0);
    // A flip changes its own segments and so the kinds of its four neighbours.
    const wider = {
      row0: Math.max(0, box.row0 - 1),
      column0: Math.max(0, box.column0 - 1),
      row1: Math.min(rows, box.row1 + 1),
      column1: Math.min(columns, box.column1 + 1),
    };
    if (!on.startsWith("region:")) {
      updateSurroundings(this.grid, this.codes, wider, this.shaped ? this.outline : null);
    }
    this.tell({ box: wider, resized: false });
  }

  /**
   * Exchange a list.
   *
   * @template {"regions" | "repeats" | "shelf"} L
   * @param {L} list
   * @param {ChartState[L]} next
   * @returns {Patch[]}
   */
  exchange(list, next) {
    const old = this[list];
    if (next === old || (next.length === old.length && next.every((item, k) => item === old[k]))) return [];
    const { columns } = this.grid;
    /** @param {Region | Repeat | ShelfItem} item @param {readonly unknown[]} others @returns {Entry} */
    const entry = (item, others) => {
      if (!("id" in item)) return item;
      if (others.includes(item)) return item.id;
      return item instanceof Region ? item.written(columns) : item.written();
    };
    /** @type {ListPatch} */
    const patch = {
      list,
      before: old.map((item) => entry(item, next)),
      after: next.map((item) => entry(item, old)),
    };
    Object.assign(this, { [list]: next });
    this.#links = null;
    return [patch];
  }

  /** @param {Patch} patch @param {"before" | "after"} side */
  apply(patch, side) {
    if ("on" in patch) this.flipRuns(patch.on, patch.runs);
    else if ("others" in patch) {
      for (const [i] of patch.others) this.others.put(i, null);
      for (const [i, before, after] of patch.others) this.others.put(i, side === "before" ? before : after);
      this.tellOthers(patch.others.map(([i]) => i));
    } else if (!("list" in patch)) this.become(patch[side]);
    else {
      const { rows, columns } = this.grid;
      const entries = /** @type {any[]} */ (patch[side]);
      /** @type {(items: readonly any[], read: (item: any) => any) => any[]} */
      const listed = (items, read) =>
        entries.map((entry) => (typeof entry === "string" ? items.find(({ id }) => id === entry) : read(entry)));
      if (patch.list === "regions") {
        this.regions = listed(this.regions, (item) => Region.read(item, rows, columns));
      } else if (patch.list === "repeats") this.repeats = listed(this.repeats, Repeat.read);
      else this.shelf = entries;
      this.#links = null;
      this.tell({ box: this.grid.box, resized: false });
    }
  }

  /** @param {Snapshot} state */
  become({ rows, columns, stitches, outline, regions, repeats, shelf, others }) {
    this.grid = new Grid(rows, columns, unpack(stitches, rows * columns));
    this.outline = outline ? unpack(outline, rows * columns) : new Uint8Array(rows * columns).fill(1);
    this.others = Others.of(others ?? []);
    this.shaped = outline !== null;
    this.regions = regions.map((item) => Region.read(item, rows, columns));
    this.repeats = repeats.map(Repeat.read);
    if (shelf) this.shelf = shelf;
    this.#links = null;
    this.codes = surroundings(this.grid, this.shaped ? this.outline : null);
    this.tell({ box: this.grid.box, resized: true });
  }

  /** Other stitches at some left columns changed. @param {readonly number[]} starts */
  tellOthers(starts) {
    if (!starts.length) return;
    const { columns, box } = this.grid;
    const rows = starts.map((i) => Math.floor(i / columns));
    const row0 = rows.reduce((least, row) => Math.min(least, row));
    this.tell({ box: { ...box, row0, row1: 1 + rows.reduce((most, row) => Math.max(most, row)) }, resized: false });
  }

  /** @param {Change} change */
  tell(change) {
    for (const listener of this.#changed) listener(change);
  }
}
