import assert from "node:assert/strict";
import { test } from "node:test";

import { difference } from "../../core/difference.js";

test("a difference is told in percent, or as a factor, and is clear where the intervals do not meet", () => {
  /** @param {number} value @param {number} low @param {number} high */
  const answer = (value, low, high) => ({ value, interval: /** @type {[number, number]} */ ([low, high]) });
  assert.deepEqual(difference(answer(10, 9, 11), answer(13, 12, 14)), { text: "+30 %", clear: true, meet: false });
  assert.deepEqual(difference(answer(10, 8, 12.5), answer(13, 12, 14)), { text: "+30 %", clear: false, meet: true });
  assert.deepEqual(difference(answer(10, 9, 11), answer(8, 7, 8.5)), { text: "−20 %", clear: true, meet: false });
  assert.deepEqual(difference(answer(10, 9, 11), answer(25, 24, 26)), { text: "× 2.5", clear: true, meet: false });
  assert.deepEqual(difference(answer(10, 5, 30), answer(25, 20, 30)), { text: "× 2.5", clear: false, meet: true });
  assert.equal(difference(answer(10, 9, 11), answer(10.01, 9, 11)).text, "the same");
  assert.equal(difference({ value: undefined }, { value: 1 }).text, "–");
});
