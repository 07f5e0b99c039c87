import assert from "node:assert/strict";
import { test } from "node:test";

import { Viewport } from "../../chart/viewport.js";
import { Grid } from "../../grid/grid.js";

const grid = Grid.build(100, 100, () => false);

function viewport() {
  const view = new Viewport();
  Object.assign(view, { width: 700, height: 600 });
  view.fit(grid);
  return view;
}

test("many small steps zoom as far as a large one, in and out", () => {
  const [small, large] = [viewport(), viewport()];
  large.zoom(3, 300, 300, grid);
  for (let k = 0; k < 200; k++) small.zoom(3 ** (1 / 200), 300, 300, grid);
  assert.equal(small.cellWidth, large.cellWidth);
  large.zoom(0.6, 300, 300, grid);
  for (let k = 0; k < 200; k++) small.zoom(0.6 ** (1 / 200), 300, 300, grid);
  assert.equal(small.cellWidth, large.cellWidth);
});
