import assert from "node:assert/strict";
import { test } from "node:test";

import { inKnittersWords, stepCells, texOf } from "../../services/swatches.js";

/** @param {number} loop @param {number} wale */
const step = (loop, wale) => {
  /** @param {number} value @returns {{value: number, value_interval: [number, number]}} */
  const known = (value) => ({ value, value_interval: [0.9 * value, 1.1 * value] });
  return {
    name: "library",
    loop_length_mm: known(loop),
    bending_modulus_n_mm2: known(0.05),
    strain_at_0_1_n_per_mm: { course: known(0.6), wale: known(wale) },
    modulus_n_per_mm: { course: known(0.1), wale: known(0.3) },
    other_fabrics_factor: 1.7,
  };
};

test("a ball's weight and length are its tex, if both are known", () => {
  assert.equal(texOf(50, 125), 400);
  assert.equal(texOf(50, NaN), null);
});

test("a step says what is known after it, and what it brought", () => {
  const cells = stepCells(step(12, 0.2), step(12, 0.16));
  assert.deepEqual(
    cells.map(({ brought }) => brought),
    [false, false, false, true],
  );
  assert.equal(cells[0].words, "12.0 mm (10.8 to 13.2)");
  assert.equal(cells[3].words, "20 % (18 to 22)");
  assert.ok(stepCells(step(12, 0.2), null).every(({ brought }) => !brought));
});

test("directions are those of rows and columns", () => {
  assert.equal(inKnittersWords("photos, pulled course-wise"), "photos, pulled along the rows");
});
