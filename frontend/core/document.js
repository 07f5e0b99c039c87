/**
 * The chart being designed: stitches and their kinds, outline, regions, linked repeats, own
 * patterns, and the history of changes. All changes go through here; listeners hear which stitches
 * to draw anew, and when a whole step is done.
 *
 * @import {Box} from "./grid.js"
 * @import {Content, PlacementItem, RegionItem, ShelfItem} from "./design.js"
 * @import {Entry, ListPatch, Patch, Snapshot} from "./history.js"
 * @import {RegionLook} from "./regions.js"
 * @import {RepeatLook} from "./repeats.js"
 *
 * @typedef {{box: Box, resized: boolean}} Change `box` holds all stitches whose look may differ
 * @typedef {"stitches" | "outline" | `region:${string}`} Target what a stroke paints
 */

import { boxOfRuns, flip, pack, toRuns, unpack } from "./bits.js";
import { contentOf } from "./design.js";
import { Grid } from "./grid.js";
import { History } from "./history.js";
import { Region } from "./regions.js";
import { Links, Repeat } from "./repeats.js";
import { surroundings, updateSurroundings } from "./segments.js";
import { Brush, Layer } from "./stroke.js";

export class ChartDocument {
  /** 1 where there is a stitch. @type {Uint8Array} */ outline;
  /** Whether any stitch is absent. */
  shaped = false;
  /** @type {readonly Region[]} */ regions = [];
  /** @type {readonly Repeat[]} */ repeats = [];
  /** Patterns of one's own that travel with the design. @type {readonly ShelfItem[]} */ shelf = [];

  /** @type {Set<(change: Change) => void>} */ #changed = new Set();
  /** @type {Set<() => void>} */ #settled = new Set();
  /** @type {Set<(names: string[]) => void>} */ #refused = new Set();
  /** @type {{target: Target, layers: Map<string, Layer>, refused: boolean} | null} */ #stroke = null;
  /** @type {Links | null} */ #links = null;
  /** @type {WeakMap<Region, {edition: number, item: RegionItem}>} */ #items = new WeakMap();
  /** How often each bitmap was changed. @type {WeakMap<Uint8Array, number>} */ #editions = new WeakMap();

  /**
   * @param {Grid} grid
   * @param {History} [history]
   */
  constructor(grid, history = new History()) {
    this.grid = grid;
    this.outline = new Uint8Array(grid.purl.length).fill(1);
    this.codes = surroundings(grid);
    this.history = history;
  }

  /**
   * @param {Content} content
   * @param {History} [history]
   */
  static read(content, history = new History()) {
    const chart = new ChartDocument(new Grid(1, 1), history);
    chart.#become(snapshot(content));
    return chart;
  }

  // --- listening ------------------------------------------------------------------------------

  /**
   * Every visible change, also within a stroke.
   *
   * @param {(change: Change) => void} listener
   */
  onChange(listener) {
    this.#changed.add(listener);
  }

  /**
   * After a whole step: a stroke ended, a region was renamed, an undo, a new chart.
   *
   * @param {() => void} listener
   */
  onSettle(listener) {
    this.#settled.add(listener);
  }

  /**
   * When a step left out stitches of locked regions; hears the regions' names.
   *
   * @param {(names: string[]) => void} listener
   */
  onRefuse(listener) {
    this.#refused.add(listener);
  }

  /** Grows whenever a bitmap (a region's cells, the outline) changes. @param {Uint8Array} bitmap */
  edition(bitmap) {
    return this.#editions.get(bitmap) ?? 0;
  }

  // --- strokes --------------------------------------------------------------------------------

  get painting() {
    return this.#stroke !== null;
  }

  /** @param {Target} [target] */
  begin(target = "stitches") {
    this.cancel();
    this.#stroke = { target, layers: new Map(), refused: false };
  }

