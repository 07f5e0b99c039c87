/**
 * What the gallery offers; a test compares what it says of their stretch with our numbers. Charts are made here, from the repeat of a pattern; garments come from the
 * service, which fits them to measurements.
 *
 * @import {GarmentRequest} from "../../types.js"
 *
 * @typedef {object} Example
 * @property {string} id
 * @property {string} name
 * @property {string} note what there is to see
 * @property {() => string} chart K/P lines, top row first
 *
 * @typedef {object} GarmentExample
 * @property {string} id
 * @property {string} name
 * @property {string} note
 * @property {string} material
 * @property {GarmentRequest["garment"]} garment what the service is asked for
 */

import { exampleGrid } from "../../grid/example.js";
import { Grid } from "../../grid/grid.js";

/** @param {string} motif rows from the top, separated by / @param {number} rows @param {number} columns */
const tiled = (motif, rows, columns) => () => Grid.fromText(motif.replaceAll("/", "\n")).tiled(rows, columns).text;

const DIAMONDS = "KKKKPKKK/KKKPKPKK/KKPKKKPK/KPKKKKKP/PKKKKKKK/KPKKKKKP/KKPKKKPK/KKKPKPKK";

/** @type {Example[]} */
export const EXAMPLES = /** @type {[string, string, string, () => string][]} */ ([
  ["stockinette", "Stockinette", "Of these four, gives least lengthwise.", tiled("K", 24, 30)],
  ["garter", "Garter", "Gives more than twice as far lengthwise as stockinette.", tiled("P/K", 24, 30)],
  ["rib", "1×1 rib", "Of these four, gives most across.", tiled("KP", 24, 30)],
  ["seed", "Seed", "Like garter, gives more than twice as far lengthwise as stockinette.", tiled("KP/PK", 24, 30)],
  ["rib-2-2", "2×2 rib", "Two knit and two purl columns in turn.", tiled("KKPP", 24, 32)],
  [
    "basket",
    "Basket",
    "Squares of knits and purls in turn.",
    tiled("PPPPKKKK/PPPPKKKK/PPPPKKKK/PPPPKKKK/KKKKPPPP/KKKKPPPP/KKKKPPPP/KKKKPPPP", 24, 32),
  ],
  ["moss", "Moss", "Seed, with each row knitted twice.", tiled("PK/PK/KP/KP", 24, 30)],
  ["diamonds", "Diamonds", "Lines of purls on stockinette.", tiled(DIAMONDS, 24, 32)],
  ["sampler", "Cuff with a panel", "All four fabrics in one swatch: pull it and see.", () => exampleGrid().text],
]).map(([id, name, note, chart]) => ({ id, name, note, chart }));

/** @type {GarmentExample[]} */
export const GARMENTS = [
  {
    id: "wrist-brace",
    name: "Wrist brace",
    note: "Supports the wrist; knitted sideways.",
    material: "glove-wool",
    garment: { template: "wrist-brace", wrist_mm: 170, length_mm: 80 },
  },
  {
    id: "glove",
    name: "Therapeutic glove",
    note: "Supports the wrist, lets fingers and thumb bend.",
    material: "glove-wool",
    garment: { template: "glove" },
  },
];
