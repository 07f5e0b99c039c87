/**
 * What the browser keeps: the design and the page's settings. Written after every step, so a reload,
 * a crash of the service or a failed request loses nothing.
 *
 * @import {Content, ShelfItem} from "./design.js"
 *
 * @typedef {{id: string, name: string, material: string, note?: string,
 *   remote?: {id: string, revision: number} | null} & Content} Design
 */

import { readContent, salvageContent } from "./design.js";
import { History } from "./history.js";

const DESIGN = "knitcore.design";
const HISTORY = "knitcore.history";
const SHELF = "knitcore.shelf";
const SETTINGS = "knitcore.settings";
const HISTORY_LIMIT = 1_000_000;

/** @returns {Design | null} */
export function loadDesign() {
  try {
    const design = JSON.parse(localStorage.getItem(DESIGN) ?? "null");
    const content = design && typeof design.id === "string" ? salvageContent(design) : null;
    return content && { ...design, ...content };
  } catch {
    return null; // nothing stored, or storage is not accessible
  }
}

/** @returns {History} */
export function loadHistory() {
  try {
    return History.parse(localStorage.getItem(HISTORY));
  } catch {
    return new History();
  }
}

/** @param {Design} design @param {History} history @returns {boolean} whether it is kept */
export function saveDesign(design, history) {
  try {
    localStorage.setItem(DESIGN, JSON.stringify(design));
    localStorage.setItem(HISTORY, history.serialised(HISTORY_LIMIT));
    return true;
  } catch {
    return false;
  }
}

/** Forget the design, its history and the own patterns: somebody else may use this browser next. */
export function forgetDesign() {
  for (const key of [DESIGN, HISTORY, SHELF]) localStorage.removeItem(key);
}

/** @template {object} T @param {T} defaults @returns {T} */
export function loadSettings(defaults) {
  try {
    return { ...defaults, ...JSON.parse(localStorage.getItem(SETTINGS) ?? "{}") };
  } catch {
    return defaults;
  }
}

/** @param {object} settings changes to keep */
export function saveSettings(settings) {
  try {
    localStorage.setItem(SETTINGS, JSON.stringify({ ...loadSettings({}), ...settings }));
  } catch {
    // A private window may refuse; the settings then last as long as the page.
  }
}

/** @returns {ShelfItem[]} the user's own patterns, from all designs */
export function loadShelf() {
  try {
    return readContent({ chart: "K", shelf: JSON.parse(localStorage.getItem(SHELF) ?? "[]") }).shelf;
  } catch {
    return []; // nothing stored, or damaged: designs have their own patterns
  }
}

/** @param {readonly ShelfItem[]} shelf */
export function saveShelf(shelf) {
  try {
    localStorage.setItem(SHELF, JSON.stringify(shelf));
  } catch {
    // A private window may refuse; the design keeps its patterns all the same.
  }
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
