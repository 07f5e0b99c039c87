import assert from "node:assert/strict";
import { test } from "node:test";
import { balanceWords, imbalances, remediesOf } from "../../design/balance.js";
import { contentOf } from "../../design/design.js";
import { ChartDocument } from "../../design/document.js";
import { MOTIFS } from "../../design/motifs.js";
import { Others, codesText, written } from "../../design/others.js";
import { KIND_GROUPS, readCodes } from "../../grid/kinds.js";

/** @param {string} codes */
function made(codes) {
  const read = /** @type {NonNullable<ReturnType<typeof readCodes>>} */ (readCodes(codes));
  const columns = read.chart.indexOf("\n") < 0 ? read.chart.length : read.chart.indexOf("\n");
  const others = Others.of(read.others.map(([row, column, code]) => [row * columns + column, code]));
  return ChartDocument.read(contentOf(read.chart, { other_stitches: written(others, columns) }));
}

test("rows that do not balance are told with what is too many", () => {
  const chart = made("O/KKKK;OOKKK/;^KKKKK;KKKKKK");
  assert.deepEqual(imbalances(chart), [
    { row: 1, over: 2 },
    { row: 2, over: -1 },
  ]);
  assert.equal(balanceWords({ row: 1, over: 2 }, 6), "Row 2 takes 8 stitches, row 1 has 6: 2 decreases too many.");
  assert.equal(
    balanceWords({ row: 0, over: -1 }, 6),
    "Row 1 takes 5 stitches, the cast-on has 6: a yarn over too many.",
  );
  assert.deepEqual(imbalances(made("KP;PK")), []);
});

for (const codes of ["/KKK", "OKKK", "^KKKK", "OOKKK", "^O/KKK", "K/K;KKK", "JKKK", "KKKK;O/OK", "L/KKKKK"]) {
  test(`each remedy mends ${codes}, in one step`, () => {
    const chart = made(codes);
    const before = codesText(chart.grid, chart.others);
    const [imbalance] = imbalances(chart);
    const remedies = remediesOf(chart, imbalance);
    assert.equal(remedies.length, 2);
    for (const { words, cells, put } of remedies) {
      chart.set(cells, words, "stitches", put);
      assert.deepEqual(imbalances(chart), [], words);
      chart.undo();
      assert.equal(codesText(chart.grid, chart.others), before);
    }
  });
}

test("every motif balances and has a group", () => {
  for (const { name, codes, group } of MOTIFS) {
    assert.ok(readCodes(codes), name);
    assert.deepEqual(imbalances(made(codes)), [], name);
    assert.ok(KIND_GROUPS.includes(group));
  }
});
