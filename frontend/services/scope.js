/**
 * What the numbers are of: the whole chart, the selection, or a region.
 *
 * @import {Box, Grid} from "../grid/grid.js"
 * @import {ChartState} from "../design/state.js"
 * @import {Selection} from "../design/selection.js"
 * @import {GirthAt} from "../state/seeing.js"
 * @import {Studio} from "../state/studio.js"
 * @import {Direction, GaugeInput, PredictResult} from "../types.js"
 *
 * @typedef {object} Scope
 * @property {"chart" | "selection" | "region"} kind
 * @property {string} title
 * @property {string} size in words
 * @property {Grid} grid the stitches whose moduli are shown, as a chart of their own
 * @property {Box | null} box where these lie in the chart; null for the repeat that fills a region
 * @property {{chart: string, outline: string} | null} shaped the whole of a piece with an outline
 * @property {{grid: Grid, mask: Uint8Array | null}} counted the stitches whose segments are counted
 * @property {string} note how the grid represents stitches that do not form a rectangle; "" if they do
 */

import { thousands } from "../core/format.js";
import { largestRectangle } from "../grid/inscribed.js";
import { selectionOf } from "../design/selection.js";
import { outlineText } from "../design/snapshot.js";

/** Girths of a limb that a tube sits on firmly, over its size at rest: where it begins, and where it ends. */
const SNUG = [1.12, 1.25];
/** Intervals along a shaped piece between the girths that fit it. */
const SHAPED = 4;

/** @param {Studio} studio @returns {Scope} */
export function scopeOf(studio) {
  const { document: chart, selection, seeing } = studio;
  const box = selection.value;
  if (box) return partOf(box, chart.grid, "selection", "Selection");
  return scopeIn(chart, seeing.region.value);
}

/**
 * A region of a chart, or the whole.
 *
 * @param {ChartState} chart
 * @param {string | null} id of the region
 * @returns {Scope}
 */
export function scopeIn(chart, id) {
  const { grid } = chart;
  const region = id === null ? null : chart.region(id);
  if (!region?.count) {
    const size = `${grid.columns} × ${grid.rows}`;
    const counted = { grid, mask: chart.shaped ? chart.outline : null };
    const inside = chart.shaped ? largestRectangle(chart.outline, grid.columns) : null;
    const shaped = inside && { chart: grid.text, outline: outlineText(chart.outline, grid.columns) };
    const part = inside ? grid.region(inside) : grid;
    return {
      kind: "chart",
      title: "Whole chart",
      size,
      grid: part,
      box: inside ?? grid.box,
      shaped,
      counted,
      note: "",
    };
  }
  const around = /** @type {Selection} */ (selectionOf(region.cells, grid));
  const part = partOf(around, grid, "region", region.name);
  return region.fill ? { ...part, grid: region.fill, box: null, note: "Of the repeat that fills it." } : part;
}

/**
 * The cloth of a scope as the service takes it, with its gauge if that is known.
 *
 * @param {Pick<Studio, "gauges" | "materialId">} studio
 * @param {{grid: Grid}} scope
 * @returns {{chart: string, material: string, gauge: GaugeInput | null}}
 */
export function clothIn({ gauges, materialId }, { grid }) {
  const cloth = { chart: grid.text, material: materialId.value };
  return { ...cloth, gauge: gauges.of(cloth) };
}

/**
 * All stitches of a scope, as one piece that the service takes.
 *
 * @param {Pick<Studio, "gauges" | "materialId">} studio
 * @param {Scope} scope
 */
export function pieceIn(studio, scope) {
  const { grid, mask } = scope.counted;
  return { ...clothIn(studio, scope), chart: grid.text, outline: mask && outlineText(mask, grid.columns) };
}

/** The whole piece as the service takes it. @param {Studio} studio */
export const pieceOf = (studio) => pieceIn(studio, scopeIn(studio.document, null));

