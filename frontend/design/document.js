/**
 * The chart being designed: stitches and their kinds, outline, regions, linked repeats, own
 * patterns, and the history of changes. All changes go through here; listeners hear which stitches
 * to draw anew, and when a whole step is done.
 *
 * @import {Content, ShelfItem} from "./design.js"
 * @import {Patch} from "./history.js"
 * @import {OtherChange} from "./others.js"
 * @import {RegionLook} from "./regions.js"
 * @import {RepeatLook} from "./repeats.js"
 *
 * @typedef {"stitches" | "outline" | `region:${string}`} Target what a stroke paints
 * @typedef {readonly (readonly [place: number, code: string])[]} Put stitches that are neither knit nor purl, by
 *   the places of their left columns
 */

import { flip, toRuns } from "../grid/bits.js";
import { contentOf } from "./design.js";
import { Grid } from "../grid/grid.js";
import { kindOf } from "../grid/kinds.js";
import { History } from "./history.js";
import { Others, settleUnder, within, written } from "./others.js";
import { Region, filling, uncovered } from "./regions.js";
import { Repeat, laying, matching } from "./repeats.js";
import { reshaped } from "./reshape.js";
import { snapshotFrom, snapshotOf } from "./snapshot.js";
import { ChartState } from "./state.js";
import { Brush, Layer } from "../grid/stroke.js";

export class ChartDocument extends ChartState {
  /** @type {Set<() => void>} */ #settled = new Set();
  /** @type {Set<(names: string[]) => void>} */ #refused = new Set();
  /** @type {Set<(names: string[]) => void>} */ #torn = new Set();
  /** @type {Set<(cut: number) => void>} */ #cut = new Set();
  /** `others` has the codes before the stroke where it changed them. @type {{target: Target, layers: Map<string, Layer>, others: Map<number, string | null>, refused: number} | null} */
  #stroke = null;

  /** @param {Grid} grid @param {History} [history] */
  constructor(grid, history = new History()) {
    super(grid);
    this.history = history;
  }

  /** @param {Content} content @param {History} [history] */
  static read(content, history = new History()) {
    const chart = new ChartDocument(new Grid(1, 1), history);
    chart.become(snapshotFrom(content));
    return chart;
  }

  // --- listening ------------------------------------------------------------------------------

  /** After a whole step: a stroke ended, a region was renamed, an undo, a new chart. @param {() => void} listener */
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

  /**
   * When copies of repeats were unlinked because their stitches do not lie together any more; hears
   * the repeats' names.
   *
   * @param {(names: string[]) => void} listener
   */
  onTear(listener) {
    this.#torn.add(listener);
  }

  /**
   * When a change of the chart's size or shape cut cables; hears how many, which are knits and purls now.
   *
   * @param {(cut: number) => void} listener
   */
  onCut(listener) {
    this.#cut.add(listener);
  }

  // --- strokes --------------------------------------------------------------------------------

  get painting() {
    return this.#stroke !== null;
  }

