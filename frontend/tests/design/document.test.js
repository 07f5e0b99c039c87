import assert from "node:assert/strict";
import { test } from "node:test";
import { ChartDocument } from "../../design/document.js";
import { Grid } from "../../grid/grid.js";
import { flip, pack, toRuns, unpack } from "../../grid/bits.js";
import { History } from "../../design/history.js";
import { isFilled } from "../../design/regions.js";
import { surroundings } from "../../grid/segments.js";
import { Brush } from "../../grid/stroke.js";
import { random } from "../random.js";

/** @param {ChartDocument} chart @param {Record<number, number>} cells */
const brush = (chart, cells) =>
  Brush.of(
    chart.grid.purl.length,
    Object.entries(cells).map(([i, value]) => [Number(i), value]),
  );

/** @param {ChartDocument} chart @param {Record<number, number>} cells */
function stroke(chart, cells) {
  chart.begin();
  chart.paint(brush(chart, cells), false);
  chart.commit("Pencil");
}

test("runs and packed text hold a bitmap", () => {
  const bitmap = Uint8Array.of(0, 0, 0, 1, 1, 1, 0, 0, 0, 1);
  assert.deepEqual(toRuns(bitmap), [3, 3, 9, 1]);
  assert.deepEqual(unpack(pack(bitmap), 10), bitmap);
  flip(bitmap, [3, 3, 9, 1]);
  assert.equal(bitmap.indexOf(1), -1);
});

test("a stroke is one step; undo and redo go to and fro", () => {
  const chart = new ChartDocument(new Grid(2, 3));
  stroke(chart, { 0: 1, 4: 1 });
  stroke(chart, { 4: 0 });
  assert.equal(chart.grid.text, "KKK\nPKK");
  assert.equal(chart.undo(), "Pencil");
  assert.equal(chart.grid.text, "KPK\nPKK");
  chart.undo();
  assert.equal(chart.grid.text, "KKK\nKKK");
  assert.equal(chart.undo(), undefined);
  chart.redo();
  chart.redo();
  assert.equal(chart.grid.text, "KKK\nPKK");
  assert.equal(chart.redo(), undefined);
});

test("a shape being dragged leaves only its last form", () => {
  const chart = new ChartDocument(Grid.fromText("PKK"));
  chart.begin();
  chart.paint(brush(chart, { 0: 1, 1: 1, 2: 1 }), true);
  assert.equal(chart.grid.text, "PPP");
  chart.paint(brush(chart, { 0: 0, 1: 1 }), true);
  assert.equal(chart.grid.text, "KPK");
  chart.commit("Rectangle");
  chart.undo();
  assert.equal(chart.grid.text, "PKK");
});

test("a stroke that changes nothing, and one that is given up, are not steps", () => {
  const chart = new ChartDocument(Grid.fromText("PK"));
  stroke(chart, { 0: 1 });
  chart.begin();
  chart.paint(brush(chart, { 1: 1 }), false);
  chart.cancel();
  assert.equal(chart.grid.text, "PK");
  assert.equal(chart.history.done.length, 0);
});

test("a new chart of another size can be taken back", () => {
  const chart = new ChartDocument(Grid.fromText("KP"));
  chart.replace(Grid.fromText("PPP\nKKK"), "Import");
  chart.replace(Grid.fromText("PPP\nKKK"), "Import");
  assert.equal(chart.history.done.length, 1);
  chart.undo();
  assert.equal(chart.grid.text, "KP");
  chart.redo();
  assert.equal(chart.grid.text, "PPP\nKKK");
});

test("a new step forgets what was undone", () => {
  const chart = new ChartDocument(new Grid(1, 3));
  stroke(chart, { 0: 1 });
  chart.undo();
  stroke(chart, { 2: 1 });
  assert.equal(chart.redo(), undefined);
});

test("the codes kept up to date are those computed afresh, and the box holds every change", () => {
  for (let seed = 1; seed < 60; seed++) {
    const grid = random(seed);
    const chart = new ChartDocument(grid);
    const i = (seed * 7) % grid.purl.length;
    const before = chart.codes.slice();
    /** @type {import("../../grid/grid.js").Box[]} */
    const boxes = [];
    chart.onChange(({ box }) => boxes.push(box));
    stroke(chart, { [i]: 1 - grid.purl[i] });
    assert.deepEqual(chart.codes, surroundings(chart.grid));
    const { row0, row1, column0, column1 } = boxes[0];
    chart.codes.forEach((code, k) => {
      const row = Math.floor(k / grid.columns);
      const column = k % grid.columns;
      const inside = row >= row0 && row < row1 && column >= column0 && column < column1;
      assert.ok(inside || code === before[k]);
    });
  }
});

test("the history is kept across a reload, and shortened from its old end", () => {
  const chart = new ChartDocument(new Grid(1, 40));
  for (let i = 0; i < 40; i++) stroke(chart, { [i]: 1 });
  const again = new ChartDocument(Grid.fromText(chart.grid.text), History.parse(chart.history.serialised(1e6)));
  for (let i = 0; i < 40; i++) again.undo();
  assert.equal(again.grid.text, "K".repeat(40));
  const short = History.parse(chart.history.serialised(400));
  assert.ok(short.done.length > 0 && short.done.length < 40);
  assert.deepEqual(short.done.at(-1), chart.history.done.at(-1));
  assert.equal(History.parse("spoilt").done.length, 0);
});

test("a region knows whether it was painted over since it was filled", () => {
  const chart = new ChartDocument(new Grid(2, 4));
  const id = chart.addRegion({ name: "cuff", colour: "#336699" });
  chart.set(
    [0, 1, 4, 5].map((i) => [i, 1]),
    "Region",
    `region:${id}`,
  );
  const region = () => /** @type {import("../../design/regions.js").Region} */ (chart.region(id));
  chart.changeRegion(id, { fill: Grid.fromText("KP") }, "Fill");
  assert.equal(chart.grid.text, "KPKK\nKPKK");
  assert.ok(isFilled(region(), chart));
  chart.set([[0, 1]], "Paint");
  assert.ok(!isFilled(region(), chart));
  chart.fillRegion(id);
  assert.ok(isFilled(region(), chart));
});
