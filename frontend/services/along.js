/**
 * The rows of a piece for whoever knits it, and where they are in it.
 *
 * @import {Studio} from "../state/studio.js"
 * @import {KnitAlongRequest, KnitAlongResult} from "../types.js"
 */

import { ApiError, api } from "../api.js";
import { loadRows, saveRows } from "../design/store.js";

/** Home machines, by their names for the service. @type {Record<string, string>} */
export const HOME_MACHINES = {
  brother: "Brother, one bed",
  "brother-ribber": "Brother with ribber",
  "silver-reed": "Silver Reed, one bed",
  "silver-reed-ribber": "Silver Reed with ribber",
  ayab: "Brother with AYAB",
};

/** How a piece is knitted. @type {Record<string, string>} */
export const WAYS = { flat: "By hand, flat", round: "By hand, in the round", ...HOME_MACHINES };

/** @param {Pick<Studio, "document">} studio @param {string} way @returns {KnitAlongRequest} */
export function alongRequest({ document: chart }, way) {
  const { chart: text, outline, regions, repeats, shelf } = chart.content;
  const machine = way in HOME_MACHINES ? way : null;
  const construction = way === "round" ? "round" : "flat";
  return { chart: text, outline, regions, repeats, shelf, machine, construction };
}

/**
 * The rows; where the service is away, those that were seen of this very piece before.
 *
 * @param {KnitAlongRequest} request
 * @returns {Promise<KnitAlongResult>}
 */
export async function alongRows(request) {
  const key = JSON.stringify(request);
  try {
    const rows = await api.run("knit-along", request);
    saveRows(key, rows);
    return rows;
  } catch (error) {
    const kept = error instanceof ApiError && error.offline ? loadRows(key) : null;
    if (!kept) throw error;
    return /** @type {KnitAlongResult} */ (kept);
  }
}

/**
 * Which repeat of the pattern a row is in; "" where there is only one.
 *
 * @param {number} row from 1
 * @param {number} rows
 * @param {number} period rows of the repeat
 */
export function repeatWords(row, rows, period) {
  if (period >= rows || period < 2) return "";
  const times = Math.ceil(rows / period);
  return `Repeat ${Math.ceil(row / period)} of ${times}, row ${((row - 1) % period) + 1} of ${period}`;
}

/** A step that a key asks for: to the next row, to the one before, to the first or to the last. @param {string} key */
export const stepOf = (key) =>
  ({
    ArrowRight: 1,
    PageDown: 1,
    " ": 1,
    Enter: 1,
    ArrowLeft: -1,
    PageUp: -1,
    Backspace: -1,
    Home: -Infinity,
    End: Infinity,
  })[key] ?? 0;