  /** Resolves between strokes: what comes from elsewhere breaks none off. */
  async rested() {
    while (this.#stroke) await new Promise((done) => setTimeout(done, 50));
  }

  /** @param {Target} [target] */
  begin(target = "stitches") {
    this.cancel();
    this.#stroke = { target, layers: new Map(), others: new Map(), refused: -1 };
  }

  /**
   * Set stitches within the stroke: 1 for purl, 0 for knit; or for being in the outline or region.
   *
   * @param {Brush} brush
   * @param {boolean} fresh whether the stroke is only these (a shape being dragged)
   * @param {Put} [put] other stitches to put there; those under the brush go
   */
  paint(brush, fresh, put = []) {
    const stroke = this.#stroke;
    if (!stroke) return;
    const { target } = stroke;
    if (target === "stitches") {
      this.#layStitches(this.#linked(brush), fresh, put);
      return;
    }
    const { locked } = this.links;
    const own = target === "outline" ? null : this.region(target.slice(7));
    const allowed = new Brush(this.grid.purl.length);
    for (const i of brush.touched) {
      if (own ? own.locked : locked[i]) stroke.refused = i;
      else if (!own || this.outline[i]) allowed.set(i, brush.values[i]);
    }
    this.#lay(target, allowed, fresh);
    if (own?.fill) {
      this.#layStitches(this.#linked(filling(own, this, stroke.layers.get(target))), true);
    }
  }

  /** End the stroke and remember it as one step. @param {string} label @returns {boolean} whether anything changed */
  commit(label) {
    const stroke = this.#stroke;
    if (!stroke) return false;
    this.#stroke = null;
    /** @type {Patch[]} */
    const patches = [];
    for (const [on, { runs }] of stroke.layers) if (runs.length) patches.push({ on, runs });
    patches.push(...this.#exchanged(stroke.others), ...this.#followMotifs());
    this.#tellRefused(stroke.refused);
    return this.#keep(label, patches);
  }

  /** End the stroke and take it back. */
  cancel() {
    const stroke = this.#stroke;
    this.#stroke = null;
    for (const [on, layer] of stroke?.layers ?? []) this.refresh(on, layer.revert());
    if (stroke) this.#takeBack(stroke.others);
  }

  /**
   * Set stitches as one step; linked ones follow, locked ones stay.
   *
   * @param {Iterable<readonly [number, number]>} cells stitch and 1 for purl, 0 for knit
   * @param {string} label
   * @param {Target} [target]
   * @param {Put} [put] other stitches to put there
   */
  set(cells, label, target = "stitches", put = []) {
    this.begin(target);
    this.paint(Brush.of(this.grid.purl.length, cells), false, put);
    return this.commit(label);
  }

  // --- whole charts ---------------------------------------------------------------------------

  /**
   * Make the stitches those of another chart, as one step; regions and outline stay if the size
   * does, and copies of repeats that no longer match are unlinked. Does nothing if it is the same.
   *
   * @param {Grid} next
   * @param {string} label
   * @param {Put} [put] its other stitches
   */
  replace(next, label, put = []) {
    this.cancel();
    const others = Others.of(put);
    const sides = [...new Set([...this.others.entries, ...put].map(([i]) => i))];
    const changes = sides
      .map((i) => /** @type {OtherChange} */ ([i, this.others.code(i), others.code(i)]))
      .filter(([, before, after]) => before !== after);
    if (next.equals(this.grid) && !changes.length) return;
    if (next.rows !== this.grid.rows || next.columns !== this.grid.columns) {
      const repeats = this.repeats.map((repeat) => repeat.with({ placements: [] }).written());
      const more = { other_stitches: written(others, next.columns), repeats, shelf: [...this.shelf] };
      this.load(contentOf(next.text, more), label);
      return;
    }
    const differs = next.purl.map((p, i) => p ^ this.grid.purl[i]);
    const patches = this.exchange("repeats", matching(this.repeats, next));
    patches.push({ on: "stitches", runs: toRuns(differs) });
    this.flipRuns("stitches", toRuns(differs));
    if (changes.length) {
      this.apply({ others: changes }, "after");
      patches.push({ others: changes });
    }
    this.#keep(label, patches);
  }

  /** Become another document, as one step that can be undone. @param {Content} content @param {string} label */
  load(content, label) {
    this.cancel();
    const before = { ...snapshotOf(this), shelf: [...this.shelf] };
    const after = snapshotFrom(content);
    this.become(after);
    this.#keep(label, [{ before, after }]);
  }

  /** Become another document with a history of its own. @param {Content} content @param {History} [history] */
  open(content, history = new History()) {
    this.cancel();
    this.history = history;
    this.become(snapshotFrom(content));
    this.#settle();
  }

  /**
   * Move the chart's stitches to other places; outline, regions and repeats move with them. A copy
   * of a repeat that is torn is unlinked.
   *
   * @param {string} label
   * @param {import("./reshape.js").Reshape} how
   */
  reshape(label, how) {
    this.cancel();
    const before = snapshotOf(this);
    const { after, cut } = reshaped(this, how);
    this.become(after);
    this.#keep(label, [{ before, after }]);
    const torn = before.repeats.filter(({ placements }, k) => after.repeats[k].placements.length < placements.length);
    const names = torn.map(({ name }) => name);
    if (names.length) for (const listener of this.#torn) listener(names);
    if (cut) for (const listener of this.#cut) listener(cut);
  }

  /** @returns {string | undefined} what was undone */
  undo() {
    this.cancel();
    const step = this.history.undo();
    if (!step) return undefined;
    for (const patch of step.patches.toReversed()) this.apply(patch, "before");
    this.#settle();
    return step.label;
  }

  /** @returns {string | undefined} what was done again */
  redo() {
    this.cancel();
    const step = this.history.redo();
    if (!step) return undefined;
    for (const patch of step.patches) this.apply(patch, "after");
    this.#settle();
    return step.label;
  }

  // --- regions --------------------------------------------------------------------------------

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
    this.#arrange(
      "Remove region",
      "regions",
      this.regions.filter((region) => region.id !== id),
    );
  }

  /**
   * Put a region higher or lower; a fill that comes to lie over another one is laid there.
   *
   * @param {string} id
   * @param {number} index 0 is the lowest
   */
  orderRegion(id, index) {
    const region = this.region(id);
    if (!region) return;
    const regions = this.regions.filter((other) => other !== region).toSpliced(index, 0, region);
    this.#arrange("Reorder regions", "regions", regions, uncovered(this, regions));
  }

  // --- repeats --------------------------------------------------------------------------------

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

  /** Its copies keep their stitches and are no longer linked. @param {string} id */
  removeRepeat(id) {
    this.#arrange(
      "Remove repeat",
      "repeats",
      this.repeats.filter((repeat) => repeat.id !== id),
    );
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
   * @param {Region | Repeat | Brush | null} [laid]
   */
  #arrange(label, list, next, laid = null) {
    this.cancel();
    const put = laid instanceof Repeat && this.others.size ? this.#carried(laid) : [];
    const patches = this.exchange(list, next);
    if (laid) {
      this.begin();
      if (laid instanceof Repeat) this.#layStitches(this.#linked(laying(laid, this.grid), true), false, put);
      else if (laid instanceof Brush) this.paint(laid, false);
      else if (laid.fill) this.paint(filling(laid, this), false);
      const stroke = this.#stroke;
      this.#stroke = null;
      const { runs } = stroke?.layers.get("stitches") ?? { runs: [] };
      if (runs.length) patches.push({ on: "stitches", runs });
      patches.push(...this.#exchanged(stroke?.others ?? new Map()), ...this.#followMotifs());
      this.#tellRefused(stroke?.refused ?? -1);
    }
    this.tell({ box: this.grid.box, resized: false });
    this.#keep(label, patches);
  }

  /**
   * Wanted stitches, with all that are linked to them; without those that cannot be painted.
   *
   * @param {Brush} brush
   * @param {boolean} [everywhere] also where there is no stitch
   */
  #linked(brush, everywhere = false) {
    const links = this.links;
    const spread = new Brush(this.grid.purl.length);
    const motifs = new Brush(links.groups);
    for (const i of brush.touched) {
      if (!this.outline[i] && !everywhere) continue;
      const group = links.group[i];
      if (links.locked[i]) {
        if (this.#stroke && brush.values[i] !== this.grid.purl[i]) this.#stroke.refused = i;
      } else if (group) motifs.set(group, brush.values[i]);
      else spread.set(i, brush.values[i]);
    }
    for (const group of motifs.touched) {
      for (const i of links.members(group)) spread.set(i, motifs.values[group]);
    }
    return spread;
  }

  /** Motifs become what their copies show. @returns {Patch[]} */
  #followMotifs() {
    const links = this.links;
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

  /**
   * Lay knits and purls, which take the place of other stitches, and other stitches on them.
   *
   * @param {Brush} brush
   * @param {boolean} fresh
   * @param {Put} [put]
   */
  #layStitches(brush, fresh, put = []) {
    const stroke = this.#stroke;
    const { others, grid } = this;
    if (!stroke) return;
    if (others.size || put.length || stroke.others.size) {
      if (fresh) {
        this.refresh("stitches", stroke.layers.get("stitches")?.revert() ?? null);
        this.#takeBack(stroke.others);
        fresh = false;
      }
      const before = stroke.others.size;
      for (const i of brush.touched) this.#putOther(others.start(i), null);
      const laid = this.#allowed(put);
      for (const [i, code] of laid) {
        for (let k = 0; k < kindOf(code).width; k++) this.#putOther(others.start(i + k), null);
        this.#putOther(i, code);
      }
      settleUnder(brush, grid.purl, grid.columns, others, laid);
      if (laid.length || stroke.others.size > before) this.tellOthers([...stroke.others.keys()]);
    }
    this.#lay("stitches", brush, fresh);
  }

  /** @param {number | undefined} i @param {string | null} code */
  #putOther(i, code) {
    const { others } = this;
    if (i === undefined || others.code(i) === code) return;
    const kept = /** @type {Map<number, string | null>} */ (this.#stroke?.others);
    if (!kept.has(i)) kept.set(i, others.code(i));
    others.put(i, code);
  }

  /** Other stitches that may be put, with all that are linked to them. @param {Put} put @returns {Put} */
  #allowed(put) {
    const { links, outline, grid } = this;
    /** @type {Map<number, string>} */
    const allowed = new Map();
    for (const [start, code] of put) {
      const { width } = kindOf(code);
      const group = links.group[start];
      for (const i of group ? links.members(group) : [start]) {
        const cells = Array.from({ length: width }, (_, k) => i + k);
        const fits = (i % grid.columns) + width <= grid.columns && cells.every((cell) => outline[cell]);
        if (cells.some((cell) => links.locked[cell])) /** @type {{refused: number}} */ (this.#stroke).refused = i;
        else if (fits) allowed.set(i, code);
      }
    }
    return [...allowed].sort(([a], [b]) => a - b);
  }

  /** @param {Map<number, string | null>} before */
  #takeBack(before) {
    for (const i of before.keys()) this.others.put(i, null);
    for (const [i, code] of before) this.others.put(i, code);
    this.tellOthers([...before.keys()]);
    before.clear();
  }

