import assert from "node:assert/strict";
import { test } from "node:test";
import { Grid } from "../core/grid.js";
import { FLIP, Ink, KNIT, PURL, inked } from "../core/ink.js";
import { ellipse, flood, line, rectangle, thick } from "../core/raster.js";
import { surroundings } from "../core/segments.js";
import { TOOLS } from "../tools/registry.js";
import { ACTIONS, matches } from "../actions/registry.js";

/**
 * The chart after one gesture of a tool.
 *
 * @param {string} id
 * @param {Grid} grid
 * @param {import("../core/raster.js").Cell} start
 * @param {import("../core/raster.js").Cell} end
 * @param {{ink?: Ink, size?: number, constrain?: boolean, symmetry?: import("../core/ink.js").Symmetry}} [options]
 */
function draw(id, grid, start, end, { ink = PURL, size = 1, constrain = false, symmetry = "none" } = {}) {
  const tool = TOOLS.find((one) => one.id === id);
  assert.ok(tool);
  const gesture = { start, previous: start, current: end, constrain };
  const cells = tool.cells(gesture, { grid, codes: surroundings(grid), size, ink });
  const result = grid.clone();
  for (const [i, value] of inked(grid, cells, ink, tool.origin?.(gesture) ?? [0, 0], symmetry)) {
    result.purl[i] = value;
  }
  return result.text;
}

test("a line has no gaps and both its ends", () => {
  for (const [row, column] of /** @type {[number, number][]} */ ([[7, 3], [-4, 9], [0, -5], [6, 6], [0, 0]])) {
    const cells = line([0, 0], [row, column]);
    assert.deepEqual(cells[0], [0, 0]);
    assert.deepEqual(cells.at(-1), [row, column]);
    for (let i = 1; i < cells.length; i++) {
      assert.ok(Math.max(Math.abs(cells[i][0] - cells[i - 1][0]), Math.abs(cells[i][1] - cells[i - 1][1])) === 1);
    }
  }
});

test("shapes", () => {
  assert.equal(rectangle([2, 1], [0, 3]).length, 9);
  assert.equal(ellipse([0, 0], [4, 4]).length, 21);
  assert.equal(new Set(thick([[5, 5]], 3).map(String)).size, 9);
});

test("a flood stays among connected like stitches", () => {
  const grid = Grid.fromText("KPK\nKPK\nKPK");
  assert.equal(flood(grid, grid.purl, [0, 0]).length, 3);
  assert.equal(flood(grid, grid.purl, [1, 1]).length, 3);
});

test("each tool draws what it says", () => {
  const empty = new Grid(3, 5);
  assert.equal(draw("pencil", empty, [0, 0], [0, 4]), "KKKKK\nKKKKK\nPPPPP");
  assert.equal(draw("pencil", empty, [1, 2], [1, 2], { size: 3 }), "KPPPK\nKPPPK\nKPPPK");
  assert.equal(draw("line", empty, [0, 0], [2, 2]), "KKPKK\nKPKKK\nPKKKK");
  assert.equal(draw("line", empty, [0, 0], [1, 4], { constrain: true }), "KKKKK\nKKKKK\nPPPPP");
  assert.equal(draw("rectangle", empty, [0, 3], [1, 4]), "KKKKK\nKKKPP\nKKKPP");
  assert.equal(draw("ellipse", empty, [0, 0], [2, 4]), "KPPPK\nPPPPP\nKPPPK");
  assert.equal(draw("fill", Grid.fromText("KKP\nPPK\nKKP"), [2, 0], [2, 0]), "PPP\nPPK\nKKP");
});

test("Shift with fill keeps to one fabric", () => {
  const half = Grid.build(2, 8, (row, column) => column >= 4 && (row + column) % 2);
  // The upper row's fourth stitch has a purl beside it: it is another kind of stitch.
  const filled = "PPPKPKPK\nPPPPKPKP";
  assert.equal(half.text, "KKKKPKPK\nKKKKKPKP");
  assert.equal(draw("fill", half, [0, 0], [0, 0], { constrain: true }), filled);
});

test("patterns keep to the chart's corner, a stamp to the pointer; nothing is drawn outside", () => {
  const rib = new Ink("rib", "Rib", Grid.fromText("KP"));
  const empty = new Grid(2, 5);
  assert.equal(draw("rectangle", empty, [0, 1], [5, 9], { ink: rib }), "KPKPK\nKPKPK");
  assert.equal(draw("stamp", empty, [0, 2], [0, 2], { ink: rib }), "KKKKK\nKKKPK");
  assert.equal(draw("stamp", empty, [0, 4], [0, 4], { ink: rib }), "KKKKK\nKKKKK");
});

test("symmetry mirrors what is painted", () => {
  const empty = new Grid(3, 5);
  assert.equal(draw("pencil", empty, [0, 0], [0, 1], { symmetry: "across" }), "KKKKK\nKKKKK\nPPKPP");
  assert.equal(draw("pencil", empty, [0, 0], [0, 0], { symmetry: "both" }), "PKKKP\nKKKKK\nPKKKP");
});

test("flip paints the opposite of the stitch first touched; the other button swaps a pattern", () => {
  assert.equal(FLIP.resolved(0), PURL);
  assert.equal(FLIP.resolved(1), KNIT);
  assert.equal(PURL.opposite().at([0, 0], [0, 0]), 0);
});

test("ids are unique, and no key starts two things", () => {
  const ids = ACTIONS.map(({ id }) => id);
  assert.equal(new Set(ids).size, ids.length);
  const keys = ACTIONS.flatMap((one) => one.keys);
  assert.equal(new Set(keys).size, keys.length);
});

test("shortcuts are told apart by Ctrl and Shift", () => {
  const press = { key: "z", ctrlKey: true, metaKey: false, shiftKey: false, altKey: false };
  assert.ok(matches("Mod+Z", press));
  assert.ok(!matches("Mod+Shift+Z", press));
  assert.ok(matches("Mod+Shift+Z", { ...press, key: "Z", shiftKey: true }));
  assert.ok(matches("?", { ...press, ctrlKey: false, key: "?", shiftKey: true }));
  assert.ok(matches("+", { ...press, ctrlKey: false, key: "+", shiftKey: true }));
  assert.ok(!matches("Z", press));
});
