/**
 * What the chart's colours can show, one record each. The page computes the kind of every stitch by
 * itself, so all but the strain follow the brush at once.
 *
 * @import {Palette} from "./palette.js"
 * @import {Studio} from "./studio.js"
 * @import {ColourMap} from "./colormaps.js"
 * @import {Direction, StitchKind} from "../types.js"
 *
 * @typedef {{table: Uint32Array}} KindColours pixel by ((purl · 16 + code) · 4 + quarter)
 * @typedef {{each: (index: number) => number}} StitchColours pixel of each stitch
 * @typedef {KindColours | StitchColours} Colouring
 *
 * @typedef {{kind: "swatches", items: {label: string, colour: string}[]}} SwatchLegend
 * @typedef {{kind: "scale", map: ColourMap, low: number, high: number, unit: string, log: boolean,
 *   label: string, limit?: number}} ScaleLegend `limit` has a line on the bar
 *
 * @typedef {object} Overlay
 * @property {string} id
 * @property {string} label
 * @property {string} short as its chip says it, beside its neighbours
 * @property {string} hint
 * @property {string} view name of the 3D view's colouring
 * @property {(studio: Studio) => boolean} available
 * @property {(studio: Studio, palette: Palette) => Colouring} colouring
 * @property {(studio: Studio, palette: Palette) => SwatchLegend | ScaleLegend} legend
 */

import { along } from "../core/directions.js";
import { FABRICS, QUARTERS } from "../grid/segments.js";
import { batlow, part, taut, vik } from "./colormaps.js";
import { pixel } from "./palette.js";

const always = () => true;

/** @param {[string, string][]} items label and colour @returns {SwatchLegend} */
export const swatches = (...items) => ({
  kind: "swatches",
  items: items.map(([label, colour]) => ({ label, colour })),
});

/**
 * @param {ColourMap} map
 * @param {readonly number[]} ends its lowest and highest value
 * @param {string} unit
 * @param {string} label
 * @returns {ScaleLegend}
 */
export const scale = (map, [low, high], unit, label, log = false) => ({
  kind: "scale",
  map,
  low,
  high,
  unit,
  label,
  log,
});

/** A purl is drawn a little darker where the colour itself does not carry a number. */
const PURL_SHADE = 0.8;

/** @param {(code: number, quarter: number, purl: number) => number} rule @returns {KindColours} */
function byKind(rule) {
  const table = new Uint32Array(128);
  for (let k = 0; k < 128; k++) table[k] = rule((k >> 2) & 15, k & 3, k >> 6);
  return { table };
}

/** @type {Overlay} */
const stitches = {
  id: "stitches",
  label: "Stitches",
  short: "Stitches",
  hint: "Knits and purls alone",
  view: "yarn",
  available: always,
  colouring: (_, { knit, purl }) => byKind((_code, _quarter, p) => pixel(p ? purl : knit)),
  legend: () => swatches(), // the key above the chart shows it
};

/** @type {Overlay} */
const fabrics = {
  id: "fabrics",
  label: "Fabrics",
  short: "Fabrics",
  hint: "Which of the four fabrics each quarter of a stitch behaves like",
  view: "yarn",
  available: always,
  colouring: (_, palette) =>
    byKind((code, quarter, p) => pixel(palette.fabrics[QUARTERS[code][quarter]], p ? PURL_SHADE : 1)),
  legend: (_, palette) => fabricKey(palette),
};

/** The colours of the four fabrics. @param {Palette} palette */
export function fabricKey(palette) {
  const colours = palette.fabrics.map(css);
  return swatches(...FABRICS.map((label, i) => /** @type {[string, string]} */ ([label, colours[i]])));
}

/** @type {Overlay} */
const segments = {
  id: "segments",
  label: "Segments",
  short: "Segments",
  hint: "Symmetry of the yarn between neighbours: even joins like stitches, odd unlike ones",
  view: "yarn",
  available: always,
  colouring: stitches.colouring,
  legend: (_, { even, odd }) => swatches(["even (K–K, P–P)", even], ["odd (K–P)", odd]),
};

