import assert from "node:assert/strict";
import { test } from "node:test";
import { contentOf, readDesign, salvageContent } from "../../design/design.js";
import { ChartDocument } from "../../design/document.js";
import { History } from "../../design/history.js";
import { Grid, motifGrid } from "../../grid/grid.js";
import { deleted, inserted, resized, turned } from "../../design/reshape.js";
import { random } from "../random.js";

const WHOLE = {
  format: "knitcore-design",
  version: 2,
  name: "Cuff",
  material: "acrylic",
  note: "warm",
  machine: "kniterate",
  chart: "KPKP\nPKPK\nKKKK",
  other_stitches: [],
  outline: "xxx.\nxxxx\nxxxx",
  regions: [
    {
      id: "r",
      name: "Rib",
      colour: "#3b6fb6",
      yarn: null,
      fill: "KP",
      runs: [
        [0, 1, 2],
        [2, 0, 1],
      ],
      locked: false,
      hidden: true,
    },
  ],
  repeats: [
    {
      id: "seed",
      name: "Seed",
      motif: "KP/PK",
      edge_columns: 0,
      edge_rows: 0,
      placements: [{ row: 1, column: 0, rows: 2, columns: 4 }],
    },
  ],
  shelf: [{ name: "Mine", motif: "KKP" }],
};

/**
 * Set stitches.
 *
 * @param {ChartDocument} chart
 * @param {Record<number, number>} values by index
 * @param {string} label
 * @param {Parameters<ChartDocument["set"]>[2]} [target]
 */
function paint(chart, values, label, target) {
  const cells = Object.entries(values).map(([i, value]) => /** @type {[number, number]} */ ([Number(i), value]));
  chart.set(cells, label, target);
}

/** @param {ChartDocument} chart */
const undoAll = (chart) => {
  while (chart.undo());
  return chart.content;
};

test("a whole document is read, held and written the same", () => {
  const document = readDesign(WHOLE);
  assert.deepEqual(document, WHOLE);
  const { format, version, name, material, note, machine, ...content } = WHOLE;
  assert.deepEqual(ChartDocument.read(document).content, content);
  assert.deepEqual([format, version, name, material, note], ["knitcore-design", 2, "Cuff", "acrylic", "warm"]);
  assert.equal(machine, "kniterate");
  assert.equal(readDesign({ ...WHOLE, machine: 3 }).machine, null);
});

test("what is wrong with a file is said in words", () => {
  /** @type {[object, RegExp][]} */
  const wrong = [
    [{ chart: "KP" }, /not a design/],
    [{ ...WHOLE, version: 3 }, /version 3/],
    [{ ...WHOLE, version: 1 }, /version 1/],
    [{ ...WHOLE, chart: "KP\nK" }, /rows of K and P/],
    [{ ...WHOLE, chart: "K".repeat(401) }, /401 stitches/],
    [{ ...WHOLE, outline: "xx" }, /outline/],
    [{ ...WHOLE, regions: [{ ...WHOLE.regions[0], runs: [[0, 3, 2]] }] }, /Region Rib reaches beyond/],
    [{ ...WHOLE, regions: [{ ...WHOLE.regions[0], colour: "red" }] }, /colour of region Rib/],
    [{ ...WHOLE, regions: [WHOLE.regions[0], WHOLE.regions[0]] }, /one id/],
    [{ ...WHOLE, repeats: [{ ...WHOLE.repeats[0], motif: "KP/P" }] }, /motif of repeat Seed/],
    [
      { ...WHOLE, repeats: [{ ...WHOLE.repeats[0], placements: [{ row: 2, column: 0, rows: 2, columns: 4 }] }] },
      /reaches beyond the chart/,
    ],
    [{ ...WHOLE, shelf: "none" }, /not a list/],
  ];
  for (const [value, message] of wrong) assert.throws(() => readDesign(value), message);
});

