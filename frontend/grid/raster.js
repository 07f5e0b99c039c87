/**
 * Stitches of the tools' shapes, as spans of rows; pure functions. Shapes may reach beyond the chart.
 *
 * @import {Grid} from "./grid.js"
 * @typedef {[row: number, column: number]} Cell
 * @typedef {[row: number, from: number, to: number]} Span columns from `from` up to before `to`
 */

/** Line between two stitches (Bresenham), both included. @param {Cell} from @param {Cell} to @returns {Cell[]} */
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

/** Filled rectangle between two corners. @param {Cell} a @param {Cell} b @returns {Span[]} */
export function rectangle(a, b) {
  const bottom = Math.min(a[0], b[0]);
  const [from, to] = [Math.min(a[1], b[1]), Math.max(a[1], b[1]) + 1];
  return Array.from({ length: Math.abs(a[0] - b[0]) + 1 }, (_, k) => [bottom + k, from, to]);
}

/** Filled ellipse within two corners. @param {Cell} a @param {Cell} b @returns {Span[]} */
export function ellipse(a, b) {
  const middleRow = (a[0] + b[0]) / 2;
  const middle = (a[1] + b[1]) / 2;
  const high = (Math.abs(a[0] - b[0]) + 1) / 2;
  const wide = (Math.abs(a[1] - b[1]) + 1) / 2;
  return rectangle(a, b).map(([row]) => {
    const half = wide * Math.sqrt(Math.max(0, 1 - ((row - middleRow) / high) ** 2));
    return [row, Math.ceil(middle - half - 1e-9), Math.floor(middle + half + 1e-9) + 1];
  });
}

/** Square brushes of a size along a path. @param {Cell[]} path @param {number} size @returns {Span[]} */
export function thick(path, size) {
  const before = Math.floor((size - 1) / 2);
  return path.flatMap(([row, column]) =>
    rectangle([row - before, column - before], [row - before + size - 1, column - before + size - 1]),
  );
}

/**
 * The connected stitches that have the value of the first one.
 *
 * @param {Grid} grid
 * @param {Uint8Array} values one for each stitch
 * @param {Cell} start
 * @returns {Span[]}
 */
export function flood({ rows, columns }, values, [row, column]) {
  const startValue = values[row * columns + column];
  const seen = new Uint8Array(values.length);
  /** @param {number} i */
  const free = (i) => !seen[i] && values[i] === startValue;
  /** @type {Span[]} */
  const spans = [];
  /** @type {Cell[]} */
  const seeds = [[row, column]];
  for (let seed = seeds.pop(); seed; seed = seeds.pop()) {
    const base = seed[0] * columns;
    if (!free(base + seed[1])) continue;
    let from = seed[1];
    let to = from + 1;
    while (from > 0 && free(base + from - 1)) from--;
    while (to < columns && free(base + to)) to++;
    seen.fill(1, base + from, base + to);
    spans.push([seed[0], from, to]);
    for (const next of [seed[0] - 1, seed[0] + 1]) {
      if (next < 0 || next >= rows) continue;
      for (let c = from; c < to; c++) {
        const first = c === from || !free(next * columns + c - 1);
        if (first && free(next * columns + c)) seeds.push([next, c]);
      }
    }
  }
  return spans;
}

/**
 * What a closed line around stitches encloses, its own stitches included.
 *
 * @param {Cell[]} path corners
 * @returns {Span[]}
 */
export function enclosed(path) {
  /** @type {Span[]} */
  const spans = [];
  const rows = path.map(([row]) => row);
  for (let row = rows.reduce((a, b) => Math.min(a, b)); row <= rows.reduce((a, b) => Math.max(a, b)); row++) {
    /** Where the line crosses the middle of the row, just above it. @type {number[]} */
    const crossings = [];
    path.forEach(([r1, c1], k) => {
      const [r2, c2] = path[(k + 1) % path.length];
      const at = row + 1e-6;
      if (r1 > at !== r2 > at) crossings.push(c1 + ((at - r1) / (r2 - r1)) * (c2 - c1));
    });
    crossings.sort((a, b) => a - b);
    for (let k = 0; k + 1 < crossings.length; k += 2) {
      spans.push([row, Math.ceil(crossings[k] - 1e-3), Math.floor(crossings[k + 1] + 1e-3) + 1]);
    }
  }
  path.forEach((cell, k) => {
    for (const [row, column] of line(cell, path[(k + 1) % path.length])) spans.push([row, column, column + 1]);
  });
  return spans;
}