/** @param {Direction} direction @param {string} label @returns {Overlay} */
function modulus(direction, label) {
  /** @param {StitchKind} kind */
  const value = (kind) => kind[`modulus_${direction}_n_per_mm`];
  /** @param {Studio} studio */
  const logarithms = (studio) => logScale(studio.kinds().map(value));
  return {
    id: `modulus-${direction}`,
    label,
    short: direction === "course" ? "Rows" : "Columns",
    hint: `Stiffness (Young's modulus) of each stitch ${along(direction)}, on a logarithmic scale`,
    view: direction,
    available: (studio) => studio.kinds().length === 16,
    colouring: (studio) => {
      const { at } = logarithms(studio);
      const pixels = studio.kinds().map((kind) => pixel(batlow.at(at(value(kind)))));
      return byKind((code) => pixels[code]);
    },
    legend: (studio) => {
      const { low, high } = logarithms(studio);
      return scale(batlow, [low, high], "N/mm", label, true);
    },
  };
}

/** How far a stitch is stiffer one way than the other. @type {Overlay} */
const anisotropy = {
  id: "anisotropy",
  label: "Ratio of the stiffnesses",
  short: "Ratio",
  hint: "Stiffness along the rows over stiffness along the columns of each stitch, on a logarithmic scale",
  view: "anisotropy",
  available: (studio) => studio.kinds().length === 16,
  colouring: (studio) => {
    const ratios = studio.kinds().map(ratio);
    const most = Math.max(...ratios.map(Math.abs)) || 1;
    const pixels = ratios.map((r) => pixel(vik.at(0.5 + (0.5 * r) / most)));
    return byKind((code) => pixels[code]);
  },
  legend: (studio) => {
    const most = Math.exp(Math.max(...studio.kinds().map((kind) => Math.abs(ratio(kind)))));
    return scale(vik, [1 / most, most], "", "Stiffness along rows over columns", true);
  },
};

/** @param {StitchKind} kind */
function ratio(kind) {
  return Math.log(kind.modulus_course_n_per_mm / kind.modulus_wale_n_per_mm);
}

/** Strain along the pull, on one signed scale for the whole test. @type {Overlay} */
const strain = {
  id: "strain",
  label: "Stretch of each stitch",
  short: "Stretch",
  hint: "Stretch of each stitch along the pull, at the step on the slider",
  view: "strain",
  available: (studio) => studio.field("strain") !== null,
  colouring: (studio) => {
    const values = studio.field("strain") ?? [];
    const most = studio.largestStrain() || 1;
    return { each: (i) => pixel(vik.at(0.5 + (0.5 * values[i]) / most)) };
  },
  legend: (studio) => {
    const { low, high } = studio.strainRange();
    const most = studio.largestStrain() || 1;
    /** @param {number} value */
    const place = (value) => 0.5 + (0.5 * value) / most;
    const map = part(vik, place(low), place(high));
    return scale(map, [100 * low, 100 * high], "%", `Stretch ${along(studio.stretchDirection())}`);
  },
};

/** @type {Overlay} */
const utilisation = {
  id: "utilisation",
  label: "Stretch used",
  short: "Used",
  hint: "How much of its stretch each stitch has used; red where it runs out of stretch",
  view: "utilisation",
  available: (studio) => studio.field("utilisation") !== null,
  colouring: (studio) => {
    const values = studio.field("utilisation") ?? [];
    return { each: (i) => pixel(taut.at(values[i])) };
  },
  legend: () => scale(taut, [0, 100], "%", "Stretch used, red where it runs out"),
};

/** @type {Overlay[]} */
export const OVERLAYS = [
  stitches,
  fabrics,
  segments,
  modulus("course", "Stiffness along rows"),
  modulus("wale", "Stiffness along columns"),
  anisotropy,
  strain,
  utilisation,
];

/** What is chosen, or the fabrics while there is no stretch test that it could show. @param {Studio} studio */
export const shownOverlay = (studio) => (studio.overlay.value.available(studio) ? studio.overlay.value : fabrics);

/** @param {number[]} values positive */
export function logScale(values) {
  const low = Math.min(...values);
  const high = Math.max(...values);
  const span = Math.log(high / low) || 1;
  return { low, high, at: /** @param {number} v */ (v) => Math.log(v / low) / span };
}

/** @param {number[]} rgb */
function css(rgb) {
  return `rgb(${rgb.join(" ")})`;
}

/** What of it fabric that nobody pulls can show: not how far it is pulled. @param {Overlay} overlay */
export const atRest = (overlay) => (overlay === strain || overlay === utilisation ? fabrics : overlay);