  /**
   * Set stitches within the stroke: 1 for purl, 0 for knit; or for being in the outline or region.
   *
   * @param {Brush} brush
   * @param {boolean} fresh whether the stroke is only these (a shape being dragged)
   */
  paint(brush, fresh) {
    const stroke = this.#stroke;
    if (!stroke) return;
    const { target } = stroke;
    if (target === "stitches") {
      this.#lay("stitches", this.#linked(brush), fresh);
      return;
    }
    const { locked } = this.#lock();
    const own = target === "outline" ? null : this.region(target.slice(7));
    const wanted = new Brush(this.grid.purl.length);
    for (const i of brush.touched) {
      if (own ? own.locked : locked[i]) stroke.refused = true;
      else if (!own || this.outline[i]) wanted.set(i, brush.values[i]);
    }
    this.#lay(target, wanted, fresh);
    if (own?.fill) {
      this.#lay("stitches", this.#linked(this.#filling(own, stroke.layers.get(target))), true);
    }
  }

  /**
   * End the stroke and remember it as one step.
   *
   * @param {string} label
   * @returns {boolean} whether anything changed
   */
  commit(label) {
    const stroke = this.#stroke;
    if (!stroke) return false;
    this.#stroke = null;
    /** @type {Patch[]} */
    const patches = [];
    for (const [on, { runs }] of stroke.layers) if (runs.length) patches.push({ on, runs });
    patches.push(...this.#followMotifs());
    this.#tellRefused(stroke.refused);
    return this.#keep(label, patches);
  }

  /** End the stroke and take it back. */
  cancel() {
    const stroke = this.#stroke;
    this.#stroke = null;
    for (const [on, layer] of stroke?.layers ?? []) this.#refresh(on, layer.revert());
  }

  /**
   * Set stitches as one step; linked ones follow, locked ones stay.
   *
   * @param {Iterable<readonly [number, number]>} cells stitch and 1 for purl, 0 for knit
   * @param {string} label
   * @param {Target} [target]
   */
  set(cells, label, target = "stitches") {
    this.begin(target);
    this.paint(Brush.of(this.grid.purl.length, cells), false);
    return this.commit(label);
  }

  // --- whole charts ---------------------------------------------------------------------------

  /**
   * Make the stitches those of another chart, as one step; regions and outline stay if the size
   * does, and copies of repeats that no longer match are unlinked. Does nothing if it is the same.
   *
   * @param {Grid} next
   * @param {string} label
   */
  replace(next, label) {
    this.cancel();
    if (next.equals(this.grid)) return;
    if (next.rows !== this.grid.rows || next.columns !== this.grid.columns) {
      const repeats = this.repeats.map((repeat) => repeat.with({ placements: [] }).written());
      this.load({ ...contentOf(next.text), repeats, shelf: [...this.shelf] }, label);
      return;
    }
    const differs = next.purl.map((p, i) => p ^ this.grid.purl[i]);
    const patches = this.#lists("repeats", this.#matching(this.repeats, next));
    patches.push({ on: "stitches", runs: toRuns(differs) });
    this.#flip("stitches", toRuns(differs));
    this.#keep(label, patches);
  }

  /**
   * Become another document, as one step that can be undone.
   *
   * @param {Content} content
   * @param {string} label
   */
  load(content, label) {
    this.cancel();
    const before = { ...this.#snapshot(), shelf: [...this.shelf] };
    const after = { ...snapshot(content), shelf: content.shelf };
    this.#become(after);
    this.#keep(label, [{ before, after }]);
  }

  /**
   * Become another document with a history of its own.
   *
   * @param {Content} content
   * @param {History} [history]
   */
  open(content, history = new History()) {
    this.cancel();
    this.history = history;
    this.#become(snapshot(content));
    this.#settle();
  }

  /** @returns {Content} */
  get content() {
    const { rows, columns } = this.grid;
    return {
      chart: this.grid.text,
      outline: this.shaped ? outlineText(this.outline, rows, columns) : null,
      regions: this.regions.map((region) => this.#item(region)),
      repeats: this.repeats.map((repeat) => repeat.written()),
      shelf: [...this.shelf],
    };
  }

  /** A region as it is written, found anew only when it has changed. @param {Region} region */
  #item(region) {
    const edition = this.edition(region.cells);
    let known = this.#items.get(region);
    if (known?.edition !== edition) {
      known = { edition, item: region.written(this.grid.columns) };
      this.#items.set(region, known);
    }
    return known.item;
  }

  /**
   * Move the chart's stitches to other places; outline, regions and repeats move with them. A copy
   * of a repeat that is torn is unlinked.
   *
   * @param {string} label
   * @param {import("./reshape.js").Reshape} how
   */
  reshape(label, { rows, columns, source, like = source, motif, grow }) {
    this.cancel();
    const before = this.#snapshot();
    const old = this.grid;
    /** @param {Uint8Array} bitmap @param {Int32Array} from @param {number} other */
    const moved = (bitmap, from, other) => Uint8Array.from(from, (i) => (i < 0 ? other : bitmap[i]));
    const stitches = moved(old.purl, source, 0);
    const grid = new Grid(rows, columns, motif?.swapped ? stitches.map((p) => 1 - p) : stitches);
    const target = new Int32Array(old.purl.length).fill(-1);
    source.forEach((i, k) => {
      if (i >= 0) target[i] = k;
    });
    /** @param {PlacementItem} place @returns {PlacementItem[]} */
    const carried = ({ row, column, rows: high, columns: wide }) => {
      const ends = [
        target[old.index(row, column)],
        target[old.index(row + high - 1, column + wide - 1)],
      ];
      if (Math.min(...ends) < 0) return [];
      const [a, b] = ends.map((k) => [Math.floor(k / columns), k % columns]);
      const size = { rows: Math.abs(a[0] - b[0]) + 1, columns: Math.abs(a[1] - b[1]) + 1 };
      return [{ row: Math.min(a[0], b[0]), column: Math.min(a[1], b[1]), ...size }];
    };
    /** @param {Repeat} repeat @param {PlacementItem} place @returns {PlacementItem[]} */
    const grown = (repeat, place) => {
      const high = place.rows === old.rows ? rows : place.rows;
      const wide = place.columns === old.columns ? columns : place.columns;
      const fits = repeat.snapped(high, wide);
      if (!grow || fits.rows !== high || fits.columns !== wide) return carried(place);
      const [corner] = carried({ ...place, rows: 1, columns: 1 });
      const next = {
        row: high === rows ? 0 : corner?.row,
        column: wide === columns ? 0 : corner?.column,
        rows: high,
        columns: wide,
      };
      if (next.row === undefined || next.column === undefined) return [];
      if (next.row + high > rows || next.column + wide > columns) return [];
      grid.put(repeat.laid(next), next.row, next.column);
      return [next];
    };
    const repeats = this.repeats.map((repeat) => {
      const size = { rows: repeat.motif.rows + repeat.edgeRows, columns: repeat.motif.columns + repeat.edgeColumns };
      const turned = motif ? motif.change(repeat.laid(size)) : repeat.motif;
      return repeat.with({
        motif: turned.resized(repeat.motif.rows, repeat.motif.columns),
        placements: repeat.placements.flatMap((place) => grown(repeat, place)),
      });
    });
    const regions = this.regions.map((region) => region.withCells(moved(region.cells, like, 0)));
    const outline = moved(this.outline, like, 1);
    const after = {
      ...snapshotOf(grid, outline, regions),
      repeats: this.#matching(repeats, grid).map((repeat) => repeat.written()),
    };
    this.#become(after);
    this.#keep(label, [{ before, after }]);
  }

  /** @returns {string | undefined} what was undone */
  undo() {
    this.cancel();
    const step = this.history.undo();
    if (!step) return undefined;
    for (const patch of step.patches.toReversed()) this.#apply(patch, "before");
    this.#settle();
    return step.label;
  }

  /** @returns {string | undefined} what was done again */
  redo() {
    this.cancel();
    const step = this.history.redo();
    if (!step) return undefined;
    for (const patch of step.patches) this.#apply(patch, "after");
    this.#settle();
    return step.label;
  }

  // --- regions --------------------------------------------------------------------------------

  /** @param {string} id */
  region(id) {
    return this.regions.find((region) => region.id === id) ?? null;
  }

  /** The uppermost region that a stitch belongs to. @param {number} i */
  regionAt(i) {
    return this.regions.findLast((region) => region.cells[i]) ?? null;
  }

  /**
   * @param {Partial<RegionLook> & {name: string, colour: string}} look
   * @param {Iterable<number>} [cells]
   * @returns {string} its id
   */
  addRegion(look, cells = []) {
    const id = freeId("region", this.regions);
    const bitmap = new Uint8Array(this.grid.purl.length);
    for (const i of cells) if (this.outline[i]) bitmap[i] = 1;
    const whole = { yarn: null, fill: null, locked: false, hidden: false, ...look };
    const region = new Region(id, whole, bitmap);
    this.#arrange(`New region ${look.name}`, "regions", [...this.regions, region], region);
    return id;
  }

  /**
   * Another name, colour, yarn, lock …; a new fill is laid at once.
   *
   * @param {string} id
   * @param {Partial<RegionLook>} changes
   * @param {string} label
   */
  changeRegion(id, changes, label) {
    const next = this.regions.map((region) => (region.id === id ? region.with(changes) : region));
    this.#arrange(label, "regions", next, changes.fill ? next.find((region) => region.id === id) : null);
  }

  /** Lay a region's fill once more. @param {string} id */
  fillRegion(id) {
    this.#arrange("Fill region", "regions", this.regions, this.region(id));
  }

  /** Its stitches stay. @param {string} id */
  removeRegion(id) {
    this.#arrange("Remove region", "regions", this.regions.filter((region) => region.id !== id));
  }

  /**
   * Put a region higher or lower.
   *
   * @param {string} id
   * @param {number} index 0 is the lowest
   */
  orderRegion(id, index) {
    const region = this.region(id);
    if (!region) return;
    const others = this.regions.filter((other) => other !== region);
    this.#arrange("Reorder regions", "regions", others.toSpliced(index, 0, region));
  }

  // --- repeats --------------------------------------------------------------------------------

  /** @param {string} id */
  repeat(id) {
    return this.repeats.find((repeat) => repeat.id === id) ?? null;
  }

  /**
   * @param {Partial<RepeatLook> & {name: string, motif: Grid}} look its placements are laid at once
   * @returns {string} its id
   */
  addRepeat(look) {
    const id = freeId("repeat", this.repeats);
    const repeat = new Repeat(id, { edgeColumns: 0, edgeRows: 0, placements: [], ...look });
    this.#arrange(`New repeat ${look.name}`, "repeats", [...this.repeats, repeat], repeat);
    return id;
  }

  /**
   * Another name, motif, edge, placements; what its placements now show is laid at once.
   *
   * @param {string} id
   * @param {Partial<RepeatLook>} changes
   * @param {string} label
   */
  changeRepeat(id, changes, label) {
    const next = this.repeats.map((repeat) => (repeat.id === id ? repeat.with(changes) : repeat));
    const lays = "motif" in changes || "placements" in changes;
    this.#arrange(label, "repeats", next, lays ? next.find((repeat) => repeat.id === id) : null);
  }

  /** Its copies stay as they are, linked no more. @param {string} id */
  removeRepeat(id) {
    this.#arrange("Remove repeat", "repeats", this.repeats.filter((repeat) => repeat.id !== id));
  }

  /** @param {readonly ShelfItem[]} shelf @param {string} label */
  changeShelf(shelf, label) {
    this.#arrange(label, "shelf", shelf);
  }

  // --- within ---------------------------------------------------------------------------------

  /**
   * Exchange a list, and lay the stitches that one of its items now stands for: all one step.
   *
   * @template {"regions" | "repeats" | "shelf"} L
   * @param {string} label
   * @param {L} list
   * @param {ChartDocument[L]} next
   * @param {Region | Repeat | null} [laid]
   */
  #arrange(label, list, next, laid = null) {
    this.cancel();
    const patches = this.#lists(list, next);
    if (laid) {
      this.begin();
      if (laid instanceof Repeat) this.#lay("stitches", this.#linked(this.#laying(laid), true), false);
      else if (laid.fill) this.paint(this.#filling(laid), false);
      const stroke = this.#stroke;
      this.#stroke = null;
      const { runs } = stroke?.layers.get("stitches") ?? { runs: [] };
      if (runs.length) patches.push({ on: "stitches", runs });
      patches.push(...this.#followMotifs());
      this.#tellRefused(stroke?.refused ?? false);
    }
    this.#tell({ box: this.grid.box, resized: false });
    this.#keep(label, patches);
  }

  /**
   * Wanted stitches, with all that are linked to them; without those that cannot be painted.
   *
   * @param {Brush} brush
   * @param {boolean} [everywhere] also where there is no stitch
   */
  #linked(brush, everywhere = false) {
    const links = this.#lock();
    const wanted = new Brush(this.grid.purl.length);
    const motifs = new Brush(links.groups);
    for (const i of brush.touched) {
      if (!this.outline[i] && !everywhere) continue;
      const group = links.group[i];
      if (links.locked[i]) {
        if (this.#stroke && brush.values[i] !== this.grid.purl[i]) this.#stroke.refused = true;
      } else if (group) motifs.set(group, brush.values[i]);
      else wanted.set(i, brush.values[i]);
    }
    for (const group of motifs.touched) {
      for (const i of links.members(group)) wanted.set(i, motifs.values[group]);
    }
    return wanted;
  }

  /**
   * The stitches of a region's fill; under a stroke, only where it has added to the region.
   *
   * @param {Region} region
   * @param {Layer} [added]
   */
  #filling(region, added) {
    const { columns } = this.grid;
    const at = this.regions.findIndex(({ id }) => id === region.id);
    const above = this.regions.slice(at + 1).filter(({ fill }) => fill);
    const brush = new Brush(region.cells.length);
    const { row0, row1, column0, column1 } = (added ? added.reach : null) ?? this.grid.box;
    for (let row = row0; row < row1; row++) {
      for (let column = column0; column < column1; column++) {
        const i = row * columns + column;
        if (!region.cells[i] || (added && !added.has(i)) || above.some(({ cells }) => cells[i])) continue;
        brush.set(i, region.filling(row, column));
      }
    }
    return brush;
  }

  /** @param {Repeat} repeat */
  #laying(repeat) {
    const { grid } = this;
    const brush = new Brush(grid.purl.length);
    for (const place of repeat.placements) {
      const part = repeat.laid(place);
      part.purl.forEach((p, k) => {
        const row = place.row + Math.floor(k / part.columns);
        const column = place.column + (k % part.columns);
        if (grid.has(row, column)) brush.set(grid.index(row, column), p);
      });
    }
    return brush;
  }

  /** Motifs become what their copies show. @returns {Patch[]} */
  #followMotifs() {
    const links = this.#lock();
    return this.repeats.flatMap((repeat, at) => {
      const differs = repeat.motif.purl.map((p, cell) => {
        const i = links.example(at, cell);
        return i === undefined ? 0 : p ^ this.grid.purl[i];
      });
      const runs = toRuns(differs);
      flip(repeat.motif.purl, runs);
      return runs.length ? [{ on: `motif:${repeat.id}`, runs }] : [];
    });
  }