/**
 * The limb that a piece is worn on: as it was given, or one on which a tube of the piece sits firmly.
 *
 * @param {Pick<Studio, "seeing">} studio
 * @param {Scope} scope of the piece
 * @param {PredictResult} predicted of its cloth
 * @returns {{direction: Direction, girths: GirthAt[]}}
 */
export function limbOf({ seeing }, { counted: { grid, mask } }, predicted) {
  const { direction, girths } = seeing.limb.value;
  if (girths) return { direction, girths };
  const byRow = direction === "course";
  const [course, wale] = [predicted.relaxed_course_mm, predicted.relaxed_wale_mm];
  const [lines, wide, high] = byRow ? [grid.rows, course, wale] : [grid.columns, wale, course];
  const around = inLines(grid, mask)[direction];
  const intervals = mask ? SHAPED : 1;
  const snug = Array.from({ length: intervals + 1 }, (_, i) => {
    const along = i / intervals;
    const rest = wide * around[Math.min(lines - 1, Math.floor(along * lines))];
    const girth = (SNUG[0] + along * (SNUG[1] - SNUG[0])) * rest;
    return { at_mm: Math.max(i, Math.round(along * lines * high)), girth_mm: Math.round(girth) };
  });
  return { direction, girths: snug };
}

/**
 * @param {Selection} box
 * @param {Grid} chart
 * @param {"selection" | "region"} kind
 * @param {string} title
 * @returns {Scope}
 */
function partOf(box, chart, kind, title) {
  const grid = chart.region(box);
  const { mask = null } = box;
  const counted = { grid, mask };
  const inside = mask && largestRectangle(mask, grid.columns);
  const common = { kind, title, shaped: null, counted };
  if (!mask || !inside) return { ...common, size: `${grid.columns} × ${grid.rows}`, grid, box, note: "" };
  const part = grid.region(inside);
  const place = {
    row0: box.row0 + inside.row0,
    column0: box.column0 + inside.column0,
    row1: box.row0 + inside.row1,
    column1: box.column0 + inside.column1,
  };
  const stitches = mask.reduce((sum, bit) => sum + bit, 0);
  const note = `Moduli of the largest rectangle inside it, ${part.columns} × ${part.rows} stitches.`;
  return { ...common, size: `${thousands(stitches)} stitches`, grid: part, box: place, note };
}

/**
 * How wide and high the cloth lies at rest, mm: of a part of a chart, its widest row and its highest column.
 *
 * @param {Scope} scope
 * @param {PredictResult} predicted of its cloth
 * @returns {Record<Direction, {value: number, interval: [number, number]}>}
 */
export function sizeAtRest({ kind, counted }, predicted) {
  const { width_mm, height_mm, width_interval_mm, height_interval_mm } = predicted;
  if (kind === "chart")
    return {
      course: { value: width_mm, interval: width_interval_mm },
      wale: { value: height_mm, interval: height_interval_mm },
    };
  const { course, wale } = inLines(counted.grid, counted.mask);
  const [columns, rows] = [Math.max(...course), Math.max(...wale)];
  const { relaxed_course_interval_mm: wide, relaxed_wale_interval_mm: high } = predicted;
  return {
    course: { value: columns * predicted.relaxed_course_mm, interval: [columns * wide[0], columns * wide[1]] },
    wale: { value: rows * predicted.relaxed_wale_mm, interval: [rows * high[0], rows * high[1]] },
  };
}

/**
 * Stitches in each row, along which the courses run, and in each column, along which the wales do.
 *
 * @param {Grid} grid
 * @param {Uint8Array | null} mask where there are stitches; everywhere if left out
 */
function inLines({ rows, columns }, mask) {
  const course = new Uint32Array(rows).fill(mask ? 0 : columns);
  const wale = new Uint32Array(columns).fill(mask ? 0 : rows);
  mask?.forEach((inside, i) => {
    course[Math.floor(i / columns)] += inside;
    wale[i % columns] += inside;
  });
  return { course, wale };
}