  /** @param {Map<number, string | null>} before @returns {Patch[]} */
  #exchanged(before) {
    const changes = [...before]
      .map(([i, code]) => /** @type {OtherChange} */ ([i, code, this.others.code(i)]))
      .filter(([, old, now]) => old !== now);
    return changes.length ? [{ others: changes }] : [];
  }

  /**
   * The other stitches of a repeat's copies: a motif has knits and purls alone, and what else it has is seen in
   * its first copy.
   *
   * @param {Repeat} repeat as it will be
   * @returns {Put}
   */
  #carried(repeat) {
    const old = this.repeat(repeat.id);
    const [first] = old?.placements.length ? old.placements : repeat.placements;
    if (!first || (old && !old.motif.equals(repeat.motif))) return [];
    const { motif } = repeat;
    const box = { row0: first.row, column0: first.column, row1: first.row, column1: first.column };
    box.row1 += Math.min(motif.rows, first.rows);
    box.column1 += Math.min(motif.columns, first.columns);
    const wide = box.column1 - box.column0;
    const { entries } = within(this.others, this.grid.columns, box);
    return repeat.placements.flatMap((place) =>
      entries.flatMap(([k, code]) => {
        const put = [];
        for (let row = Math.floor(k / wide); row < place.rows; row += motif.rows) {
          for (let column = k % wide; column + kindOf(code).width <= place.columns; column += motif.columns) {
            put.push(/** @type {const} */ ([this.grid.index(place.row + row, place.column + column), code]));
          }
        }
        return put;
      }),
    );
  }

  /** @param {string} on @param {Brush} brush @param {boolean} fresh */
  #lay(on, brush, fresh) {
    const stroke = this.#stroke;
    const bitmap = this.bitmap(on);
    if (!stroke || !bitmap) return;
    let layer = stroke.layers.get(on);
    if (!layer) stroke.layers.set(on, (layer = new Layer(bitmap, this.grid.columns)));
    this.refresh(on, layer.apply(brush, fresh));
  }

  /** @param {number} refused a stitch that was locked, or -1 */
  #tellRefused(refused) {
    if (refused < 0) return;
    const locked = this.regions.filter((region) => region.locked);
    const here = locked.filter(({ cells }) => cells[refused]);
    // A stitch may be locked through one that it is linked to.
    const names = (here.length ? here : locked).map(({ name }) => name);
    for (const listener of this.#refused) listener(names);
  }

  /** @param {string} label @param {Patch[]} patches */
  #keep(label, patches) {
    if (!patches.length) return false;
    this.history.push({ label, patches });
    this.#settle();
    return true;
  }

  #settle() {
    for (const listener of this.#settled) listener();
  }
}

/** @param {string} prefix @param {readonly {id: string}[]} items */
function freeId(prefix, items) {
  let number = items.length + 1;
  while (items.some(({ id }) => id === `${prefix}-${number}`)) number++;
  return `${prefix}-${number}`;
}
