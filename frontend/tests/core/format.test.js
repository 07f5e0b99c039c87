import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { test } from "node:test";
import { figure, percent, percentRange, percents, range, spread, thousands, unbroken } from "../../core/format.js";

test("three figures, with the zeros that count", () => {
  assert.equal(figure(0.223147), "0.223");
  assert.equal(figure(0.056), "0.0560");
  assert.equal(figure(16.12), "16.1");
  assert.equal(figure(0.09998), "0.100");
  assert.equal(figure(1234.5), "1,235");
  assert.equal(figure(999.9), "1,000");
  assert.equal(figure(-0.5), "−0.500");
  assert.equal(figure(0), "0");
  assert.equal(figure(undefined), "–");
  assert.equal(figure(Number.NaN), "–");
});

test("how many there are", () => {
  assert.equal(thousands(8866), "8,866");
  assert.equal(thousands(1000.0), "1,000");
  assert.equal(thousands(0.04), "0");
});

test("intervals and percentages", () => {
  assert.equal(range([0.054, 0.072]), "0.054 – 0.072");
  assert.equal(range([-0.25, -0.1]), "−0.25 to −0.10");
  assert.equal(range(null), "");
  assert.equal(percent(0.3), "30 %");
  assert.equal(percent(-0.064, 1), "−6.4 %");
  assert.equal(percentRange([-0.0072, 0.1352], 1), "−0.7 to 13.5");
  assert.equal(percentRange([0.28, 0.32]), "28 – 32");
  assert.equal(percentRange([]), "");
});

test("shares in percent add up, and what is there is never nothing", () => {
  assert.deepEqual(percents([0.525, 0.475]), ["53 %", "47 %"]);
  assert.deepEqual(percents([1 / 3, 1 / 3, 1 / 3]), ["34 %", "33 %", "33 %"]);
  assert.deepEqual(percents([0.998, 0.002, 0, 0]), ["100 %", "< 1 %", "0 %", "0 %"]);
});

test("an interval that is too wide is said in words", () => {
  assert.deepEqual(spread([100, 300]), { text: "100 – 300", wide: false });
  assert.deepEqual(spread([24, 1656]), { text: "up to 8 times less or more", wide: true });
  assert.deepEqual(spread([0, 2]), { text: "0 – 2.0", wide: false });
});

test("a sentence keeps an interval and its unit together", () => {
  assert.equal(unbroken("then 18 – 20 % along rows"), "then 18\u00a0–\u00a020\u00a0% along rows");
});

test("only here are numbers grouped, and only in one place a hand's pull is named", () => {
  const folder = new URL("../..", import.meta.url);
  const OURS = /^(actions|chart|core|design|grid|panels|plots|services|state|tools|widgets)\/.*\.js$/;
  const files = readdirSync(folder, { recursive: true, encoding: "utf8" }).filter((file) => OURS.test(file));
  const having = (/** @type {RegExp} */ pattern) =>
    files.filter((file) => pattern.test(readFileSync(new URL(file, folder), "utf8")));
  assert.deepEqual(having(/toLocaleString\("en"[,)](?! \{ date)/).sort(), ["core/format.js", "core/plainly.js"]);
  assert.deepEqual(having(/at 0\.1 N\/mm|under 0\.1 N\/mm|pull: 0\.1 N\/mm/), ["core/hand.js"]);
});
