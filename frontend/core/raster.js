/**
 * Stitches of the drawing tools' shapes; pure functions.
 *
 * @import {Grid} from "./grid.js"
 * @typedef {[row: number, column: number]} Cell
 */

/**
 * Line between two stitches (Bresenham), both included.
 *
 * @param {Cell} from
 * @param {Cell} to
 * @returns {Cell[]}
 */
export function line([row, column], [toRow, toColumn]) {
  /** @type {Cell[]} */
  const cells = [];
  const down = Math.abs(toRow - row);
  const across = Math.abs(toColumn - column);
  const stepRow = Math.sign(toRow - row);
  const stepColumn = Math.sign(toColumn - column);
  let error = across - down;
  for (;;) {
    cells.push([row, column]);
    if (row === toRow && column === toColumn) return cells;
    const twice = 2 * error;
    if (twice > -down) {
      error -= down;
      column += stepColumn;
    }
    if (twice < across) {
      error += across;
      row += stepRow;
    }
  }
}

/**
 * Filled rectangle between two corners.
 *
 * @param {Cell} a
 * @param {Cell} b
 * @returns {Cell[]}
 */
export function rectangle(a, b) {
  /** @type {Cell[]} */
  const cells = [];
  for (let row = Math.min(a[0], b[0]); row <= Math.max(a[0], b[0]); row++) {
    for (let column = Math.min(a[1], b[1]); column <= Math.max(a[1], b[1]); column++) {
      cells.push([row, column]);
    }
  }
  return cells;
}

/**
 * Filled ellipse within two corners.
 *
 * @param {Cell} a
 * @param {Cell} b
 * @returns {Cell[]}
 */
export function ellipse(a, b) {
  const middleRow = (a[0] + b[0]) / 2;
  const middleColumn = (a[1] + b[1]) / 2;
  const high = (Math.abs(a[0] - b[0]) + 1) / 2;
  const wide = (Math.abs(a[1] - b[1]) + 1) / 2;
  return rectangle(a, b).filter(
    ([row, column]) => ((row - middleRow) / high) ** 2 + ((column - middleColumn) / wide) ** 2 <= 1,
  );
}

/**
 * Square brushes of a size along a path.
 *
 * @param {Cell[]} path
 * @param {number} size
 * @returns {Cell[]}
 */
export function thick(path, size) {
  if (size === 1) return path;
  const before = Math.floor((size - 1) / 2);
  return path.flatMap(([row, column]) =>
    rectangle(
      [row - before, column - before],
      [row - before + size - 1, column - before + size - 1],
    ),
  );
}

/**
 * Connected stitches with the value of the first one.
 *
 * @param {Grid} grid
 * @param {Uint8Array} values one for each stitch
 * @param {Cell} start
 * @returns {Cell[]}
 */
export function flood({ rows, columns }, values, [row, column]) {
  const first = row * columns + column;
  const wanted = values[first];
  const seen = new Uint8Array(values.length);
  seen[first] = 1;
  const queue = [first];
  for (let k = 0; k < queue.length; k++) {
    const i = queue[k];
    const x = i % columns;
    const y = (i - x) / columns;
    for (const [next, inside] of /** @type {[number, boolean][]} */ ([
      [i - 1, x > 0],
      [i + 1, x + 1 < columns],
      [i - columns, y > 0],
      [i + columns, y + 1 < rows],
    ])) {
      if (inside && !seen[next] && values[next] === wanted) {
        seen[next] = 1;
        queue.push(next);
      }
    }
  }
  return queue.map((i) => [Math.floor(i / columns), i % columns]);
}
