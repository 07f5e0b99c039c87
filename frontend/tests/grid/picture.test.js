import assert from "node:assert/strict";
import { test } from "node:test";
import { Grid } from "../../grid/grid.js";
import { bestThreshold, detectedGrid, greys, stitchesOf } from "../../grid/picture.js";
import { random } from "../random.js";

/**
 * A chart drawn with cells of a size and, if wanted, lines between them.
 *
 * @param {Grid} grid
 * @param {number} wide
 * @param {number} high
 * @param {boolean} lines
 */
function drawn(grid, wide, high, lines) {
  const [width, height] = [grid.columns * wide, grid.rows * high];
  const values = new Uint8Array(width * height);
  for (let y = 0; y < height; y++) {
    for (let x = 0; x < width; x++) {
      const row = grid.rows - 1 - Math.floor(y / high);
      const line = lines && (x % wide === 0 || y % high === 0);
      values[y * width + x] = line ? 100 : grid.purl[grid.index(row, Math.floor(x / wide))] ? 40 : 230;
    }
  }
  return { values, width, height };
}

test("one pixel a stitch", () => {
  for (let seed = 1; seed < 20; seed++) {
    const grid = random(seed);
    const { values, width, height } = drawn(grid, 1, 1, false);
    const { rows, columns } = grid;
    assert.ok(stitchesOf(values, width, height, { rows, columns, threshold: 128 }).equals(grid));
    const other = stitchesOf(values, width, height, { rows, columns, threshold: 128, inverted: true });
    assert.ok(other.equals(grid.swapped()));
  }
});

test("larger cells are found and read, with and without lines", () => {
  const grid = Grid.build(9, 14, (row, column) => (row * 7 + column * column * 3) % 5 < 2);
  for (const [wide, high, lines] of /** @type {[number, number, boolean][]} */ ([
    [8, 6, false],
    [11, 9, true],
    [20, 20, true],
  ])) {
    const { values, width, height } = drawn(grid, wide, high, lines);
    const detected = detectedGrid(values, width, height);
    assert.deepEqual(detected, { columns: 14, rows: 9 }, `${wide} x ${high}`);
    const threshold = bestThreshold(values);
    assert.ok(detected && stitchesOf(values, width, height, { ...detected, threshold }).equals(grid));
  }
});

test("no grid is seen where there is none", () => {
  const noise = Uint8Array.from({ length: 3600 }, (_, i) => (Math.imul(i, 2654435761) >>> 13) & 255);
  assert.equal(detectedGrid(noise, 60, 60), null);
  assert.equal(detectedGrid(new Uint8Array(100), 10, 10), null);
});

test("the threshold lies between two greys, and transparency is paper", () => {
  const threshold = bestThreshold(Uint8Array.of(20, 25, 22, 190, 200, 195));
  assert.equal(threshold, 108);
  assert.deepEqual(
    greys({ data: Uint8Array.of(0, 0, 0, 255, 0, 0, 0, 0), width: 2, height: 1 }),
    Uint8Array.of(0, 255),
  );
});
