/**
 * The chart on its canvas. Two canvases lie over each other: the chart itself, of which only what
 * changed is drawn anew, and what follows the pointer.
 *
 * @import {Box} from "../grid/grid.js"
 * @import {Cell} from "../grid/raster.js"
 * @import {Colouring} from "../state/overlays.js"
 * @import {Studio} from "../state/studio.js"
 */

import { Signal } from "../core/signal.js";
import { h } from "../elements/dom.js";
import { ColourLayer } from "./layer.js";
import { drawGrid, drawSegments, drawSymbols } from "./marks.js";
import { OVERLAYS } from "../state/overlays.js";
import { pixel, readPalette } from "../state/palette.js";
import { drawAbsent, drawRegions, drawRepeatLabels, drawRepeats, selectionEdge } from "./parts.js";
import { drawCrosses, sideOfCrossed } from "./crosses.js";
import { GROUNDED, drawGrounds, drawSigns } from "./others.js";
import { signsLoaded } from "./symbols.js";
import { drawRectangles, roomInStitches, sideOfBlocks } from "./rectangles.js";
import { drawRulers } from "./rulers.js";
import { MARGIN, Viewport } from "./viewport.js";

/**
 * Drawn by the processor: the strokes are small, and without a GPU the emulation would take
 * longer for them than a stroke may. (The option's name speaks of reading, its effect is this.)
 */
const TOP_CONTEXT = { willReadFrequently: true };
const CONTEXT = { ...TOP_CONTEXT, alpha: false };

export class ChartView {
  viewport = new Viewport();
  palette = readPalette();
  /** Stitch under the pointer or the keyboard's cursor. */
  hover = new Signal(/** @type {Cell | null} */ (null));
  /** Stitches on a side of what is drawn: rectangles' blocks and room, crosses' blocks. */
  blockSide = new Signal(1);
  room = new Signal(1);
  crossedSide = new Signal(1);
  /** Where something being dragged would come to lie. */
  preview = new Signal(/** @type {Box | null} */ (null));
  #layer = new ColourLayer();
  /** @type {Colouring | null} */ #colouring = null;
  /** Stitches to draw anew: all, some, none. @type {Box | "all" | null} */ #dirty = "all";
  #topDirty = true;
  #frame = 0;
  /** @type {HTMLElement} */ #cursor;

