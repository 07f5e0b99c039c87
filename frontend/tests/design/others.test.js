import assert from "node:assert/strict";
import { test } from "node:test";
import { DesignError, contentOf, readContent } from "../../design/design.js";
import { ChartDocument } from "../../design/document.js";
import { Clip, Floating, changedStitches } from "../../design/floating.js";
import { History } from "../../design/history.js";
import { PURL, codesInk, inked } from "../../design/ink.js";
import { Others, codesText, entriesOf, written } from "../../design/others.js";
import { deleted, inserted, resized, turned } from "../../design/reshape.js";
import { Grid } from "../../grid/grid.js";
import { readCodes } from "../../grid/kinds.js";
import { rectangle } from "../../grid/raster.js";
import { Brush } from "../../grid/stroke.js";

/** @param {string} codes */
function made(codes) {
  const read = /** @type {NonNullable<ReturnType<typeof readCodes>>} */ (readCodes(codes));
  const { columns } = Grid.fromText(read.chart);
  const others = Others.of(read.others.map(([row, column, code]) => [row * columns + column, code]));
  return ChartDocument.read(contentOf(read.chart, { other_stitches: written(others, columns) }));
}

/** @param {ChartDocument} chart */
const codes = (chart) => codesText(chart.grid, chart.others).replaceAll("\n", "");

/** @param {ChartDocument} chart @param {import("../../grid/raster.js").Cell} from @param {import("../../grid/raster.js").Cell} to */
function fill(chart, ink = PURL, from = [0, 0], to = from, { origin = from, symmetry = "none" } = {}) {
  chart.begin();
  const how = /** @type {import("../../design/ink.js").Symmetry} */ (symmetry);
  const [brush, put] = inked(chart.grid, rectangle(from, to), ink, origin, how);
  chart.paint(brush, false, put);
  chart.commit("Pencil");
}

test("runs of neighbours are read and written the same", () => {
  const runs = [
    { row: 0, column: 1, codes: "O/[2/2R]" },
    { row: 1, column: 0, codes: "V" },
  ];
  assert.deepEqual(written(Others.of(entriesOf(runs, 7)), 7), runs);
  const content = contentOf("KKKKKKK\nKKKKKKK", { other_stitches: runs });
  const chart = ChartDocument.read(readContent(content));
  assert.deepEqual(chart.content, content);
  assert.deepEqual(ChartDocument.read(chart.content).content, content);
});

test("a file whose chart is codes is read, too", () => {
  const content = readContent({ chart: "KO/\nKKP" });
  assert.equal(content.chart, "KKK\nKKP");
  assert.deepEqual(ChartDocument.read(content).text, "KO/;\nKKP");
});

test("a file with stitches outside, on each other or unknown is refused in words", () => {
  /** @param {...unknown} runs */
  const reading =
    (...runs) =>
    () =>
      readContent({ chart: "KKK", other_stitches: runs });
  assert.throws(reading({ row: 0, column: 1, codes: "[2/2R]" }), /beyond the chart of 3 × 1/);
  assert.throws(
    reading({ row: 0, column: 0, codes: "[1/1R]" }, { row: 0, column: 1, codes: "O" }),
    /lie on each other/,
  );
  assert.throws(reading({ row: 0, column: 0, codes: "K" }), /K is no stitch/);
  assert.throws(reading("O"), DesignError);
});

test("painting knits and purls takes other stitches away, a cable whole; undo brings them back", () => {
  const chart = made("O/KP[2/2RP]K;KKKKPPKKK");
  const before = codes(chart);
  fill(chart, PURL, [1, 5]);
  assert.equal(codes(chart), "O/KPPPKKK;KKKKPPKKK", "its other columns are what they showed");
  chart.undo();
  assert.equal(codes(chart), before);
  chart.redo();
  assert.equal(codes(chart), "O/KPPPKKK;KKKKPPKKK");
  chart.begin();
  chart.paint(Brush.of(18, [[9, 1]]), false);
  chart.cancel();
  assert.equal(codes(chart), "O/KPPPKKK;KKKKPPKKK");
});

test("an ink of other stitches lays what they show, wide ones whole and inside only", () => {
  const chart = new ChartDocument(new Grid(2, 6));
  fill(chart, codesInk("c", "Cable", "[2/1LP]"), [0, 1], [0, 5]);
  assert.equal(codes(chart), "KKKKKK;K[2/1LP]KK");
  assert.equal(chart.grid.text, "KKKKKK\nKKKPKK");
  fill(chart, codesInk("c", "Cable", "[2/1LP]").opposite(), [0, 3]);
  assert.equal(codes(chart), "KKKKKK;KKKKKK");
});

test("symmetry puts down mirrored stitches", () => {
  const chart = new ChartDocument(new Grid(1, 7));
  fill(chart, codesInk("d", "k2tog", "/"), [0, 0], [0, 0], { symmetry: "across" });
  fill(chart, codesInk("c", "Cable", "[1/1R]"), [0, 1], [0, 1], { symmetry: "across" });
  assert.equal(codes(chart), "/[1/1R]K[1/1L]\\");
});

test("a slipped stitch looks like what it holds, whatever is painted there", () => {
  const chart = new ChartDocument(new Grid(3, 2));
  fill(chart, codesInk("v", "Slip", "V"), [1, 0], [2, 0]);
  fill(chart, PURL, [0, 0]);
  assert.equal(chart.grid.text, "PK\nPK\nPK");
  assert.equal(codes(chart), "VK;VK;PK");
  chart.undo();
  assert.equal(chart.grid.text, "KK\nKK\nKK");
});

