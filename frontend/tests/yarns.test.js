import assert from "node:assert/strict";
import { test } from "node:test";

import { isYarnFile, yarnOf } from "../services/yarns.js";

const FIT = {
  stiffness_xxxx_n_per_mm: 0.1,
  stiffness_yyyy_n_per_mm: 0.2,
  stiffness_xxyy_n_per_mm: 0.03,
  stiffness_yyxx_n_per_mm: 0.04,
  alpha_xx: 0.8,
  alpha_yy: 0.9,
  beta_xx_n_per_mm: 0.01,
  beta_yy_n_per_mm: 0.02,
  shear_modulus_n_per_mm: 0.02,
  kappa_xx: 0.1,
  kappa_yy: 0.2,
  rms_n_per_mm: 0.0012,
  standard_errors: { modulus_course_n_per_mm: 0.005, modulus_wale_n_per_mm: 0.006, poisson_yx: 0.01, poisson_xy: 0.02 },
  curves: { course: { strain: [0, 1], stress_n_per_mm: [0, 1], pulls: 2 } },
};

test("a yarn of fitted tests has their constants, gauge and evidence, under a plain identifier", () => {
  const tests = { course: new File([], "a.csv"), wale: new File([], "b.csv"), stitches: 20, rows: 25 };
  const fabrics = new Map([["rib", { tests, fit: FIT }]]);
  const yarn = yarnOf(
    "Tante Émilie's Wool!",
    /** @type {Parameters<typeof yarnOf>[1]} */ (/** @type {unknown} */ (fabrics)),
  );
  assert.equal(yarn.identifier, "tante-emilie-s-wool");
  assert.equal(yarn.name, "Tante Émilie's Wool!");
  const rib = /** @type {NonNullable<typeof yarn.fabrics.rib>} */ (yarn.fabrics.rib);
  assert.deepEqual([rib.stitch_course_mm, rib.stitch_wale_mm], [5, 4]);
  assert.equal(rib.law.stiffness_yyxx, 0.04);
  assert.equal(rib.law.shear_modulus, 0.02);
  assert.equal(rib.law.kappa_yy, 0.2);
  assert.equal(rib.standard_deviation.modulus_course, 0.005);
  assert.equal(rib.measured.course.pulls, 2);
  assert.match(yarn.note, /rib: a\.csv, b\.csv; rms 0\.0012 N\/mm/);
  assert.ok(isYarnFile(yarn));
  assert.ok(!isYarnFile({ format: "knitcore-design" }));
});
