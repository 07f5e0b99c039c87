import assert from "node:assert/strict";
import { test } from "node:test";
import { firstLock, table } from "../../core/striptest.js";

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
/** @param {number | null} value @param {number} expected */
const near = (value, expected) =>
  assert.ok(value !== null && Math.abs(value - expected) < 1e-12, `${value}, not ${expected}`);

test("the first stitch locks at a strain and a force, if one does", () => {
  const lock = firstLock(TEST);
  near(lock && lock.strain, 0.25);
  near(lock && lock.force, 3);
  assert.equal(firstLock({ ...TEST, stitch_fields: { utilisation: [[0.2], [0.4], [0.9]] } }), null);
  assert.equal(firstLock({ strain: [0.1], force_n: [1] }), null);
});

test("a test is a table of its steps with their intervals", () => {
  const steps = {
    strain: [0.1, 0.2],
    force_n: [1, 2],
    force_interval_n: /** @type {[number[], number[]]} */ ([
      [0.5, 1.5],
      [2, 3],
    ]),
    stress_n_per_mm: [0.01, 0.02],
    waist_strain: [-0.1, -0.2],
    waist_strain_interval: /** @type {[number[], number[]]} */ ([
      [-0.3, -0.4],
      [0, -0.1],
    ]),
  };
  assert.deepEqual(table(steps).split("\n"), [
    "strain,force_n,force_low_n,force_high_n,stress_n_per_mm,waist_strain,waist_strain_low,waist_strain_high",
    "0.1,1,0.5,2,0.01,-0.1,-0.3,0",
    "0.2,2,1.5,3,0.02,-0.2,-0.4,-0.1",
    "",
  ]);
});
