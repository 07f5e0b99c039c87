import assert from "node:assert/strict";
import { test } from "node:test";

import { inNumbers, inShares } from "../../../panels/inspector/narrower.js";

/** @type {import("../../../types.js").PredictResult["narrowing"][number]} */
const STRETCH = {
  quantity: "strain_course",
  n_per_mm: 0.1,
  shares: { "size at rest": 0.93, "surroundings of a stitch": 0.06, "stretch of other yarns": 0.01 },
  now: [1.3, 2.1],
  act: "count",
  how: "count the gauge of your swatch",
  left: [1.49, 1.81],
  fabric: null,
  direction: null,
};

test("a stretch is left with its ends, a size with how far it may be off", () => {
  /** @type {typeof STRETCH} */
  const width = { ...STRETCH, quantity: "relaxed_course_mm", n_per_mm: null, left: [1.9, 2.1] };
  assert.equal(inNumbers([width, STRETCH]), "149 – 181 % along rows, size ±5 %");
  assert.equal(inNumbers([{ ...STRETCH, quantity: "strain_wale" }]), "149 – 181 % along columns");
});

test("parts of an interval are told, the largest first, without the smallest", () => {
  const parts = inShares(STRETCH);
  assert.equal(parts, "93 % size at rest, 6 % surroundings of a stitch");
});
