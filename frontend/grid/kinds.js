/**
 * What the stitches are that are neither knit nor purl: read from the library's own list, so that a
 * stitch which is added there is here, too.
 *
 * @typedef {object} Kind
 * @property {string} code
 * @property {string} group
 * @property {number} width columns that it stands over
 * @property {number} takes loops of the row below
 * @property {string} shown K or P of each column; H holds the stitch below and looks like that
 */

import { GROUPS, STITCHES } from "./stitches.js";

const ROWS = STITCHES.split(" ").map((text) => text.split("~"));
const ALL = ROWS.map(([code, shown, takes, , , group]) => ({
  code,
  group: GROUPS[Number(group)],
  width: shown.length,
  takes: takes ? Number(takes) : shown.length,
  shown,
}));
const PLACES = new Map(ALL.map(({ code }, place) => [code, place]));

/** Every stitch but knit and purl. @type {readonly Kind[]} */
export const KINDS = ALL.slice(2);

/** Groups of the palette. */
export const KIND_GROUPS = GROUPS.slice(1);

const CODE = /\[[^\]\s]*\]|[^\s,]/g;
const KNITS = new Set("K|");
const PURLS = new Set("P-–•");

/** @param {string} code one of the list */
const placeOf = (code) => /** @type {number} */ (PLACES.get(code));

/** @param {string} code of the list, neither K nor P @returns {Kind} */
export const kindOf = (code) => ALL[placeOf(code)];

/** Whether a stitch of this code is neither knit nor purl. @param {string} code */
export const isOther = (code) => (PLACES.get(code) ?? 0) > 1;

/** The stitch that a field of the list leads to. @param {string} code @param {3 | 4} field */
const image = (code, field) => ALL[placeOf(code) + Number(ROWS[placeOf(code)][field])].code;

/** @param {string} code */
const mirrored = (code) => image(code, 3);

/** @param {string} code seen from the face @returns {string} the same from the back */
const turnedOver = (code) => image(code, 4);

/** What a stitch becomes where its chart is changed. @type {Record<string, (code: string) => string>} */
export const IMAGES = {
  mirrored,
  flipped: (code) => code,
  rotated: mirrored,
  turnedOver,
  swapped: (code) => mirrored(turnedOver(code)),
};

/** The stitches in some codes. @param {string} codes @returns {string[]} */
export const codesIn = (codes) => codes.match(CODE) ?? [];

/**
 * A chart of any stitches, such as "KO/K;KKKK": its knits and purls, and the others by their place.
 *
 * @param {string} text rows from the top, in lines or between ;
 * @returns {{chart: string, others: [row: number, column: number, code: string][]} | null} null if it is none
 */
export function readCodes(text) {
  const lines = text.split(/[\n;]/).filter((line) => line.trim());
  /** @type {[number, number, string][]} */
  const others = [];
  /** @type {string[][]} */
  const rows = [];
  for (const line of lines.reverse()) {
    /** @type {string[]} */
    const cells = [];
    for (const code of codesIn(line)) {
      if (KNITS.has(code)) cells.push("K");
      else if (PURLS.has(code)) cells.push("P");
      else if (isOther(code)) {
        others.push([rows.length, cells.length, code]);
        for (const shown of kindOf(code).shown)
          cells.push(shown === "H" ? (rows.at(-1)?.[cells.length] ?? "K") : shown);
      } else return null;
    }
    if (rows.length && cells.length !== rows[0].length) return null;
    rows.push(cells);
  }
  if (!rows.length) return null;
  const chart = rows
    .map((cells) => cells.join(""))
    .reverse()
    .join("\n");
  return { chart, others };
}
