import assert from "node:assert/strict";
import { test } from "node:test";

import { inNumbers, inShares } from "../../../panels/inspector/narrower.js";

const NARROWING = /** @type {const} */ ({
  quantity: "strain_course",
  n_per_mm: 0.1,
  shares: { "size at rest": 0.93, "surroundings of a stitch": 0.06, "stretch of other yarns": 0.01 },
  interval: [1.3, 2.1],
  act: "count",
  how: "count the gauge of your swatch",
  left: [1.49, 1.81],
  fabric: null,
  direction: null,
});

test("a stretch is left with its ends, a size with how far it may be off", () => {
  assert.equal(inNumbers({ ...NARROWING, interval: [1.3, 2.1], left: [1.49, 1.81] }), "stretch along rows 149 – 181 %");
  const width = { ...NARROWING, quantity: "relaxed_course_mm", n_per_mm: null };
  assert.equal(inNumbers({ ...width, interval: [1.9, 2.6], left: [1.9, 2.1] }), "width ±5 %");
});

test("parts of an interval are told, the largest first, without the smallest", () => {
  const parts = inShares({ ...NARROWING, interval: [1.3, 2.1], left: [1.49, 1.81] });
  assert.equal(parts, "93 % size at rest, 6 % surroundings of a stitch");
});
