/**
 * Pointer and keys on the chart: turns gestures into strokes of the chosen tool.
 *
 * @import {Cell} from "../grid/raster.js"
 * @import {Combination, Selection} from "../design/selection.js"
 * @import {Gesture} from "../tools/tool.js"
 * @import {ChartView} from "./view.js"
 * @import {Placed} from "./placing.js"
 * @import {Studio} from "../state/studio.js"
 */

import { Floating } from "../design/floating.js";
import { inked } from "../design/ink.js";
import { withPlace } from "../design/repeats.js";
import { combined, selects } from "../design/selection.js";
import { Brush } from "../grid/stroke.js";
import { boxAt, placedAt, placedBox, shifted } from "./placing.js";

/**
 * The stitch under the pointer is shown this much later: a press that comes at once must not wait
 * for the frame that shows it, which takes longer than that where there is no GPU.
 */
const HOVER_MS = 24;

/** @type {Cell} */
const CORNER = [0, 0];

/** @param {import("../design/ink.js").Ink} ink */
const tooLarge = ({ name, repeat }) =>
  `${name} has ${repeat?.columns} × ${repeat?.rows} stitches: this chart is too small for it.`;

export class Painter {
  /** @type {Gesture | null} */ #gesture = null;
  #ink;
  /** Selection that a gesture began with. @type {Selection | null} */ #before = null;
  /** @type {Combination} */ #combination = "replace";
  /** @type {Floating | null} */ #floating = null;
  /** A copy of a repeat that is being moved. @type {Placed | null} */ #placed = null;
  /** Where a selection by keys began. @type {Cell | null} */ #anchor = null;
  /** Stitch to be shown as under the pointer. @type {Cell | null} */ #pointed = null;
  #panning = false;
  #space = false;

