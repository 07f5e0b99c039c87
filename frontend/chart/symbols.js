/**
 * The symbols of stitches that are neither knit nor purl. The library draws them; they are loaded when the
 * first is needed.
 *
 * @import {Symbols} from "../state/editing.js"
 *
 * @typedef {{strokes: [x: number, y: number][][], dots: [x: number, y: number][]}} Sign in cells, y up from the foot
 */

import { Signal } from "../core/signal.js";

/** The style before it has what a style lacks. @type {Symbols[]} */
const STYLES = ["japanese", "dashes", "dots"];

/** Whether they are there. */
export const signsLoaded = new Signal(false);
/** @type {Promise<void> | null} */
let loading = null;
/** @type {Record<string, Record<string, string>>} */
let written = {};
/** @type {Record<string, [name: string, words: string, deed: string]>} */
let names = {};
/** @type {Map<string, Sign>} */
const known = new Map();

/** @returns {Promise<void>} when they and the names are there */
export function loadSigns() {
  loading ??= Promise.all([import("./signs.js"), import("../grid/names.js")]).then(([{ SIGNS }, { NAMES }]) => {
    written = SIGNS;
    names = NAMES;
    signsLoaded.value = true;
  });
  return loading.catch(() => void (loading = null)); // away for now: tried again with the next one
}

/** A stitch in words; "" before they are loaded. @param {string} code */
export function inWords(code) {
  if (!names[code]) return "";
  const [name, abbreviation, deed] = names[code];
  return `${name} (${abbreviation}): ${deed}`;
}

/** The symbol of a stitch; an empty one before they are loaded. @param {string} code @param {Symbols} style @returns {Sign} */
export function signOf(code, style) {
  const key = `${style} ${code}`;
  let sign = known.get(key);
  if (!sign && signsLoaded.value) {
    const from = STYLES.slice(STYLES.indexOf(style));
    const [strokes, dots] = (from.map((each) => written[each][code]).find((text) => text !== undefined) ?? "|").split(
      "|",
    );
    sign = { strokes: parts(strokes).map((stroke) => stroke.split(" ").map(point)), dots: parts(dots).map(point) };
    known.set(key, sign);
  }
  return sign ?? { strokes: [], dots: [] };
}

/** @param {string} text */
const parts = (text) => text.split(";").filter(Boolean);

/** @param {string} text @returns {[number, number]} */
function point(text) {
  const [x, y] = text.split(",");
  return [Number(x) / 100, Number(y) / 100];
}

/**
 * Add a symbol to paths.
 *
 * @param {{stroke: Path2D, fill: Path2D}} paths
 * @param {Sign} sign
 * @param {number} x left edge of its box
 * @param {number} y upper edge
 * @param {number} w of a cell
 * @param {number} h
 */
export function addSign({ stroke, fill }, { strokes, dots }, x, y, w, h) {
  for (const points of strokes) {
    points.forEach(([px, py], k) => {
      if (k) stroke.lineTo(x + px * w, y + (1 - py) * h);
      else stroke.moveTo(x + px * w, y + (1 - py) * h);
    });
  }
  const radius = Math.min(w, h) * 0.11;
  for (const [px, py] of dots) {
    fill.moveTo(x + px * w + radius, y + (1 - py) * h);
    fill.arc(x + px * w, y + (1 - py) * h, radius, 0, 2 * Math.PI);
  }
}
