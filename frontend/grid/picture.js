/** A picture of a chart read as stitches; pure functions on its grey values, top row first. */

import { Grid, MAX_SIDE } from "./grid.js";

/**
 * Grey values of a picture on white paper.
 *
 * @param {{data: Uint8ClampedArray | Uint8Array, width: number, height: number}} image red, green, blue, alpha
 */
export function greys({ data, width, height }) {
  const values = new Uint8Array(width * height);
  for (let i = 0, k = 0; i < values.length; i++, k += 4) {
    const grey = 0.299 * data[k] + 0.587 * data[k + 1] + 0.114 * data[k + 2];
    const alpha = data[k + 3] / 255;
    values[i] = Math.round(grey * alpha + 255 * (1 - alpha));
  }
  return values;
}

/** The grey that best parts dark from light (Otsu, 1979); values below it are dark. @param {Uint8Array} values */
export function bestThreshold(values) {
  const counts = new Float64Array(256);
  let sum = 0;
  for (const value of values) {
    counts[value]++;
    sum += value;
  }
  // Between two clear peaks all thresholds are equally good: take the middle one.
  let [best, first, last, below, sumBelow] = [-1, 128, 128, 0, 0];
  for (let t = 1; t < 256; t++) {
    below += counts[t - 1];
    sumBelow += counts[t - 1] * (t - 1);
    const above = values.length - below;
    if (!below || !above) continue;
    const between = below * above * (sumBelow / below - (sum - sumBelow) / above) ** 2;
    if (between > best * (1 + 1e-12)) [best, first, last] = [between, t, t];
    else if (between > best * (1 - 1e-12)) last = t;
  }
  return Math.round((first + last) / 2);
}

/**
 * The number of stitches in a picture whose cells are larger than a pixel, from where its greys
 * change; null if no grid explains that, and every pixel may be a stitch.
 *
 * @param {Uint8Array} values
 * @param {number} width
 * @param {number} height
 * @returns {{columns: number, rows: number} | null}
 */
export function detectedGrid(values, width, height) {
  const across = new Float64Array(width);
  const down = new Float64Array(height);
  for (let y = 0, i = 0; y < height; y++) {
    for (let x = 0; x < width; x++, i++) {
      if (x) across[x] += Math.abs(values[i] - values[i - 1]);
      if (y) down[y] += Math.abs(values[i] - values[i - width]);
    }
  }
  const columns = cells(across);
  const rows = cells(down);
  return columns && rows ? { columns, rows } : null;
}

/**
 * The smallest number of equal cells whose borders explain the changes along an axis.
 *
 * @param {Float64Array} changes between each pixel and the one before it
 */
function cells(changes) {
  const length = changes.length;
  const total = changes.reduce((a, b) => a + b, 0);
  if (!total) return 0;
  for (let n = 2; n <= Math.min(MAX_SIDE, length / 3); n++) {
    const reach = Math.max(1, Math.round((length / n) * 0.08));
    let explained = 0;
    let covered = 0;
    for (let k = 0; k <= n; k++) {
      const at = Math.round((k * length) / n);
      for (let x = Math.max(0, at - reach); x <= Math.min(length - 1, at + reach); x++) {
        explained += changes[x];
        covered++;
      }
    }
    if (explained > 0.95 * total && covered < 0.75 * length) return n;
  }
  return 0;
}

/**
 * The stitches of a picture: dark cells are purls.
 *
 * @param {Uint8Array} values
 * @param {number} width
 * @param {number} height
 * @param {{columns: number, rows: number, threshold: number, inverted?: boolean}} how
 */
export function stitchesOf(values, width, height, { columns, rows, threshold, inverted = false }) {
  return Grid.build(rows, columns, (row, column) => {
    const top = ((rows - 1 - row) * height) / rows;
    const left = (column * width) / columns;
    // The middle half of the cell: lines of a drawn grid do not count.
    const [y0, y1] = middle(top, height / rows);
    const [x0, x1] = middle(left, width / columns);
    let sum = 0;
    for (let y = y0; y < y1; y++) for (let x = x0; x < x1; x++) sum += values[y * width + x];
    return sum / ((y1 - y0) * (x1 - x0)) < threshold !== inverted;
  });
}

/** @param {number} from @param {number} size */
function middle(from, size) {
  const first = Math.floor(from + size / 4);
  return [first, Math.max(first + 1, Math.floor(from + (3 * size) / 4))];
}
