import assert from "node:assert/strict";
import { test } from "node:test";
import { selectedLines, selectionOf } from "../../design/selection.js";
import { Grid } from "../../grid/grid.js";

test("the lines of a selection are its box, the top row first, and none are needed where all of it is selected", () => {
  const grid = new Grid(3, 4);
  const bitmap = Uint8Array.from([0, 1, 1, 0, 0, 1, 0, 0, 0, 0, 0, 0]);
  const corner = selectionOf(bitmap, grid);
  assert.ok(corner);
  assert.equal(selectedLines(corner), "x.\nxx");
  assert.equal(selectedLines({ row0: 0, column0: 0, row1: 2, column1: 2 }), null);
});