test("a damaged design in the browser keeps its chart and all that is readable", () => {
  const damaged = { ...WHOLE, repeats: [{ motif: 7 }] };
  const content = salvageContent(damaged);
  assert.equal(content?.chart, WHOLE.chart);
  assert.equal(content?.regions.length, 1);
  assert.deepEqual(content?.repeats, []);
  assert.equal(salvageContent({ chart: "KX" }), null);
});

test("no stitch: it cannot be painted, and is an edge for its neighbours", () => {
  const chart = new ChartDocument(Grid.fromText("KKP\nKKP"));
  paint(chart, { 2: 0, 5: 0 }, "Outline", "outline");
  assert.equal(chart.content.outline, "xx.\nxx.");
  assert.deepEqual([...chart.codes.filter((_, i) => i % 3 < 2)], [0, 0, 0, 0]);
  paint(chart, { 2: 0, 1: 1 }, "Pencil");
  assert.equal(chart.grid.text, "KKP\nKPP");
  chart.undo();
  chart.undo();
  assert.equal(chart.content.outline, null);
  chart.redo();
  assert.equal(chart.content.outline, "xx.\nxx.");
});

test("a region is painted, filled, locked, ordered, renamed and removed, and all of it undone", () => {
  const chart = new ChartDocument(new Grid(3, 4));
  const start = chart.content;
  const low = chart.addRegion({ name: "Low", colour: "#336699", fill: Grid.fromText("KP") }, [0, 1, 2, 3]);
  assert.equal(chart.grid.text, "KKKK\nKKKK\nKPKP");
  const high = chart.addRegion({ name: "High", colour: "#993333" }, [1, 5]);
  assert.equal(chart.regionAt(1)?.id, high);
  paint(chart, { 4: 1, 6: 1, 1: 0 }, "Brush", `region:${low}`);
  assert.deepEqual(chart.region(low)?.written(4).runs, [
    [0, 0, 1],
    [0, 2, 2],
    [1, 0, 1],
    [1, 2, 1],
  ]);
  assert.equal(chart.grid.text, "KKKK\nKKKK\nKPKP", "the fill has knits there");
  chart.changeRegion(low, { locked: true }, "Lock");
  /** @type {string[][]} */
  const refused = [];
  chart.onRefuse((names) => refused.push(names));
  paint(chart, { 0: 1, 11: 1 }, "Pencil");
  assert.equal(chart.grid.text, "KKKP\nKKKK\nKPKP");
  assert.deepEqual(refused, [["Low"]]);
  chart.set([[5, 1]], "Brush", `region:${low}`);
  assert.equal(chart.region(low)?.cells[5], 0);
  chart.orderRegion(low, 1);
  assert.deepEqual(
    chart.regions.map(({ name }) => name),
    ["High", "Low"],
  );
  chart.changeRegion(low, { locked: false, name: "Cuff", fill: Grid.fromText("P") }, "Fill");
  assert.equal(chart.grid.text, "KKKP\nPKPK\nPPPP");
  chart.removeRegion(high);
  const end = chart.content;
  const kept = chart.history.serialised(1e6);
  assert.deepEqual(undoAll(chart), start);
  while (chart.redo());
  assert.deepEqual(chart.content, end);

  const reloaded = ChartDocument.read(end, History.parse(kept));
  assert.deepEqual(undoAll(reloaded), start);
});

test("a fill does not cover a filled region above it", () => {
  const chart = new ChartDocument(new Grid(1, 4));
  const low = chart.addRegion({ name: "Low", colour: "#336699" }, [0, 1, 2, 3]);
  chart.addRegion({ name: "High", colour: "#993333", fill: Grid.fromText("K") }, [1, 2]);
  chart.changeRegion(low, { fill: Grid.fromText("P") }, "Fill");
  assert.equal(chart.grid.text, "PKKP");
});