test("a shape being dragged leaves only its last form", () => {
  const chart = made("KKKK;O/KK");
  const ink = codesInk("t", "Tuck", "T");
  chart.begin();
  for (const column of [1, 2]) {
    const [brush, put] = inked(chart.grid, rectangle([0, column], [0, column]), ink, [0, column], "none");
    chart.paint(brush, true, put);
  }
  chart.commit("Stamp");
  assert.equal(codes(chart), "KKKK;O/TK");
});

test("locked regions and the outside refuse them; linked copies follow", () => {
  const chart = new ChartDocument(new Grid(1, 8));
  chart.addRegion({ name: "Rim", colour: "#112233", locked: true }, [0, 1]);
  const names = new Set();
  chart.onRefuse((locked) => locked.forEach((name) => names.add(name)));
  fill(chart, codesInk("c", "Cable", "[1/1R]"), [0, 1]);
  assert.equal(codes(chart), "KKKKKKKK;".slice(0, 8));
  assert.deepEqual([...names], ["Rim"]);
  const placements = [2, 5].map((column) => ({ row: 0, column, rows: 1, columns: 3 }));
  chart.addRepeat({ name: "Lace", motif: new Grid(1, 3), placements });
  fill(chart, codesInk("o", "Eyelet", "O/"), [0, 3], [0, 4]);
  assert.equal(codes(chart), "KKKO/KO/");
});

test("a repeat made of lace keeps it, and places it", () => {
  const chart = made("O/KKKKKKK");
  const place = { row: 0, column: 0, rows: 1, columns: 3 };
  const id = chart.addRepeat({ name: "Lace", motif: new Grid(1, 3), placements: [place] });
  assert.equal(codes(chart), "O/KKKKKKK");
  chart.changeRepeat(id, { placements: [place, { ...place, column: 3, columns: 6 }] }, "Place");
  assert.equal(codes(chart), "O/KO/KO/K");
  chart.undo();
  assert.equal(codes(chart), "O/KKKKKKK");
});

test("mirrored, turned over and resized charts keep their stitches; what is cut is said", () => {
  let cut = 0;
  const chart = made("O/K[2/1LP];KKKPKK");
  chart.onCut((count) => (cut += count));
  chart.reshape("Mirror", turned(chart.grid, "mirrored"));
  assert.equal(codes(chart), "[2/1RP]K\\O;KKPKKK");
  chart.reshape("Over", turned(chart.grid, "turnedOver"));
  assert.equal(codes(chart), "O(P[1/2RP];PPPKPP");
  assert.equal(chart.grid.text, "KPPPPK\nPPPKPP");
  chart.undo();
  chart.undo();
  chart.reshape("Insert", inserted(chart.grid, "columns", 2, 1, "before"));
  assert.equal(codes(chart), "O/KK[2/1LP];KKKKPKK");
  assert.equal(cut, 0);
  chart.reshape("Delete", deleted(chart.grid, "columns", 0, 1));
  assert.equal(codes(chart), "/KK[2/1LP];KKKPKK");
  chart.reshape("Cut", resized(chart.grid, 2, 5));
  assert.equal(codes(chart), "/KKKK;KKKPK");
  assert.equal(cut, 1);
  const steps = History.parse(chart.history.serialised(1e6));
  const again = ChartDocument.read(chart.content, steps);
  again.undo();
  assert.equal(codes(again), "/KK[2/1LP];KKKPKK");
});

test("what is copied, moved or changed in a selection takes its stitches along", () => {
  const chart = made("KKKKKK;O/[1/1R]KK");
  const box = { row0: 0, column0: 0, row1: 1, column1: 3 };
  assert.deepEqual(Clip.of(chart, box).others, [
    [0, "O"],
    [1, "/"],
  ]);
  const lifted = Floating.lift(chart, { ...box, column1: 2 }, false);
  chart.begin();
  const moved = lifted.moved(chart.grid, [1, 2]);
  chart.paint(Brush.of(12, moved), true, lifted.put(chart.grid, [1, 2]));
  chart.commit("Move");
  assert.equal(codes(chart), "KKO/KK;KK[1/1R]KK");
  const top = { row0: 1, column0: 0, row1: 2, column1: 6 };
  assert.deepEqual(changedStitches(chart, top, "mirrored"), [
    [9, "O"],
    [8, "\\"],
  ]);
});

test("a chart that replaces another keeps its own", () => {
  const chart = made("O/KK");
  chart.replace(Grid.fromText("KKKK"), "Same", [[1, "O"]]);
  assert.equal(codes(chart), "KOKK");
  chart.undo();
  assert.equal(codes(chart), "O/KK");
  chart.replace(Grid.fromText("PPP"), "Other");
  assert.equal(codes(chart), "PPP");
});

test("undo and redo of random painting lead through the same charts", () => {
  let state = 43;
  const draw = () => (state = (state * 48271) % 2147483647) / 2147483647;
  const inks = ["O/", "[1/2L]", "V", "T", "P", "^O;KK"].map((text, k) => codesInk(`i${k}`, text, text));
  for (let trial = 0; trial < 30; trial++) {
    const chart = new ChartDocument(new Grid(4, 7));
    const seen = [JSON.stringify(chart.content)];
    for (let step = 0; step < 12; step++) {
      const [row, column] = [Math.floor(draw() * 4), Math.floor(draw() * 7)];
      const count = chart.history.done.length;
      fill(
        chart,
        inks[Math.floor(draw() * inks.length)],
        [row, column],
        [Math.min(3, row + 1), Math.min(6, column + 2)],
      );
      if (chart.history.done.length > count) seen.push(JSON.stringify(chart.content));
    }
    for (const text of seen.toReversed()) {
      assert.equal(JSON.stringify(chart.content), text);
      chart.undo();
    }
    for (const text of seen.slice(1)) {
      chart.redo();
      assert.equal(JSON.stringify(chart.content), text);
    }
  }
});
