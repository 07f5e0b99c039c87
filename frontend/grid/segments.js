/**
 * Even and odd segments, and the 16 kinds of stitch they make.
 *
 * A segment between two neighbours is odd if one is a knit and the other a purl. The four segments
 * around a stitch are all that the composite knows of it; a segment that would cross an edge takes
 * the parity of the one on the opposite side. The same definition as in the Python library.
 *
 * @import {Box, Grid} from "./grid.js"
 * @import {Direction, Fabric, SegmentCountsResult} from "../types.js"
 */

const LEFT = 1;
const RIGHT = 2;
const BELOW = 4;
const ABOVE = 8;

/** Fabrics by phase: 2 × course-wise odd + wale-wise odd. @type {Fabric[]} */
export const FABRICS = ["stockinette", "garter", "rib", "seed"];

/** Phases of the quarters of each code: below left, below right, above left, above right. */
export const QUARTERS = Array.from({ length: 16 }, (_, code) => {
  const left = code & LEFT ? 2 : 0;
  const right = code & RIGHT ? 2 : 0;
  const below = code & BELOW ? 1 : 0;
  const above = code & ABOVE ? 1 : 0;
  return [left + below, right + below, left + above, right + above];
});

/**
 * Write the codes of the stitches in a box.
 *
 * @param {Grid} grid
 * @param {Uint8Array} codes one for each stitch
 * @param {Box} [box]
 * @param {Uint8Array | null} [outline] 0 where there is no stitch: an edge, too
 */
export function updateSurroundings(grid, codes, box = grid.box, outline = null) {
  const { rows, columns, purl } = grid;
  for (let row = box.row0; row < box.row1; row++) {
    for (let column = box.column0; column < box.column1; column++) {
      const i = row * columns + column;
      const own = purl[i];
      const right = column + 1 < columns && outline?.[i + 1] !== 0 ? purl[i + 1] ^ own : -1;
      const left = column > 0 && outline?.[i - 1] !== 0 ? purl[i - 1] ^ own : Math.max(right, 0);
      const above = row + 1 < rows && outline?.[i + columns] !== 0 ? purl[i + columns] ^ own : -1;
      const below = row > 0 && outline?.[i - columns] !== 0 ? purl[i - columns] ^ own : Math.max(above, 0);
      codes[i] = left * LEFT + (right < 0 ? left : right) * RIGHT + below * BELOW + (above < 0 ? below : above) * ABOVE;
    }
  }
}

/** @param {Grid} grid @param {Uint8Array | null} [outline] @returns {Uint8Array} */
export function surroundings(grid, outline = null) {
  const codes = new Uint8Array(grid.purl.length);
  updateSurroundings(grid, codes, grid.box, outline);
  return codes;
}

/**
 * @param {Grid} grid
 * @param {Uint8Array | null} [outline] 0 where there is no stitch
 * @returns {Record<Direction, SegmentCountsResult>}
 */
export function countSegments({ rows, columns, purl }, outline = null) {
  /** @param {Direction} direction @returns {SegmentCountsResult} */
  const count = (direction) => {
    const step = direction === "course" ? 1 : columns;
    let all = 0;
    let odd = 0;
    for (let row = direction === "course" ? 0 : 1; row < rows; row++) {
      const end = (row + 1) * columns;
      for (let i = end - columns + (direction === "course" ? 1 : 0); i < end; i++) {
        const there = outline ? outline[i] & outline[i - step] : 1;
        all += there;
        odd += there & (purl[i] ^ purl[i - step]);
      }
    }
    return { even: all - odd, odd };
  };
  return { course: count("course"), wale: count("wale") };
}

/**
 * Shares of the four fabrics, by quarters.
 *
 * @param {Uint8Array} codes
 * @param {Uint8Array | null} [outline] 0 where there is no stitch
 * @returns {number[]} by phase, summing to 1
 */
export function fabricShares(codes, outline = null) {
  const kinds = new Uint32Array(16);
  let all = 0;
  for (let i = 0; i < codes.length; i++) {
    if (outline && !outline[i]) continue;
    kinds[codes[i]]++;
    all++;
  }
  const shares = [0, 0, 0, 0];
  kinds.forEach((count, code) => {
    for (const phase of QUARTERS[code]) shares[phase] += count / (4 * all);
  });
  return shares;
}