test("a filled region that is put above another one covers it, and only there", () => {
  const chart = new ChartDocument(new Grid(1, 5));
  const low = chart.addRegion({ name: "Low", colour: "#336699", fill: Grid.fromText("P") }, [0, 1, 2]);
  const high = chart.addRegion({ name: "High", colour: "#993333", fill: Grid.fromText("K") }, [2, 3]);
  paint(chart, { 0: 0, 3: 1 }, "Pencil");
  assert.equal(chart.grid.text, "KPKPK");
  chart.orderRegion(low, 1);
  assert.equal(chart.grid.text, "KPPPK", "what was painted on the fills stays");
  chart.orderRegion(low, 0);
  assert.equal(chart.grid.text, "KPKPK");
  chart.undo();
  chart.undo();
  assert.equal(chart.grid.text, "KPKPK");
  assert.equal(chart.regionAt(2)?.id, high);
});

test("painting one copy of a repeat paints all, and the motif follows", () => {
  const chart = new ChartDocument(new Grid(4, 7));
  const start = chart.content;
  const id = chart.addRepeat({
    name: "Rib",
    motif: Grid.fromText("KKP"),
    edgeColumns: 1,
    placements: [
      { row: 0, column: 0, rows: 2, columns: 7 },
      { row: 3, column: 3, rows: 1, columns: 4 },
    ],
  });
  assert.equal(chart.grid.text, "KKKKKPK\nKKKKKKK\nKKPKKPK\nKKPKKPK");
  paint(chart, { 1: 1, 14: 1 }, "Pencil");
  assert.equal(chart.grid.text, "KKKKPPK\nPKKKKKK\nKPPKPPK\nKPPKPPK");
  assert.equal(chart.content.repeats[0].motif, "KPP");
  chart.changeRepeat(id, { motif: Grid.fromText("PKK") }, "Motif");
  assert.equal(chart.grid.text, "KKKPKKP\nPKKKKKK\nPKKPKKP\nPKKPKKP");
  chart.removeRepeat(id);
  chart.set([[0, 0]], "Pencil");
  assert.equal(chart.grid.text, "KKKPKKP\nPKKKKKK\nPKKPKKP\nKKKPKKP");
  const end = chart.content;
  const reloaded = ChartDocument.read(end, History.parse(chart.history.serialised(1e6)));
  assert.deepEqual(undoAll(chart), start);
  assert.deepEqual(undoAll(reloaded), start);
  while (chart.redo());
  assert.deepEqual(chart.content, end);
});

test("a locked region keeps all copies of what is linked to it", () => {
  const chart = new ChartDocument(new Grid(1, 6));
  chart.addRepeat({ name: "A", motif: Grid.fromText("KK"), placements: [{ row: 0, column: 0, rows: 1, columns: 6 }] });
  const region = chart.addRegion({ name: "Locked", colour: "#336699" }, [0]);
  chart.changeRegion(region, { locked: true }, "Lock");
  paint(chart, { 2: 1, 3: 1 }, "Pencil");
  assert.equal(chart.grid.text, "KPKPKP");
});

test("sizes of placements snap to n·k + m", () => {
  const chart = new ChartDocument(new Grid(9, 20));
  const id = chart.addRepeat({ name: "A", motif: motifGrid("KKKKKKKP/KKKKKKPP"), edgeColumns: 1 });
  const repeat = chart.repeat(id);
  assert.deepEqual(repeat?.snapped(5, 20), { rows: 6, columns: 17 });
  assert.deepEqual(repeat?.snapped(1, 1), { rows: 2, columns: 9 });
  assert.equal(repeat?.rule, "multiple of 8 + 1 sts × 2 rows");
});

