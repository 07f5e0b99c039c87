/**
 * What the browser keeps: the design and the page's settings. Written after every step, so a reload,
 * a crash of the service or a failed request loses nothing.
 *
 * @import {GaugeInput} from "../types.js"
 * @import {Content, ShelfItem} from "./design.js"
 *
 * @typedef {{id: string, name: string, material: string, note?: string, machine?: string | null,
 *   remote?: {id: string, revision: number} | null} & Content} Design
 */

import { readContent, salvageContent } from "./design.js";
import { History } from "./history.js";

const DESIGN = "knitcore.design";
const HISTORY = "knitcore.history";
const SHELF = "knitcore.shelf";
const GAUGES = "knitcore.gauges";
const PLACES = "knitcore.places";
const ROWS = "knitcore.rows";
const SETTINGS = "knitcore.settings";
const HISTORY_LIMIT = 1_000_000;
/** Characters of all gauges, whose cloths are charts. */
const GAUGES_LIMIT = 200_000;
/** Pieces of which the row at hand is kept, and characters of the rows of the last one. */
const PLACES_LIMIT = 100;
const ROWS_LIMIT = 1_500_000;

/**
 * What is read of an entry; where there is none, it is damaged, or storage is closed to us, something else.
 *
 * @template T
 * @param {string} key
 * @param {(text: string | null) => T} read
 * @param {T} fallback
 */
function stored(key, read, fallback) {
  try {
    return read(localStorage.getItem(key));
  } catch {
    return fallback;
  }
}

/** Put entries into storage, which a private window may refuse. @param {...[key: string, text: string]} entries @returns {boolean} whether they are kept */
function put(...entries) {
  try {
    for (const [key, text] of entries) localStorage.setItem(key, text);
    return true;
  } catch {
    return false;
  }
}

/** @param {string | null} text @returns {Design | null} */
function readDesign(text) {
  const design = JSON.parse(text ?? "null");
  const content = design && typeof design.id === "string" ? salvageContent(design) : null;
  return content && { ...design, ...content };
}

export const loadDesign = () => stored(DESIGN, readDesign, null);

export const loadHistory = () => stored(HISTORY, History.parse, new History());

/** @param {Design} design @param {History} history @returns {boolean} whether it is kept */
export const saveDesign = (design, history) =>
  put([DESIGN, JSON.stringify(design)], [HISTORY, history.serialised(HISTORY_LIMIT)]);

/** Forget the design, its history, own patterns and gauges: somebody else may use this browser next. */
export function forgetDesign() {
  for (const key of [DESIGN, HISTORY, SHELF, GAUGES, PLACES, ROWS]) localStorage.removeItem(key);
}

/** @template {object} T @param {T} defaults @returns {T} */
export const loadSettings = (defaults) =>
  stored(SETTINGS, (text) => ({ ...defaults, ...JSON.parse(text ?? "{}") }), defaults);

/** Those that cannot be kept last as long as the page. @param {object} settings changes to keep */
export const saveSettings = (settings) => put([SETTINGS, JSON.stringify({ ...loadSettings({}), ...settings })]);

/** @returns {ShelfItem[]} the user's own patterns, from all designs; each design has its own, too */
export const loadShelf = () =>
  stored(SHELF, (text) => readContent({ chart: "K", shelf: JSON.parse(text ?? "[]") }).shelf, []);

/** @param {readonly ShelfItem[]} shelf */
export const saveShelf = (shelf) => put([SHELF, JSON.stringify(shelf)]);

/** @returns {[cloth: string, gauge: GaugeInput][]} the last one last */
export const loadGauges = () =>
  stored(GAUGES, (text) => JSON.parse(text ?? "[]").filter((/** @type {unknown} */ entry) => Array.isArray(entry)), []);

/** Those that were counted first are left out where there are too many. @param {[cloth: string, gauge: GaugeInput][]} gauges */
export function saveGauges(gauges) {
  let room = GAUGES_LIMIT;
  const latest = gauges.toReversed().filter(([cloth]) => (room -= cloth.length) >= 0);
  put([GAUGES, JSON.stringify(latest.reverse())]);
}

/**
 * Where somebody is in knitting a piece: the row at hand, 0 before the first, a count of their own, and whether the
 * service has not heard of it yet.
 *
 * @typedef {{row: number, count: number, unsent?: boolean}} KnittingPlace
 */

/** @returns {[piece: string, place: KnittingPlace][]} the last one last */
const loadPlaces = () => stored(PLACES, (text) => JSON.parse(text ?? "[]"), []);

/** @param {string} piece a design and a way to knit it @returns {KnittingPlace} */
export const loadPlace = (piece) => ({ row: 0, count: 0, ...new Map(loadPlaces()).get(piece) });

/** @param {string} piece @param {KnittingPlace} place @returns {boolean} whether it is kept */
export function savePlace(piece, place) {
  const others = loadPlaces().filter(([name]) => name !== piece);
  return put([PLACES, JSON.stringify([...others, [piece, place]].slice(-PLACES_LIMIT))]);
}

/** What was kept of a request, for when the service is away. @param {string} request @returns {unknown} */
export const loadRows = (request) =>
  stored(
    ROWS,
    (text) => {
      const [kept, rows] = JSON.parse(text ?? "[]");
      return kept === request ? rows : null;
    },
    null,
  );

/** @param {string} request @param {unknown} rows */
export function saveRows(request, rows) {
  const text = JSON.stringify([request, rows]);
  if (text.length <= ROWS_LIMIT) put([ROWS, text]);
}

/** A random UUID, also where the page is not served over a secure origin. */
export function newIdentifier() {
  if (crypto.randomUUID) return crypto.randomUUID();
  const bytes = crypto.getRandomValues(new Uint8Array(16));
  bytes[6] = (bytes[6] & 15) | 64;
  bytes[8] = (bytes[8] & 63) | 128;
  const hex = [...bytes].map((b) => b.toString(16).padStart(2, "0")).join("");
  return [8, 12, 16, 20].reduceRight((s, at) => `${s.slice(0, at)}-${s.slice(at)}`, hex);
}
