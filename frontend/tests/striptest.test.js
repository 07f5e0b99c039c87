import assert from "node:assert/strict";
import { test } from "node:test";
import { firstLock, further, strainAt } from "../core/striptest.js";

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

test("a force is reached between the steps, from rest on, or not at all", () => {
  near(strainAt(TEST, 3), 0.25);
  near(strainAt(TEST, 0.5), 0.05);
  near(strainAt(TEST, 4), 0.3);
  assert.equal(strainAt(TEST, 4.1), null);
});

test("what falls short is pulled further along its last slope, but not recklessly", () => {
  near(further(TEST, 5), 0.3 + 1.02 / 20);
  near(further(TEST, 500), 0.54);
});

test("the first stitch locks at a strain and a force, if one does", () => {
  const lock = firstLock(TEST);
  near(lock && lock.strain, 0.25);
  near(lock && lock.force, 3);
  assert.equal(firstLock({ ...TEST, stitch_fields: { utilisation: [[0.2], [0.4], [0.9]] } }), null);
  assert.equal(firstLock({ strain: [0.1], force_n: [1] }), null);
});
