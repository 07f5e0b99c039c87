import assert from "node:assert/strict";
import { test } from "node:test";
import { Grid } from "../../grid/grid.js";
import { FLIP, Ink, KNIT, PURL, inked, regionInk } from "../../design/ink.js";
import { Floating, changed } from "../../design/floating.js";
import { ellipse, enclosed, flood, line, rectangle, thick } from "../../grid/raster.js";
import { Others } from "../../design/others.js";
import { surroundings } from "../../grid/segments.js";
import { combined, selectedCells } from "../../design/selection.js";
import { TOOLS } from "../../tools/tools.js";
import { ACTIONS, matches } from "../../actions/registry.js";
import { random } from "../random.js";

/**
 * The chart after one gesture of a tool.
 *
 * @param {string} id
 * @param {Grid} grid
 * @param {import("../../grid/raster.js").Cell} start
 * @param {import("../../grid/raster.js").Cell} end
 * @param {{ink?: Ink, size?: number, constrain?: boolean, symmetry?: import("../../design/ink.js").Symmetry}} [options]
 */
function draw(id, grid, start, end, { ink = PURL, size = 1, constrain = false, symmetry = "none" } = {}) {
  const tool = TOOLS.find((candidate) => candidate.id === id);
  assert.ok(tool);
  const gesture = { start, previous: start, current: end, path: [start, end], constrain };
  const outline = grid.purl.map(() => 1);
  const spans = tool.spans(gesture, { grid, codes: surroundings(grid), outline, size, ink });
  const result = Grid.fromText(grid.text);
  const [brush] = inked(grid, spans, ink, tool.origin?.(gesture) ?? [0, 0], symmetry);
  for (const i of brush.touched) result.purl[i] = brush.values[i];
  return result.text;
}

test("a line has no gaps and both its ends", () => {
  for (const [row, column] of /** @type {[number, number][]} */ ([
    [7, 3],
    [-4, 9],
    [0, -5],
    [6, 6],
    [0, 0],
  ])) {
    const cells = line([0, 0], [row, column]);
    assert.deepEqual(cells[0], [0, 0]);
    assert.deepEqual(cells.at(-1), [row, column]);
    for (let i = 1; i < cells.length; i++) {
      assert.ok(Math.max(Math.abs(cells[i][0] - cells[i - 1][0]), Math.abs(cells[i][1] - cells[i - 1][1])) === 1);
    }
  }
});

/** @param {import("../../grid/raster.js").Span[]} spans */
const cellsOf = (spans) =>
  new Set(spans.flatMap(([row, from, to]) => Array.from({ length: to - from }, (_, k) => `${row},${from + k}`)));

test("shapes", () => {
  assert.equal(cellsOf(rectangle([2, 1], [0, 3])).size, 9);
  assert.equal(cellsOf(ellipse([0, 0], [4, 4])).size, 21);
  assert.equal(cellsOf(thick([[5, 5]], 3)).size, 9);
});

test("a flood stays among connected like stitches", () => {
  const grid = Grid.fromText("KPK\nKPK\nKPK");
  assert.equal(cellsOf(flood(grid, grid.purl, [0, 0])).size, 3);
  assert.equal(cellsOf(flood(grid, grid.purl, [1, 1])).size, 3);
  const maze = Grid.fromText("KKKKK\nKPPPK\nKPKPK\nKPKKK");
  assert.equal(cellsOf(flood(maze, maze.purl, [0, 0])).size, 14, "around a hook and into it");
});

test("a flood is every stitch that can be reached", () => {
  for (let seed = 1; seed < 60; seed++) {
    const { rows, columns, purl } = random(seed);
    const flooded = cellsOf(flood(new Grid(rows, columns, purl), purl, [0, 0]));
    const reached = new Set(["0,0"]);
    for (const at of reached) {
      const [row, column] = at.split(",").map(Number);
      for (const [r, c] of [
        [row - 1, column],
        [row + 1, column],
        [row, column - 1],
        [row, column + 1],
      ]) {
        const inside = r >= 0 && c >= 0 && r < rows && c < columns;
        if (inside && purl[r * columns + c] === purl[0]) reached.add(`${r},${c}`);
      }
    }
    assert.deepEqual(flooded, reached);
  }
});

test("a lasso selects what it goes around, and its own stitches", () => {
  assert.equal(
    cellsOf(
      enclosed([
        [0, 0],
        [0, 4],
        [4, 4],
        [4, 0],
      ]),
    ).size,
    25,
  );
  assert.equal(
    cellsOf(
      enclosed([
        [0, 0],
        [4, 4],
        [0, 4],
      ]),
    ).size,
    15,
  );
  assert.equal(cellsOf(enclosed([[2, 3]])).size, 1);
});

test("selections are added, subtracted, intersected and mirrored", () => {
  const grid = new Grid(4, 6);
  const box = combined(null, rectangle([0, 0], [1, 2]), grid, "replace");
  assert.deepEqual(box, { row0: 0, column0: 0, row1: 2, column1: 3 });
  const added = combined(box, rectangle([3, 5], [9, 9]), grid, "add");
  assert.ok(added?.mask);
  assert.equal(added && selectedCells(added, grid).length, 7);
  assert.deepEqual(combined(added, rectangle([3, 5], [3, 5]), grid, "subtract"), box);
  assert.deepEqual(
    combined(added, rectangle([1, 1], [3, 5]), grid, "intersect")?.mask?.reduce((a, b) => a + b, 0),
    3,
  );
  assert.equal(combined(box, rectangle([0, 0], [3, 5]), grid, "subtract"), null);
  const both = combined(null, [[0, 0, 2]], grid, "replace", "both");
  assert.equal(both && selectedCells(both, grid).length, 8);
});

test("what is in the hand is put down, and what lay under it comes back", () => {
  const grid = Grid.fromText("KKKK\nPPKK\nPKKP");
  const lifted = Floating.lift({ grid, others: new Others() }, { row0: 0, column0: 0, row1: 2, column1: 2 }, false);
  const after = Grid.fromText(grid.text);
  for (const [i, value] of lifted.moved(grid, [0, 2])) after.purl[i] = value;
  assert.equal(after.text, "KKKK\nKKPP\nKKPK");
  const held = new Floating(lifted.clip, [0, 2], lifted.under);
  for (const [i, value] of held.moved(after, [1, 3])) after.purl[i] = value;
  assert.equal(after.text, "KKKP\nKKKP\nKKKP", "the purl that was covered is back");
  assert.deepEqual(held.selection(grid, [1, 3]), { row0: 1, column0: 3, row1: 3, column1: 4 });
});

test("a change of a selection keeps to its shape", () => {
  const grid = Grid.fromText("KPP\nKKP");
  const corner = { row0: 0, column0: 1, row1: 2, column1: 3, mask: Uint8Array.of(0, 1, 1, 1) };
  const cells = changed(
    grid,
    corner,
    (part) => part.mirrored(),
    (mask) => mask.mirrored(),
  );
  assert.deepEqual([...cells].sort(), [
    [1, 1],
    [2, 0],
    [4, 1],
    [5, 1],
  ]);
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
  assert.equal(regionInk({ id: "a", name: "A" }).opposite().target, "region:a");
  assert.equal(PURL.opposite().at([0, 0], [0, 0]), 0);
});

test("ids are unique, and no key starts two things", () => {
  const ids = ACTIONS.map(({ id }) => id);
  assert.equal(new Set(ids).size, ids.length);
  const keys = ACTIONS.flatMap((action) => action.keys);
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
