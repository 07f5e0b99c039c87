/**
 * Bitmaps (a 0 or 1 for every stitch) written briefly.
 *
 * @import {Box} from "./grid.js"
 */

/** @param {Uint8Array} bytes */
export function base64(bytes) {
  let text = "";
  for (let k = 0; k < bytes.length; k += 4096) text += String.fromCharCode(...bytes.subarray(k, k + 4096));
  return btoa(text);
}

/** A bitmap as base64, eight stitches a byte. @param {Uint8Array} bitmap */
export function pack(bitmap) {
  const bytes = new Uint8Array(Math.ceil(bitmap.length / 8));
  for (let i = 0; i < bitmap.length; i++) if (bitmap[i]) bytes[i >> 3] |= 1 << (i & 7);
  return base64(bytes);
}

/** @param {string} text of {@link pack} @param {number} length */
export function unpack(text, length) {
  const bytes = atob(text);
  return Uint8Array.from({ length }, (_, i) => (bytes.charCodeAt(i >> 3) >> (i & 7)) & 1);
}

/**
 * The ones of a bitmap as [start, length, start, length, …].
 *
 * @param {Uint8Array} bitmap
 * @param {number} [from]
 * @param {number} [to]
 * @returns {number[]}
 */
export function toRuns(bitmap, from = 0, to = bitmap.length) {
  /** @type {number[]} */
  const runs = [];
  for (let i = from; i < to; i++) {
    if (!bitmap[i]) continue;
    const start = i;
    while (i < to && bitmap[i]) i++;
    runs.push(start, i - start);
  }
  return runs;
}

/** Flip the stitches of runs. @param {Uint8Array} bitmap @param {number[]} runs */
export function flip(bitmap, runs) {
  for (let k = 0; k < runs.length; k += 2) {
    for (let i = runs[k]; i < runs[k] + runs[k + 1]; i++) bitmap[i] ^= 1;
  }
}

/** The rows and columns that runs lie in. @param {number[]} runs not empty @param {number} columns @returns {Box} */
export function boxOfRuns(runs, columns) {
  const box = { row0: Infinity, column0: Infinity, row1: 0, column1: 0 };
  for (let k = 0; k < runs.length; k += 2) {
    const last = runs[k] + runs[k + 1] - 1;
    const row = Math.floor(runs[k] / columns);
    const lastRow = Math.floor(last / columns);
    box.row0 = Math.min(box.row0, row);
    box.row1 = Math.max(box.row1, lastRow + 1);
    box.column0 = Math.min(box.column0, lastRow > row ? 0 : runs[k] % columns);
    box.column1 = Math.max(box.column1, lastRow > row ? columns : (last % columns) + 1);
  }
  return box;
}

/**
 * Runs within rows, as the design document has them: [row, column, length].
 *
 * @param {Uint8Array} bitmap
 * @param {number} columns
 * @returns {[number, number, number][]}
 */
export function rowRuns(bitmap, columns) {
  /** @type {[number, number, number][]} */
  const result = [];
  for (let row = 0, start = 0; start < bitmap.length; row++, start += columns) {
    const runs = toRuns(bitmap, start, start + columns);
    for (let k = 0; k < runs.length; k += 2) result.push([row, runs[k] - start, runs[k + 1]]);
  }
  return result;
}