  /** Repeats with only those copies that a chart shows. @param {readonly Repeat[]} repeats @param {Grid} grid */
  #matching(repeats, grid) {
    return repeats.map((repeat) => {
      const placements = repeat.placements.filter((place) => {
        const box = { row0: place.row, column0: place.column, row1: place.row + place.rows, column1: place.column + place.columns };
        const inside = box.row1 <= grid.rows && box.column1 <= grid.columns;
        return inside && grid.region(box).equals(repeat.laid(place));
      });
      return placements.length === repeat.placements.length ? repeat : repeat.with({ placements });
    });
  }

  #lock() {
    this.#links ??= new Links(this.grid, this.repeats, this.regions);
    return this.#links;
  }

  /**
   * @param {string} on
   * @param {Brush} wanted
   * @param {boolean} fresh
   */
  #lay(on, wanted, fresh) {
    const stroke = this.#stroke;
    const bitmap = this.#bitmap(on);
    if (!stroke || !bitmap) return;
    let layer = stroke.layers.get(on);
    if (!layer) stroke.layers.set(on, (layer = new Layer(bitmap, this.grid.columns)));
    this.#refresh(on, layer.apply(wanted, fresh));
  }

  /** @param {string} on @returns {Uint8Array | undefined} */
  #bitmap(on) {
    if (on === "stitches") return this.grid.purl;
    if (on === "outline") return this.outline;
    const id = on.slice(on.indexOf(":") + 1);
    return on.startsWith("region:") ? this.region(id)?.cells : this.repeat(id)?.motif.purl;
  }

  /** @param {string} on @param {number[]} runs */
  #flip(on, runs) {
    const bitmap = this.#bitmap(on);
    if (!bitmap || !runs.length) return;
    flip(bitmap, runs);
    if (!on.startsWith("motif:")) this.#refresh(on, boxOfRuns(runs, this.grid.columns));
  }

  /**
   * Bitmaps changed in a box: bring what is derived from them up to date, and tell.
   *
   * @param {string} on
   * @param {Box | null} box
   */
  #refresh(on, box) {
    if (!box) return;
    const { rows, columns } = this.grid;
    const bitmap = this.#bitmap(on);
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
    this.#tell({ box: wider, resized: false });
  }

  /**
   * Exchange a list.
   *
   * @template {"regions" | "repeats" | "shelf"} L
   * @param {L} list
   * @param {ChartDocument[L]} next
   * @returns {Patch[]}
   */
  #lists(list, next) {
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

  /**
   * @param {Patch} patch
   * @param {"before" | "after"} side
   */
  #apply(patch, side) {
    if ("on" in patch) this.#flip(patch.on, patch.runs);
    else if (!("list" in patch)) this.#become(patch[side]);
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
      this.#tell({ box: this.grid.box, resized: false });
    }
  }

  /** @returns {Snapshot} */
  #snapshot() {
    return {
      ...snapshotOf(this.grid, this.outline, this.regions),
      repeats: this.repeats.map((repeat) => repeat.written()),
    };
  }

  /** @param {Snapshot} state */
  #become({ rows, columns, stitches, outline, regions, repeats, shelf }) {
    this.grid = new Grid(rows, columns, unpack(stitches, rows * columns));
    this.outline = outline ? unpack(outline, rows * columns) : new Uint8Array(rows * columns).fill(1);
    this.shaped = outline !== null;
    this.regions = regions.map((item) => Region.read(item, rows, columns));
    this.repeats = repeats.map(Repeat.read);
    if (shelf) this.shelf = shelf;
    this.#links = null;
    this.codes = surroundings(this.grid, this.shaped ? this.outline : null);
    this.#tell({ box: this.grid.box, resized: true });
  }

  /** @param {boolean} refused */
  #tellRefused(refused) {
    if (!refused) return;
    const names = this.regions.filter(({ locked }) => locked).map(({ name }) => name);
    for (const listener of this.#refused) listener(names);
  }

  /**
   * @param {string} label
   * @param {Patch[]} patches
   */
  #keep(label, patches) {
    if (!patches.length) return false;
    this.history.push({ label, patches });
    this.#settle();
    return true;
  }

  /** @param {Change} change */
  #tell(change) {
    for (const listener of this.#changed) listener(change);
  }

  #settle() {
    for (const listener of this.#settled) listener();
  }
}