  /**
   * @param {HTMLElement} host
   * @param {HTMLCanvasElement} canvas
   * @param {HTMLCanvasElement} top
   * @param {Studio} studio
   */
  constructor(host, canvas, top, studio) {
    this.canvas = canvas;
    this.top = top;
    this.studio = studio;
    this.context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d", CONTEXT));
    this.topContext = /** @type {CanvasRenderingContext2D} */ (top.getContext("2d", TOP_CONTEXT));

    new ResizeObserver(() => this.#resize(host)).observe(host);
    this.#resize(host);
    studio.document.onChange(({ box, resized }) => {
      if (resized) {
        this.studio.selection.value = null;
        if (this.viewport.fitted) this.viewport.fit(studio.document.grid);
        this.recolour();
      } else this.#mark(box);
      // A rectangle of several stitches reaches beyond those that changed.
      if (studio.rectangles.value && (studio.seeing.groups.value === "region" || this.blockSide.value > 1))
        this.redraw();
    });
    for (const signal of [studio.overlay, studio.stretch, studio.step, studio.material]) {
      signal.listen(() => this.recolour());
    }
    const { look, back, round } = studio.editing;
    const { groups, block, crosses } = studio.seeing;
    for (const signal of [studio.rectangles, groups, block, crosses, round]) signal.listen(() => this.redraw());
    signsLoaded.listen(() => this.redraw());
    studio.balance.listen(() => this.redraw());
    look.listen(() => this.recolour());
    studio.editing.symbols.listen(() => this.recolour());
    back.watch((turned) => {
      this.viewport.mirrored = turned;
      this.recolour();
    });
    for (const signal of [studio.selection, studio.symmetry, this.preview]) {
      signal.listen(() => this.#schedule(true));
    }
    // The cursor is an element of its own: moving it paints nothing.
    this.#cursor = h("div", { class: "chart-cursor", hidden: true });
    top.after(h("div", { class: "chart-cursors clipped", "aria-hidden": "true" }, this.#cursor));
    for (const signal of [studio.size, studio.tool, studio.ink, this.hover]) {
      signal.listen(() => this.#placeCursor());
    }
    studio.material.listen((material) => {
      const gauge = material?.fabrics.stockinette ?? Object.values(material?.fabrics ?? {})[0];
      const ratio = (gauge?.stitch_wale_mm ?? NaN) / (gauge?.stitch_course_mm ?? NaN);
      this.viewport.aspect = Number.isFinite(ratio) ? Math.min(1.5, Math.max(0.5, ratio)) : 0.8;
      this.fit();
    });
  }

  /** Show the whole chart. */
  fit() {
    this.viewport.fit(this.studio.document.grid);
    this.redraw();
  }

  /** @param {number} factor @param {number} [x] CSS pixels; the middle if left out @param {number} [y] */
  zoom(factor, x = this.viewport.width / 2, y = this.viewport.height / 2) {
    this.viewport.zoom(factor, x, y, this.studio.document.grid);
    this.redraw();
  }

  /** @param {number} dx @param {number} dy */
  pan(dx, dy) {
    this.viewport.pan(dx, dy, this.studio.document.grid);
    this.redraw();
  }

  /** @param {{offsetX: number, offsetY: number}} point @returns {Cell} */
  cellAt({ offsetX, offsetY }) {
    return this.viewport.cellAt(offsetX, offsetY, this.studio.document.grid);
  }

  /** Colours mean something else now. */
  recolour() {
    this.#colouring = null;
    this.redraw();
  }

  /** The theme changed. */
  retheme() {
    this.palette = readPalette();
    this.recolour();
  }

  redraw() {
    this.#dirty = "all";
    this.#schedule(true);
  }

  /** @param {Box} box */
  #mark(box) {
    if (this.#colouring) {
      const { grid, codes } = this.studio.document;
      this.#layer.update(grid, codes, this.#colouring, box, this.viewport.mirrored);
    }
    const dirty = this.#dirty;
    if (dirty === null) this.#dirty = box;
    else if (dirty !== "all") {
      this.#dirty = {
        row0: Math.min(dirty.row0, box.row0),
        column0: Math.min(dirty.column0, box.column0),
        row1: Math.max(dirty.row1, box.row1),
        column1: Math.max(dirty.column1, box.column1),
      };
    }
    this.#schedule(false);
  }

  /** @param {boolean} top */
  #schedule(top) {
    this.#topDirty ||= top;
    this.#frame ||= requestAnimationFrame(() => this.flush());
  }

  /** Draw everything pending at once: a stroke is on the canvas before its event ends. */
  flush() {
    cancelAnimationFrame(this.#frame);
    this.#frame = 0;
    this.#draw();
    if (this.#topDirty) {
      this.#drawTop();
      this.#placeCursor();
    }
    this.#topDirty = false;
  }

  /** Around the stitches that a click would paint. */
  #placeCursor() {
    const { studio } = this;
    const { grid } = studio.document;
    const cell = this.hover.value;
    const tool = studio.tool.value;
    const shown = cell && grid.has(...cell) && tool.mode !== "pan" && tool.mode !== "move";
    this.#cursor.hidden = !shown;
    if (!shown) return;
    const size = tool.sized ? studio.size.value : 1;
    const before = Math.floor((size - 1) / 2);
    const stamp = tool.id === "stamp" || studio.ink.value.isWide ? studio.ink.value.repeat : null;
    const [row0, column0] = (tool.id === "stamp" && studio.ink.value.stampAt(cell, grid)) || [
      cell[0] - before,
      cell[1] - before,
    ];
    const box = { row0, column0, row1: row0 + (stamp?.rows ?? size), column1: column0 + (stamp?.columns ?? size) };
    this.#around(this.#cursor, box);
  }

  /** @param {HTMLElement} element @param {Box} box */
  #around({ style }, box) {
    const { x, y, width, height } = this.viewport.place(box, this.studio.document.grid);
    style.width = `${width}px`;
    style.height = `${height}px`;
    style.transform = `translate(${x - MARGIN.left}px, ${y - MARGIN.top}px)`;
  }

  /** @param {HTMLElement} host */
  #resize(host) {
    const dpr = window.devicePixelRatio || 1;
    const { clientWidth, clientHeight } = host;
    if (!clientWidth || !clientHeight) return;
    for (const canvas of [this.canvas, this.top]) {
      canvas.width = Math.round(clientWidth * dpr);
      canvas.height = Math.round(clientHeight * dpr);
    }
    Object.assign(this.viewport, { width: clientWidth, height: clientHeight, dpr });
    if (this.viewport.fitted) this.viewport.fit(this.studio.document.grid);
    this.#dirty = "all";
    this.#topDirty = true;
    // At once: a resized canvas is empty until it is drawn.
    this.#draw();
    this.#drawTop();
  }

