/**
 * All repeats of an atlas by their stiffness along rows and along columns, both axes logarithmic.
 * What is under the pointer is shown, a press chooses it, a drag carries it onto the chart.
 *
 * @import {AtlasResult} from "../../types.js"
 *
 * @typedef {{key: string, index: number, x: number, y: number}} Point a repeat
 */

import { readPalette, themedReader } from "../../state/palette.js";
import { figure } from "../../core/format.js";
import { h } from "../../elements/dom.js";
import { logAxis } from "../../plots/axis.js";

const PAD = { left: 54, right: 14, top: 10, bottom: 40 };
/** @type {import("../../plots/axis.js").AxisOptions} */
const AXIS = { steps: [1, 2, 5], room: [0.08, 0.14] };
const NEAR_PX = 16;
/** Repeats of the four fabrics, in the order of the palette. */
const PURE = ["K", "P/K", "KP", "PK/KP"];
const PURE_NAMES = ["stockinette", "garter", "1×1 rib", "seed"];

/**
 * @param {{onHover: (point: Point | null) => void, onPress: (point: Point, event: PointerEvent) => void,
 *   onChoose: (point: Point) => void, onApply: () => void}} listeners
 */
export function scatter({ onHover, onPress, onChoose, onApply }) {
  const canvas = h("canvas", {
    class: "inverse-scatter rounded full-width",
    id: "inverse-scatter",
    tabIndex: 0,
    role: "application",
    "aria-label":
      "Repeats by stiffness. Left and right: softer or stiffer along rows; up and down: along columns; Enter fills.",
  });
  /** @type {AtlasResult | null} */ let table = null;
  /** @type {Point[]} */ let points = [];
  /** @type {Point | null} */ let hovered = null;
  /** @type {number | null} */ let chosen = null;
  /** @type {{x: number, y: number} | null} */ let own = null;
  let scales = { x: logAxis([1, 10], 0, 1, AXIS), y: logAxis([1, 10], 0, 1, AXIS) };

  const place = () => {
    const { clientWidth: width, clientHeight: height } = canvas;
    if (!table || width < 80 || height < 80) return;
    const xs = table.modulus_course_n_per_mm;
    const ys = table.modulus_wale_n_per_mm;
    scales = {
      x: logAxis(own ? [...xs, own.x] : xs, PAD.left, width - PAD.right, AXIS),
      y: logAxis(own ? [...ys, own.y] : ys, height - PAD.bottom, PAD.top, AXIS),
    };
    points = table.repeats.map((key, index) => ({ key, index, x: scales.x.at(xs[index]), y: scales.y.at(ys[index]) }));
  };

  const draw = () => {
    const { clientWidth: width, clientHeight: height } = canvas;
    if (width < 80 || height < 80) return;
    const ratio = devicePixelRatio;
    if (canvas.width !== Math.round(width * ratio) || canvas.height !== Math.round(height * ratio)) {
      canvas.width = Math.round(width * ratio);
      canvas.height = Math.round(height * ratio);
      place();
    }
    const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
    const palette = readPalette();
    const line = themedReader()("--line");
    context.setTransform(ratio, 0, 0, ratio, 0, 0);
    context.clearRect(0, 0, width, height);
    if (!table) return;
    context.font = "13px system-ui, sans-serif";
    context.lineWidth = 1;
    context.strokeStyle = line;
    context.fillStyle = palette.muted;
    context.textAlign = "center";
    for (const tick of scales.x.ticks) {
      stroke(context, scales.x.at(tick), PAD.top, scales.x.at(tick), height - PAD.bottom);
      context.fillText(String(tick), scales.x.at(tick), height - PAD.bottom + 16);
    }
    context.fillText("Stiffness along rows, N/mm", (PAD.left + width) / 2, height - 6);
    context.textAlign = "right";
    for (const tick of scales.y.ticks) {
      stroke(context, PAD.left, scales.y.at(tick), width - PAD.right, scales.y.at(tick));
      context.fillText(String(tick), PAD.left - 6, scales.y.at(tick) + 4);
    }
    context.save();
    context.translate(13, (PAD.top + height - PAD.bottom) / 2);
    context.rotate(-Math.PI / 2);
    context.textAlign = "center";
    context.fillText("along columns, N/mm", 0, 0);
    context.restore();
    for (const { key, index, x, y } of points) {
      if (PURE.includes(key)) continue;
      mark(context, table.provenance[index], x, y, palette);
    }
    for (const { key, x, y } of points) {
      const fabric = PURE.indexOf(key);
      if (fabric < 0) continue;
      context.beginPath();
      context.arc(x, y, 7, 0, 2 * Math.PI);
      context.fillStyle = `rgb(${palette.fabrics[fabric].join(" ")})`;
      context.fill();
      context.lineWidth = 1.5;
      context.strokeStyle = palette.text;
      context.stroke();
      label(context, PURE_NAMES[fabric], x, y - 12, width, palette);
    }
    if (own) {
      const [x, y] = [scales.x.at(own.x), scales.y.at(own.y)];
      context.strokeStyle = palette.accent;
      context.lineWidth = 2;
      stroke(context, x - 7, y, x + 7, y);
      stroke(context, x, y - 7, x, y + 7);
      // Below, or above where a fabric's name is below.
      const taken = points.some((p) => PURE.includes(p.key) && Math.abs(p.x - x) < 80 && Math.abs(p.y - y - 32) < 16);
      label(context, "this chart", x, taken ? y - 12 : y + 20, width, palette);
    }
    if (chosen !== null) interval(context, chosen, palette);
    for (const point of [hovered, chosen === null ? null : points[chosen]]) {
      if (!point) continue;
      context.beginPath();
      context.arc(point.x, point.y, PURE.includes(point.key) ? 10 : 7, 0, 2 * Math.PI);
      context.lineWidth = 2;
      context.strokeStyle = palette.accent;
      context.stroke();
    }
  };

  /** @param {CanvasRenderingContext2D} context @param {number} index @param {import("../../state/palette.js").Palette} palette */
  const interval = (context, index, palette) => {
    if (!table) return;
    const { x, y } = points[index];
    const clip = (/** @type {number} */ v, /** @type {number} */ low, /** @type {number} */ high) =>
      Math.min(high, Math.max(low, v));
    const right = canvas.clientWidth - PAD.right;
    const bottom = canvas.clientHeight - PAD.bottom;
    context.strokeStyle = palette.accent;
    context.lineWidth = 1.5;
    const across = table.modulus_course_interval_n_per_mm.map((ends) => ends[index]);
    const up = table.modulus_wale_interval_n_per_mm.map((ends) => ends[index]);
    const [x0, x1] = across.map((v) => clip(scales.x.at(v), PAD.left, right));
    const [y0, y1] = up.map((v) => clip(scales.y.at(v), PAD.top, bottom));
    stroke(context, x0, y, x1, y);
    stroke(context, x, y0, x, y1);
  };

  /** @param {MouseEvent} event @returns {Point | null} */
  const nearest = ({ offsetX, offsetY }) => {
    let best = null;
    let least = NEAR_PX;
    for (const point of points) {
      const bonus = PURE.includes(point.key) ? 4 : 0;
      const away = Math.hypot(point.x - offsetX, point.y - offsetY) - bonus;
      if (away < least) [best, least] = [point, away];
    }
    return best;
  };
  /** @param {Point | null} point */
  const hover = (point) => {
    if (point === hovered) return;
    hovered = point;
    canvas.style.cursor = point ? "grab" : "default";
    onHover(point);
    draw();
  };
  canvas.addEventListener("pointermove", (event) => hover(nearest(event)));
  canvas.addEventListener("pointerleave", () => hover(null));
  canvas.addEventListener("pointerdown", (event) => {
    const point = nearest(event);
    if (!point) return;
    canvas.focus({ preventScroll: true });
    onPress(point, event);
    hover(null);
  });
  canvas.addEventListener("keydown", (event) => {
    const axis = { ArrowLeft: "x", ArrowRight: "x", ArrowUp: "y", ArrowDown: "y" }[event.key];
    if (event.key === "Enter" && chosen !== null) onApply();
    else if (axis && points.length) {
      const along = /** @type {"x" | "y"} */ (axis);
      const order = points.toSorted((a, b) => (along === "x" ? a.x - b.x : b.y - a.y));
      const at = chosen === null ? -1 : order.indexOf(points[chosen]);
      const step = event.key === "ArrowRight" || event.key === "ArrowUp" ? 1 : -1;
      onChoose(order[Math.min(order.length - 1, Math.max(0, at + step))]);
    } else return;
    event.preventDefault();
    event.stopPropagation();
  });
  new ResizeObserver(() => {
    place();
    draw();
  }).observe(canvas);

  return {
    canvas,
    draw,
    /** @param {AtlasResult | null} next */
    show(next) {
      table = next;
      points = [];
      [chosen, hovered] = [null, null];
      place();
      draw();
    },
    /** @param {number | null} index */
    choose(index) {
      chosen = index;
      draw();
    },
    /** @param {{x: number, y: number} | null} next this chart's own stiffness */
    mark(next) {
      own = next;
      place();
      draw();
    },
  };
}

