/**
 * Patterns of one's own: those of the design travel with it, and this browser remembers all that it
 * has seen.
 *
 * @import {ShelfItem} from "./design.js"
 */

import { Ink } from "./ink.js";
import { motifGrid } from "../grid/grid.js";

/**
 * Both lists, each motif once; the design's names count.
 *
 * @param {readonly ShelfItem[]} design
 * @param {readonly ShelfItem[]} browser
 * @returns {ShelfItem[]}
 */
export function ownPatterns(design, browser) {
  const known = new Set(design.map(({ motif }) => motif));
  return [...design, ...browser.filter(({ motif }) => !known.has(motif))];
}

/** @param {ShelfItem} item */
export function ownInk({ name, motif }) {
  let hash = 7;
  for (let k = 0; k < motif.length; k++) hash = (Math.imul(hash, 31) + motif.charCodeAt(k)) >>> 0;
  return new Ink(`own-${hash.toString(36)}`, name, motifGrid(motif), "A pattern of your own");
}