  #draw() {
    const dirty = this.#dirty;
    if (!dirty) return;
    this.#dirty = null;
    const { context, viewport, palette, studio } = this;
    const { grid, codes } = studio.document;
    const overlay = studio.overlay.value.available(studio) ? studio.overlay.value : null;
    const look = studio.editing.look.value;
    if (!this.#colouring) {
      const shown = overlay ?? FALLBACK;
      this.#colouring = look === "symbols" ? paper(palette) : shown.colouring(studio, palette);
      this.#layer.update(grid, codes, this.#colouring, grid.box, viewport.mirrored);
    }
    context.setTransform(viewport.dpr, 0, 0, viewport.dpr, 0, 0);
    const { x, y, cellWidth: w, cellHeight: h } = viewport;
    if (dirty === "all") {
      context.fillStyle = palette.pane;
      context.fillRect(0, 0, viewport.width, viewport.height);
      drawRulers(context, viewport, grid, palette, studio.editing.round.value, studio.balance.value);
    }
    const seen = viewport.visible(grid);
    const box = dirty === "all" ? seen : intersection(dirty, seen);
    if (box.row0 >= box.row1 || box.column0 >= box.column1) return;

    context.save();
    context.beginPath();
    const plot = { x: MARGIN.left - 1, y: MARGIN.top - 1 };
    context.rect(
      plot.x,
      plot.y,
      viewport.width - MARGIN.left - MARGIN.right + 2,
      viewport.height - MARGIN.top - MARGIN.bottom + 2,
    );
    context.clip();
    if (viewport.mirrored) context.transform(-1, 0, 0, 1, 2 * x + grid.columns * w, 0);
    const left = x + box.column0 * w;
    const top = y + (grid.rows - box.row1) * h;
    context.beginPath();
    context.rect(left, top, (box.column1 - box.column0) * w, (box.row1 - box.row0) * h);
    if (dirty !== "all") context.clip();
    context.imageSmoothingEnabled = false;
    context.drawImage(
      this.#layer.canvas,
      2 * box.column0,
      2 * (grid.rows - box.row1),
      2 * (box.column1 - box.column0),
      2 * (box.row1 - box.row0),
      left,
      top,
      (box.column1 - box.column0) * w,
      (box.row1 - box.row0) * h,
    );
    const around = {
      row0: Math.max(seen.row0, box.row0 - 1),
      column0: Math.max(seen.column0, box.column0 - 1),
      row1: Math.min(seen.row1, box.row1 + 1),
      column1: Math.min(seen.column1, box.column1 + 1),
    };
    drawGrid(context, viewport, grid, around, palette);
    const { others } = studio.document;
    // Maps of numbers keep their colours.
    const grounds = others.size > 0 && (look === "symbols" || GROUNDED.has((overlay ?? FALLBACK).id));
    if (grounds) drawGrounds(context, viewport, studio.document, around, palette);
    if (overlay?.id === "segments" && look !== "symbols") {
      drawSegments(context, viewport, grid, around, palette);
    } else if (!studio.rectangles.value && look !== "colours") {
      const style = look === "loops" ? look : studio.editing.symbols.value;
      drawSymbols(context, viewport, grid, this.#layer, around, style, viewport.mirrored, others);
    }
    if (others.size && !studio.rectangles.value && look !== "colours") {
      const { symbols } = studio.editing;
      const how = { layer: grounds ? null : this.#layer, palette, symbols: symbols.value, back: viewport.mirrored };
      drawSigns(context, viewport, studio.document, around, how);
    }
    this.blockSide.value = sideOfBlocks(studio, viewport);
    this.room.value = roomInStitches(studio, viewport);
    this.crossedSide.value = sideOfCrossed(viewport);
    if (studio.rectangles.value && studio.kinds().length) {
      drawRectangles(context, viewport, studio, around);
    }
    if (studio.seeing.crosses.value) drawCrosses(context, viewport, studio, around);
    const chart = studio.document;
    if (chart.shaped) drawAbsent(context, viewport, chart, around, palette);
    drawRegions(context, viewport, chart, around, palette);
    drawRepeats(context, viewport, chart, palette);
    if (viewport.mirrored) context.transform(-1, 0, 0, 1, 2 * x + grid.columns * w, 0);
    drawRepeatLabels(context, viewport, chart, palette);
    context.restore();
  }

  #drawTop() {
    const { topContext: context, viewport, palette, studio } = this;
    const { grid } = studio.document;
    const nothing = !studio.selection.value && !this.preview.value && studio.symmetry.value === "none";
    this.top.hidden = nothing; // even an empty layer would be blended into every frame
    if (nothing) return;
    const { x, y, cellWidth: w, cellHeight: h } = viewport;
    context.setTransform(viewport.dpr, 0, 0, viewport.dpr, 0, 0);
    context.clearRect(0, 0, viewport.width, viewport.height);
    context.beginPath();
    context.rect(
      MARGIN.left - 3,
      MARGIN.top - 3,
      viewport.width - MARGIN.left - MARGIN.right + 6,
      viewport.height - MARGIN.top - MARGIN.bottom + 6,
    );
    context.save();
    context.clip();
    const symmetry = studio.symmetry.value;
    context.strokeStyle = palette.accent;
    context.lineWidth = 1.5;
    context.setLineDash([6, 5]);
    context.beginPath();
    if (symmetry === "across" || symmetry === "both") {
      context.moveTo(x + (grid.columns * w) / 2, y);
      context.lineTo(x + (grid.columns * w) / 2, y + grid.rows * h);
    }
    if (symmetry === "up" || symmetry === "both") {
      context.moveTo(x, y + (grid.rows * h) / 2);
      context.lineTo(x + grid.columns * w, y + (grid.rows * h) / 2);
    }
    context.stroke();
    context.setLineDash([]);
    const selection = studio.selection.value;
    if (selection?.mask) {
      context.save();
      if (viewport.mirrored) context.transform(-1, 0, 0, 1, 2 * x + grid.columns * w, 0);
      this.#strokeOver(selectionEdge(viewport, grid, { ...selection, mask: selection.mask }), 2.5);
      context.restore();
    } else if (selection) this.#outline(selection, 2.5);
    if (this.preview.value) this.#outline(this.preview.value, 3);
    context.restore();
  }