/** @param {Point} point @param {AtlasResult} table */
export function inWords({ index }, table) {
  return `${figure(table.modulus_course_n_per_mm[index])} and ${figure(table.modulus_wale_n_per_mm[index])} N/mm`;
}

/**
 * A repeat by where its law comes from: by shape, not by colour alone.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {string} source
 * @param {number} x
 * @param {number} y
 * @param {import("../../state/palette.js").Palette} palette
 */
function mark(context, source, x, y, palette) {
  context.beginPath();
  if (source === "swept") {
    context.rect(x - 3, y - 3, 6, 6);
    context.fillStyle = palette.text;
    context.fill();
  } else {
    context.arc(x, y, 2.4, 0, 2 * Math.PI);
    context.globalAlpha = 0.55;
    context.fillStyle = palette.muted;
    context.fill();
    context.globalAlpha = 1;
  }
}

/** @param {CanvasRenderingContext2D} context @param {string} text @param {number} x @param {number} y @param {number} width @param {import("../../state/palette.js").Palette} palette */
function label(context, text, x, y, width, palette) {
  const half = context.measureText(text).width / 2 + 2;
  const at = Math.min(width - PAD.right - half, Math.max(PAD.left + half, x));
  context.textAlign = "center";
  context.lineWidth = 4;
  context.strokeStyle = themedReader()("--panel");
  context.strokeText(text, at, y);
  context.fillStyle = palette.text;
  context.fillText(text, at, y);
}

/** @param {CanvasRenderingContext2D} context @param {number} x0 @param {number} y0 @param {number} x1 @param {number} y1 */
function stroke(context, x0, y0, x1, y1) {
  context.beginPath();
  context.moveTo(x0, y0);
  context.lineTo(x1, y1);
  context.stroke();
}
