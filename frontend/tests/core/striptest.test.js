import assert from "node:assert/strict";
import { test } from "node:test";
import { atStitches, lockUpInWords, table } from "../../core/striptest.js";

/** @type {Parameters<typeof lockUpInWords>[0]} */
const TEST = {
  strain: [0.5, 1.2],
  force_n: [10, 200],
  force_interval_n: [
    [8, 24],
    [12, 1656],
  ],
  first_taut: { strain: 1.11, force_n: 148 },
  tightest: 0.97,
};

test("one sentence says where the first stitch runs out of stretch, and how well the force is known", () => {
  assert.equal(
    lockUpInWords(TEST),
    "The tightest stitches run out of stretch at 111 % (148 N, which may be up to 8 times less or more).",
  );
  const taut = { strain: 0.4, force_n: 8 };
  assert.equal(
    lockUpInWords({ ...TEST, first_taut: taut }),
    "The tightest stitches run out of stretch at 40 % (8.00 N).",
  );
  assert.equal(
    lockUpInWords({ ...TEST, first_taut: null, tightest: 0.82 }),
    "No stitch runs out of stretch: the tightest has used 82 % of it.",
  );
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

test("stitches have the values of their blocks", () => {
  const [values, size] = [[1, 2, 3, 4], { rows: 3, columns: 4 }];
  assert.equal(atStitches({ ...size, block: 1 }, values), values);
  const all = atStitches({ ...size, block: 2 }, values);
  assert.deepEqual(all, [1, 1, 2, 2, 1, 1, 2, 2, 3, 3, 4, 4]);
  assert.equal(atStitches({ ...size, block: 2 }, values), all);
});