  /** @param {Box} box @param {number} width */
  #outline(box, width) {
    const { x, y, width: wide, height: high } = this.viewport.place(box, this.studio.document.grid);
    const path = new Path2D();
    path.rect(x, y, wide, high);
    this.#strokeOver(path, width);
  }

  /** In the accent colour, legible on any other. @param {Path2D} path @param {number} width */
  #strokeOver(path, width) {
    const { topContext: context, palette } = this;
    context.strokeStyle = palette.pane;
    context.lineWidth = width + 2;
    context.stroke(path);
    context.strokeStyle = palette.accent;
    context.lineWidth = width;
    context.stroke(path);
  }
}

/** All stitches of the colour of a knit: the symbols say it all. @param {import("../state/palette.js").Palette} palette */
function paper({ knit }) {
  return { table: new Uint32Array(128).fill(pixel(knit)) };
}

/** Shown where the chosen overlay has no values (yet). */
const FALLBACK = OVERLAYS[1];

/** @param {Box} a @param {Box} b @returns {Box} */
function intersection(a, b) {
  return {
    row0: Math.max(a.row0, b.row0),
    column0: Math.max(a.column0, b.column0),
    row1: Math.min(a.row1, b.row1),
    column1: Math.min(a.column1, b.column1),
  };
}
