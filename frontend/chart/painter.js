/**
 * Pointer and keys on the chart: turns gestures into strokes of the chosen tool.
 *
 * @import {Cell} from "../core/raster.js"
 * @import {Gesture} from "../tools/tool.js"
 * @import {ChartView} from "./view.js"
 * @import {Studio} from "../studio.js"
 */

import { inked } from "../core/ink.js";
import { Brush } from "../core/stroke.js";

/** @type {Cell} */
const CORNER = [0, 0];

export class Painter {
  /** @type {Gesture | null} */ #gesture = null;
  #ink;
  /** Where a selection by keys began. @type {Cell | null} */ #anchor = null;
  #panning = false;
  #space = false;

  /**
   * @param {ChartView} view
   * @param {Studio} studio
   */
  constructor(view, studio) {
    this.view = view;
    this.studio = studio;
    this.#ink = studio.ink.value;
    const { canvas } = view;
    canvas.addEventListener("pointerdown", (event) => this.#down(event));
    canvas.addEventListener("pointermove", (event) => this.#move(event));
    canvas.addEventListener("pointerup", () => this.#up());
    canvas.addEventListener("pointercancel", () => this.#cancel());
    canvas.addEventListener("pointerleave", () => {
      if (!this.#gesture) view.hover.value = null;
    });
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => this.#wheel(event), { passive: false });
    canvas.addEventListener("keydown", (event) => this.#key(event));
    canvas.addEventListener("blur", () => (view.hover.value = null));
    window.addEventListener("keyup", ({ key }) => {
      if (key === " ") this.#space = false;
    });
    studio.tool.watch(({ mode }) => (canvas.dataset.mode = mode));
  }

  /** @param {PointerEvent} event */
  #down(event) {
    const { studio, view } = this;
    if (event.button > 2) return;
    view.canvas.focus({ preventScroll: true });
    view.canvas.setPointerCapture(event.pointerId);
    const cell = view.cellAt(event);
    if (event.button === 1 || this.#space || studio.tool.value.mode === "pan") {
      this.#panning = true;
      return;
    }
    if (studio.tool.value.mode !== "select" && !studio.document.grid.has(...cell)) return;
    this.#begin(cell, event.button === 2, event.shiftKey);
  }

  /**
   * @param {Cell} cell
   * @param {boolean} opposite
   * @param {boolean} constrain
   */
  #begin(cell, opposite, constrain) {
    const { studio } = this;
    const { grid } = studio.document;
    this.#gesture = { start: cell, previous: cell, current: cell, constrain };
    if (studio.tool.value.mode === "select") {
      studio.selection.value = null;
      return;
    }
    const ink = opposite ? studio.ink.value.opposite() : studio.ink.value;
    this.#ink = ink.resolved(grid.purl[grid.index(...cell)]);
    studio.document.begin();
    this.#apply();
  }

  /** @param {PointerEvent} event */
  #move(event) {
    const { view } = this;
    if (this.#panning) {
      view.pan(event.movementX, event.movementY);
      return;
    }
    const cell = view.cellAt(event);
    const hover = view.hover.value;
    const moved = hover?.[0] !== cell[0] || hover[1] !== cell[1];
    if (moved) view.hover.value = this.studio.document.grid.has(...cell) ? cell : null;
    const gesture = this.#gesture;
    if (!gesture) return;
    if (cell[0] === gesture.current[0] && cell[1] === gesture.current[1]) return;
    gesture.previous = gesture.current;
    gesture.current = cell;
    gesture.constrain = event.shiftKey;
    this.#apply();
  }

  #apply() {
    const { studio } = this;
    const gesture = this.#gesture;
    const tool = studio.tool.value;
    if (!gesture) return;
    const { grid, codes } = studio.document;
    if (tool.mode === "select") {
      const { start, current } = gesture;
      /** @param {number} i */
      const ends = (i) => {
        const limit = (i === 0 ? grid.rows : grid.columns) - 1;
        const a = Math.min(limit, Math.max(0, start[i]));
        const b = Math.min(limit, Math.max(0, current[i]));
        return [Math.min(a, b), Math.max(a, b) + 1];
      };
      const [row0, row1] = ends(0);
      const [column0, column1] = ends(1);
      studio.selection.value = { row0, row1, column0, column1 };
      return;
    }
    if (tool.mode === "once" && gesture.current !== gesture.start) return;
    const cells = tool.cells(gesture, {
      grid,
      codes,
      size: studio.size.value,
      ink: this.#ink,
    });
    const origin = tool.origin?.(gesture) ?? CORNER;
    studio.document.paint(
      Brush.of(grid.purl.length, inked(grid, cells, this.#ink, origin, studio.symmetry.value)),
      tool.mode === "shape",
    );
  }

  #up() {
    this.#panning = false;
    if (!this.#gesture) return;
    this.#gesture = null;
    this.studio.document.commit(this.studio.tool.value.label);
  }

  #cancel() {
    this.#panning = false;
    this.#gesture = null;
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

  /** Arrow keys move a cursor, Enter paints there. @param {KeyboardEvent} event */
  #key(event) {
    const { view, studio } = this;
    const { grid } = studio.document;
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
    const step = { ArrowUp: [1, 0], ArrowDown: [-1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] }[
      event.key
    ];
    if (event.ctrlKey || event.metaKey || event.altKey || (!step && event.key !== "Enter")) return;
    event.preventDefault();
    const cell = view.hover.value ?? [0, grid.columns - 1];
    if (step) {
      const row = Math.min(grid.rows - 1, Math.max(0, cell[0] + (view.hover.value ? step[0] : 0)));
      const column = Math.min(
        grid.columns - 1,
        Math.max(0, cell[1] + (view.hover.value ? step[1] : 0)),
      );
      if (event.shiftKey && studio.tool.value.mode === "select") {
        this.#anchor ??= cell;
        this.#gesture = { start: this.#anchor, previous: cell, current: [row, column], constrain: false };
        this.#apply();
        this.#gesture = null;
      } else this.#anchor = null;
      view.hover.value = [row, column];
      return;
    }
    if (studio.tool.value.mode === "pan" || studio.tool.value.mode === "select") return;
    this.#begin(cell, event.shiftKey, false);
    this.#up();
  }
}