/**
 * @param {Grid} grid
 * @param {Uint8Array} outline
 * @param {readonly Region[]} regions
 */
function snapshotOf({ rows, columns, purl }, outline, regions) {
  return {
    rows,
    columns,
    stitches: pack(purl),
    outline: outline.includes(0) ? pack(outline) : null,
    regions: regions.map((region) => region.written(columns)),
  };
}

/** @param {Content} content @returns {Snapshot} */
function snapshot({ chart, outline, regions, repeats, shelf }) {
  const grid = Grid.fromText(chart);
  const marks = outline?.split("\n").toReversed().join("");
  const cells = marks && Uint8Array.from(marks, (mark) => (mark === "x" ? 1 : 0));
  return { ...snapshotOf(grid, cells || grid.purl.map(() => 1), []), regions, repeats, shelf };
}

/**
 * @param {Uint8Array} outline
 * @param {number} rows
 * @param {number} columns
 */
function outlineText(outline, rows, columns) {
  const lines = [];
  for (let row = rows - 1; row >= 0; row--) {
    lines.push(Array.from(outline.subarray(row * columns, (row + 1) * columns), (s) => (s ? "x" : ".")).join(""));
  }
  return lines.join("\n");
}

/**
 * @param {string} prefix
 * @param {readonly {id: string}[]} items
 */
function freeId(prefix, items) {
  let number = items.length + 1;
  while (items.some(({ id }) => id === `${prefix}-${number}`)) number++;
  return `${prefix}-${number}`;
}