  /** @param {ChartView} view @param {Studio} studio */
  constructor(view, studio) {
    this.view = view;
    this.studio = studio;
    this.#ink = studio.ink.value;
    const { canvas } = view;
    void import("./pinch.js").then(({ listenToPinches }) => listenToPinches(view, () => this.#cancel()));
    canvas.addEventListener("pointerdown", (event) => this.#down(event));
    canvas.addEventListener("pointermove", (event) => this.#move(event));
    canvas.addEventListener("pointerup", () => this.#up());
    canvas.addEventListener("pointercancel", () => this.#cancel());
    canvas.addEventListener("pointerleave", () => {
      this.#pointed = null;
      if (!this.#gesture) view.hover.value = null;
    });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
    canvas.addEventListener("keydown", (event) => this.#key(event));
    // A key that pastes or inserts means the stitch under the pointer now.
    window.addEventListener("keydown", () => this.#pointed && this.#hover(this.#pointed), { capture: true });
    canvas.addEventListener("blur", () => (view.hover.value = null));
    window.addEventListener("keyup", ({ key }) => {
      if (key === " ") this.#space = false;
    });
    studio.tool.watch(({ mode }) => (canvas.dataset.mode = mode));
    studio.document.onTear((names) =>
      studio.tell(`Unlinked copies that are no longer whole: ${names.join(", ")}. Undo brings them back.`),
    );
    studio.document.onCut((cut) =>
      studio.tell(
        `${cut === 1 ? "A cable was" : `${cut} cables were`} cut and became knits and purls. Undo brings back what was.`,
      ),
    );
    studio.document.onRefuse((names) =>
      studio.tell(`Locked: ${names.join(", ")}. Unlock it in the list of regions to paint there.`),
    );
  }

  /** @param {PointerEvent} event */
  #down(event) {
    const { studio, view } = this;
    if (event.button > 2) return;
    // Only when needed: it makes the browser lay out the page.
    if (document.activeElement !== view.canvas) view.canvas.focus({ preventScroll: true });
    view.canvas.setPointerCapture(event.pointerId);
    const cell = view.cellAt(event);
    this.#hover(cell);
    const { mode } = studio.tool.value;
    if (event.button === 1 || this.#space || mode === "pan") {
      this.#panning = true;
      return;
    }
    if (mode !== "select" && mode !== "move" && !studio.document.grid.has(...cell)) return;
    this.#begin(cell, event.button === 2, event);
    view.flush();
  }

  /** @param {Cell} cell @param {boolean} opposite @param {{shiftKey: boolean, altKey: boolean}} keys */
  #begin(cell, opposite, { shiftKey, altKey }) {
    const { studio } = this;
    const { document: chart, tool } = studio;
    const { grid } = chart;
    this.#gesture = { start: cell, previous: cell, current: cell, path: [cell], constrain: shiftKey };
    const { mode } = tool.value;
    if (mode === "select") {
      this.#before = studio.selection.value;
      this.#combination = shiftKey ? (altKey ? "intersect" : "add") : altKey ? "subtract" : "replace";
      this.#apply();
    } else if (mode === "move") {
      if (!this.#lift(cell, altKey)) this.#gesture = null;
    } else if (mode === "place") {
      if (!studio.editing.repeat) {
        this.#gesture = null;
        studio.tell("Make a repeat first: select one motif, then “New from the selection” in Repeats.");
      } else this.#apply();
    } else {
      const ink = opposite ? studio.ink.value.opposite() : studio.ink.value;
      this.#ink = ink.resolved(grid.purl[grid.index(...cell)]);
      chart.begin(this.#ink.target);
      this.#apply();
    }
  }

  /**
   * Take what is selected into the hand; without a selection, the repeat or region under the pointer.
   *
   * @param {Cell} cell
   * @param {boolean} copy
   */
  #lift(cell, copy) {
    const { studio } = this;
    const { document: chart, selection } = studio;
    if (!selection.value || !selects(selection.value, ...cell)) {
      const box = boxAt(chart, cell);
      if (box) selection.value = box;
      else if (!selection.value) {
        studio.tell("Select stitches first (M, Q or W); then drag them.");
        return false;
      }
    }
    if (!selection.value) return false;
    this.#placed = copy ? null : placedAt(chart, selection.value);
    if (this.#placed) return true;
    this.#floating = copy
      ? Floating.lift(chart, selection.value, true)
      : (studio.editing.floating ?? Floating.lift(chart, selection.value, false));
    chart.begin();
    return true;
  }

  /** @param {PointerEvent} event */
  #move(event) {
    const { view } = this;
    if (this.#panning) {
      view.pan(event.movementX, event.movementY);
      return;
    }
    const cell = view.cellAt(event);
    const gesture = this.#gesture;
    if (!gesture) {
      if (!this.#pointed) setTimeout(() => this.#pointed && this.#hover(this.#pointed), HOVER_MS);
      this.#pointed = cell;
      return;
    }
    this.#hover(cell);
    const { mode } = this.studio.tool.value;
    const freehand = mode === "stroke" || mode === "select";
    const between = freehand ? (event.getCoalescedEvents?.() ?? []) : [];
    for (const each of between.length ? between : [event]) this.#follow(view.cellAt(each), event.shiftKey);
    view.flush();
  }

  /** @param {Cell} cell */
  #hover(cell) {
    this.#pointed = null;
    const { hover } = this.view;
    const moved = hover.value?.[0] !== cell[0] || hover.value[1] !== cell[1];
    if (moved) hover.value = this.studio.document.grid.has(...cell) ? cell : null;
  }

  /** @param {Cell} cell @param {boolean} constrain */
  #follow(cell, constrain) {
    const gesture = this.#gesture;
    if (!gesture || (cell[0] === gesture.current[0] && cell[1] === gesture.current[1])) return;
    gesture.previous = gesture.current;
    gesture.current = cell;
    gesture.path.push(cell);
    gesture.constrain = constrain;
    this.#apply();
  }

  #apply() {
    const { studio, view } = this;
    const gesture = this.#gesture;
    const tool = studio.tool.value;
    if (!gesture) return;
    if (tool.id === "stamp") {
      const place = this.#ink.stampAt(gesture.current, studio.document.grid);
      if (!place) return studio.tell(tooLarge(this.#ink));
      gesture.current = place;
    }
    const { document: chart } = studio;
    const { grid, codes, outline, others } = chart;
    if (tool.mode === "once" && gesture.current !== gesture.start) return;
    if (tool.mode === "place") {
      view.preview.value = placedBox(studio.editing.repeat, grid, gesture.start, gesture.current);
      return;
    }
    if (tool.mode === "move") {
      if (this.#placed) view.preview.value = shifted(this.#placed.box, gesture, grid);
      else if (this.#floating) {
        const target = this.#target();
        const brush = Brush.of(grid.purl.length, this.#floating.moved(grid, target));
        chart.paint(brush, true, this.#floating.put(grid, target));
      }
      return;
    }
    const spans = tool.spans(gesture, { grid, codes, outline, others, size: studio.size.value, ink: this.#ink });
    const symmetry = studio.symmetry.value;
    if (tool.mode === "select") {
      studio.selection.value = combined(this.#before, spans, grid, this.#combination, symmetry);
      return;
    }
    const origin = tool.origin?.(gesture) ?? (this.#ink.isWide ? gesture.start : CORNER);
    const [brush, put] = inked(grid, spans, this.#ink, origin, symmetry);
    chart.paint(brush, tool.mode === "shape", put);
  }

  /** Where the lower left corner of what is in the hand is now. @returns {Cell} */
  #target() {
    const { start, current } = /** @type {Gesture} */ (this.#gesture);
    const [row, column] = /** @type {Floating} */ (this.#floating).place;
    return [row + current[0] - start[0], column + current[1] - start[1]];
  }

  #up() {
    this.#panning = false;
    if (!this.#gesture) return;
    const { studio, view } = this;
    const { document: chart, tool } = studio;
    if (tool.value.mode === "place") this.#place();
    else if (this.#placed) this.#replace(this.#placed);
    else if (this.#floating) {
      const { clip, under, others } = this.#floating;
      const target = this.#target();
      if (chart.commit(tool.value.label)) studio.editing.hold(new Floating(clip, target, under, others));
    } else chart.commit(studio.ink.value.target === "stitches" ? tool.value.label : studio.ink.value.name);
    this.#floating = null;
    this.#gesture = null;
    view.flush();
  }

  /** Put copies of the active repeat where they are shown. */
  #place() {
    const { studio, view } = this;
    const repeat = studio.editing.repeat;
    const box = view.preview.value;
    view.preview.value = null;
    if (!repeat) return;
    if (!box) {
      studio.tell(`${repeat.name} does not fit there: it is a ${repeat.rule}.`);
      return;
    }
    const { row0: row, column0: column, row1, column1 } = box;
    const place = { row, column, rows: row1 - row, columns: column1 - column };
    studio.document.changeRepeat(repeat.id, { placements: withPlace(repeat, place) }, "Place a repeat");
  }

  /** Move a copy of a repeat; the stitches it leaves stay and are no longer linked. @param {Placed} placed */
  #replace({ repeat, at }) {
    const { studio, view } = this;
    const box = view.preview.value;
    this.#placed = null;
    view.preview.value = null;
    if (!box) return;
    const placements = repeat.placements.map((place, k) =>
      k === at ? { ...place, row: box.row0, column: box.column0 } : place,
    );
    studio.document.changeRepeat(repeat.id, { placements }, "Move a repeat");
    studio.selection.value = box;
  }

  #cancel() {
    this.#panning = false;
    this.#placed = null;
    if (this.#gesture && this.studio.tool.value.mode === "select") this.studio.selection.value = this.#before;
    this.#gesture = null;
    this.#floating = null;
    this.view.preview.value = null;
    this.studio.document.cancel();
  }

  /** @param {WheelEvent} event */
  #wheel(event) {
    event.preventDefault();
    if (event.shiftKey) this.view.pan(-event.deltaY - event.deltaX, 0);
    else {
      const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 30 : 1;
      this.view.zoom(Math.exp(-event.deltaY * lines * 0.0016), event.offsetX, event.offsetY);
    }
  }

  /** Arrow keys move a cursor (or what is selected), Enter paints there. @param {KeyboardEvent} event */
  #key(event) {
    const { view, studio } = this;
    const { grid } = studio.document;
    const { mode } = studio.tool.value;
    if (event.key === " ") {
      this.#space = true;
      event.preventDefault();
      return;
    }
    if (event.key === "Escape" && this.#gesture) {
      event.stopPropagation();
      this.#cancel();
      return;
    }
    const sideways = view.viewport.mirrored ? -1 : 1;
    const step = { ArrowUp: [1, 0], ArrowDown: [-1, 0], ArrowLeft: [0, -sideways], ArrowRight: [0, sideways] }[
      event.key
    ];
    if (event.ctrlKey || event.metaKey || event.altKey || (!step && event.key !== "Enter")) return;
    event.preventDefault();
    const cell = view.hover.value ?? [0, grid.columns - 1];
    if (step && mode === "move" && studio.selection.value) {
      const { row0, column0 } = studio.selection.value;
      this.#begin([row0, column0], false, { shiftKey: false, altKey: false });
      this.#follow([row0 + step[0], column0 + step[1]], false);
      this.#up();
      return;
    }
    if (step) {
      const row = Math.min(grid.rows - 1, Math.max(0, cell[0] + (view.hover.value ? step[0] : 0)));
      const column = Math.min(grid.columns - 1, Math.max(0, cell[1] + (view.hover.value ? step[1] : 0)));
      if (event.shiftKey && mode === "select") {
        this.#anchor ??= cell;
        this.#begin(this.#anchor, false, { shiftKey: false, altKey: false });
        this.#follow([row, column], false);
        this.#gesture = null;
      } else this.#anchor = null;
      view.hover.value = [row, column];
      return;
    }
    if (mode === "pan" || mode === "move") return;
    this.#begin(cell, event.shiftKey && mode !== "select", event);
    this.#up();
  }
}
