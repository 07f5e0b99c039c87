import assert from "node:assert/strict";
import { test } from "node:test";
import { firstLock } from "../core/striptest.js";

const TEST = {
  strain: [0.1, 0.2, 0.3],
  force_n: [1, 2, 4],
  stitch_fields: {
    utilisation: [
      [0.2, 0.3],
      [0.5, 0.75],
      [0.7, 1.15],
    ],
  },
};
/** @param {number | null} value @param {number} wanted */
const near = (value, wanted) =>
  assert.ok(value !== null && Math.abs(value - wanted) < 1e-12, `${value}, not ${wanted}`);

test("the first stitch locks at a strain and a force, if one does", () => {
  const lock = firstLock(TEST);
  near(lock && lock.strain, 0.25);
  near(lock && lock.force, 3);
  assert.equal(firstLock({ ...TEST, stitch_fields: { utilisation: [[0.2], [0.4], [0.9]] } }), null);
  assert.equal(firstLock({ strain: [0.1], force_n: [1] }), null);
});
