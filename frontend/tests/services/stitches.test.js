import assert from "node:assert/strict";
import { test } from "node:test";
import { contentOf } from "../../design/design.js";
import { ChartDocument } from "../../design/document.js";
import { scopeIn } from "../../services/scope.js";
import { plainWords, stitchesIn } from "../../services/stitches.js";

/** @param {string} chart @param {{row: number, column: number, codes: string}[]} runs @param {Partial<import("../../design/design.js").Content>} [more] */
const made = (chart, runs, more = {}) => ChartDocument.read(contentOf(chart, { other_stitches: runs, ...more }));

/** @param {ChartDocument} document @param {string | null} [region] */
const sent = (document, region = null) => stitchesIn({ document }, scopeIn(document, region));

const LACE = [{ row: 1, column: 1, codes: "O/" }];

test("a chart with lace is sent as codes, one without as K and P", () => {
  assert.deepEqual(sent(made("KKKP\nKKKP", [])), { chart: "KKKP\nKKKP", note: "", problem: null });
  assert.deepEqual(sent(made("KKKP\nKKKP", LACE)), { chart: "KO/P;\nKKKP", note: "", problem: null });
});

test("a row that does not balance is said before the service is asked", () => {
  const { problem } = sent(made("KKKP\nKKKP", [{ row: 1, column: 1, codes: "O" }]));
  assert.match(problem?.detail ?? "", /Row 2 takes 3 stitches, row 1 has 4/);
});

test("where only the knits and purls can be sent, it is said", () => {
  const shaped = sent(made("KKKP\nKKKP", LACE, { outline: "xxxx\nxxx." }));
  assert.match(shaped.note, /outline/);
  assert.doesNotMatch(shaped.chart, /O/);
  const look = { colour: "#112233", yarn: null, fill: null, locked: false, hidden: false };
  const part = { ...look, id: "a", name: "A", runs: /** @type {[number, number, number][]} */ ([[1, 0, 2]]) };
  const whole = { ...part, id: "b", runs: /** @type {[number, number, number][]} */ ([[1, 1, 2]]) };
  const chart = made("KKKP\nKKKP", LACE, { regions: [part, whole] });
  assert.match(sent(chart, "a").note, /cuts/);
  assert.equal(sent(chart, "a").chart, "KK");
  assert.deepEqual(sent(chart, "b"), { chart: "O/", note: "", problem: null });
  const studio = /** @type {import("../../state/studio.js").Studio} */ (/** @type {unknown} */ ({ document: chart }));
  assert.match(plainWords(studio, "The test"), /^The test is of this chart's knits and purls/);
});
