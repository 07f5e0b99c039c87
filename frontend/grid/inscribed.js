/**
 * The largest rectangle of stitches that lies wholly inside an outline.
 *
 * Row by row, each column has a height: the stitches without a gap up to this row. The largest
 * rectangle that ends in the row is the largest one under these heights, found with a stack of
 * columns whose heights rise.
 *
 * @import {Box} from "./grid.js"
 */

/**
 * @param {Uint8Array} inside 1 where there is a stitch, row by row
 * @param {number} columns
 * @returns {Box | null} null if there is none
 */
export function largestRectangle(inside, columns) {
  const heights = new Uint32Array(columns);
  const stack = new Uint32Array(columns + 1);
  let most = 0;
  /** @type {Box | null} */
  let best = null;
  for (let first = 0, row = 0; first < inside.length; first += columns, row++) {
    let depth = 0;
    for (let column = 0; column <= columns; column++) {
      if (column < columns) heights[column] = inside[first + column] ? heights[column] + 1 : 0;
      const height = column < columns ? heights[column] : 0;
      while (depth && heights[stack[depth - 1]] >= height) {
        const tall = heights[stack[--depth]];
        const column0 = depth ? stack[depth - 1] + 1 : 0;
        if (tall * (column - column0) > most) {
          most = tall * (column - column0);
          best = { row0: row + 1 - tall, column0, row1: row + 1, column1: column };
        }
      }
      stack[depth++] = column;
    }
  }
  return best;
}
