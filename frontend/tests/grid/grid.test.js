import assert from "node:assert/strict";
import { test } from "node:test";
import { Grid, isChartText } from "../../grid/grid.js";
import { random } from "../random.js";

test("a text is read with the top row first and written the same", () => {
  const grid = Grid.fromText("KP\nPP\nKK");
  assert.deepEqual([grid.rows, grid.columns], [3, 2]);
  assert.deepEqual([...grid.purl], [0, 0, 1, 1, 0, 1]);
  assert.equal(grid.text, "KP\nPP\nKK");
});

test("mirror, flip, swap and turn over undo themselves", () => {
  for (let seed = 1; seed < 20; seed++) {
    const grid = random(seed);
    for (const change of /** @type {const} */ (["mirrored", "flipped", "swapped", "turnedOver"])) {
      assert.ok(grid[change]()[change]().equals(grid), change);
    }
  }
});

test("resizing keeps the bottom left and tiling repeats from there", () => {
  const grid = Grid.fromText("KP\nPK");
  assert.equal(grid.resized(3, 3).text, "KKK\nKPK\nPKK");
  assert.equal(grid.tiled(3, 3).text, "PKP\nKPK\nPKP");
  assert.equal(grid.resized(1, 1).text, "P");
});

test("a region is the part within its box", () => {
  const grid = Grid.fromText("KKP\nPKP\nKPK");
  assert.equal(grid.region({ row0: 1, column0: 1, row1: 3, column1: 3 }).text, "KP\nKP");
});

test("only rectangles of K and P within the limits are chart texts", () => {
  assert.ok(isChartText("KP\nPK\n"));
  for (const bad of ["", "KX", "KP\nK", "kp", `${"K".repeat(401)}`]) assert.ok(!isChartText(bad), bad);
});