test("rows, columns and turns carry outline, regions and repeats along, and are undone", () => {
  const chart = ChartDocument.read(readDesign(WHOLE));
  const start = chart.content;
  chart.reshape("Insert", inserted(chart.grid, "rows", 1, 2, "before"));
  assert.equal(chart.grid.text, "KPKP\nPKPK\nKKKK\nKKKK\nKKKK");
  assert.deepEqual(chart.content.regions[0].runs, [
    [0, 1, 2],
    [1, 1, 2],
    [2, 1, 2],
    [4, 0, 1],
  ]);
  assert.equal(chart.content.outline, "xxx.\nxxxx\nxxxx\nxxxx\nxxxx");
  assert.deepEqual(chart.content.repeats[0].placements, [{ row: 3, column: 0, rows: 2, columns: 4 }]);
  chart.reshape("Delete", deleted(chart.grid, "rows", 1, 3));
  assert.deepEqual(chart.content, start);
  chart.reshape("Turn over", turned(chart.grid, "turnedOver"));
  assert.equal(chart.grid.text, "KPKP\nPKPK\nPPPP");
  assert.equal(chart.content.outline, ".xxx\nxxxx\nxxxx");
  assert.deepEqual(chart.content.repeats[0].placements, [{ row: 1, column: 0, rows: 2, columns: 4 }]);
  chart.reshape("Resize", resized(chart.grid, 4, 5, [1, 1]));
  assert.equal(chart.grid.text, "KKPKP\nKPKPK\nKPPPP\nKKKKK");
  /** @type {string[][]} */
  const torn = [];
  chart.onTear((names) => torn.push(names));
  chart.reshape("Insert", inserted(chart.grid, "rows", 0, 1, "before"));
  chart.undo();
  assert.deepEqual(torn, [], "copies that stay whole are not told of");
  chart.reshape("Delete", deleted(chart.grid, "columns", 2, 3));
  assert.deepEqual(chart.content.repeats[0].placements, [], "a torn copy is unlinked");
  assert.deepEqual(torn, [[chart.repeats[0].name]]);
  assert.deepEqual(undoAll(chart), start);
});

test("a mirrored repeat with an edge stays a repeat", () => {
  for (const how of /** @type {const} */ (["mirrored", "flipped", "rotated", "turnedOver", "swapped"])) {
    const chart = new ChartDocument(new Grid(5, 8));
    const placements = [{ row: 0, column: 1, rows: 5, columns: 7 }];
    chart.addRepeat({ name: "A", motif: motifGrid("KKP/KPP"), edgeColumns: 1, edgeRows: 1, placements });
    chart.reshape("Turn", turned(chart.grid, how));
    assert.equal(chart.repeats[0].placements.length, 1, how);
    chart.set([[3, 1 - chart.grid.purl[3]]], "Pencil");
    assert.ok(
      chart.grid
        .region({
          row0: 0,
          row1: 5,
          column0: chart.repeats[0].placements[0].column,
          column1: chart.repeats[0].placements[0].column + 7,
        })
        .equals(chart.repeats[0].laid({ rows: 5, columns: 7 })),
      how,
    );
  }
});

test("turning twice gives everything back", () => {
  for (let seed = 1; seed < 20; seed++) {
    const chart = new ChartDocument(random(seed));
    chart.addRegion({ name: "R", colour: "#336699" }, [0]);
    const start = chart.content;
    for (const how of /** @type {const} */ (["mirrored", "flipped", "rotated", "turnedOver", "swapped"])) {
      chart.reshape("Turn", turned(chart.grid, how));
      chart.reshape("Turn", turned(chart.grid, how));
      assert.deepEqual(chart.content, start, how);
    }
  }
});

test("a new chart keeps regions of the same size, unlinks what no longer repeats, and is undone", () => {
  const chart = ChartDocument.read(readDesign(WHOLE));
  const start = chart.content;
  chart.replace(Grid.fromText("PPPP\nPPPP\nPPPP"), "Import");
  assert.equal(chart.regions.length, 1);
  assert.deepEqual(chart.content.repeats[0].placements, []);
  chart.replace(Grid.fromText("KP"), "Import");
  assert.deepEqual([chart.content.outline, chart.content.regions], [null, []]);
  assert.equal(chart.content.shelf.length, 1);
  assert.deepEqual(undoAll(chart), start);
});

test("steps of earlier pages can still be undone", () => {
  const kept = JSON.stringify({
    done: [
      { label: "New", before: "KK", after: "K" },
      { label: "Pencil", runs: [0, 1] },
    ],
    undone: [],
  });
  const chart = ChartDocument.read(contentOf("P"), History.parse(kept));
  chart.undo();
  assert.equal(chart.grid.text, "K");
  chart.undo();
  assert.equal(chart.grid.text, "KK");
});
