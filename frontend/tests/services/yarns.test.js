import assert from "node:assert/strict";
import { test } from "node:test";

import { isYarnFile, withGauges, yarnOf } from "../../services/yarns.js";

/** @import {Fabric, FitResult, MaterialDocument} from "../../types.js" */
/** @import {Tests} from "../../services/yarns.js" */

const FIT = /** @type {FitResult} */ (
  /** @type {unknown} */ ({
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
    standard_errors: {
      stiffness_xxxx_n_per_mm: 0.004,
      modulus_course_n_per_mm: 0.005,
      modulus_wale_n_per_mm: 0.006,
      poisson_yx: 0.01,
      poisson_xy: 0.02,
    },
    curves: { course: { strain: [0, 1], stress_n_per_mm: [0, 1], pulls: 2 } },
  })
);
const TESTS = { course: new File([], "a.csv"), wale: new File([], "b.xlsx"), stitches: 20, rows: 25 };

/** @param {...Fabric} fabrics @returns {Map<Fabric, {tests: Tests, fit: FitResult}>} */
const fitted = (...fabrics) => new Map(fabrics.map((fabric) => [fabric, { tests: TESTS, fit: FIT }]));

test("a yarn of fitted tests has their constants, gauge and evidence, under a plain identifier", () => {
  const yarn = yarnOf(null, "Tante Émilie's Wool!", { bending_modulus_n_mm2: 0.04 }, fitted("rib"), ["Five photos."]);
  assert.equal(yarn.identifier, "tante-emilie-s-wool");
  assert.equal(yarn.name, "Tante Émilie's Wool!");
  assert.equal(yarn.yarn?.bending_modulus_n_mm2, 0.04);
  assert.equal(yarn.note, "Five photos.");
  const rib = /** @type {NonNullable<typeof yarn.fabrics.rib>} */ (yarn.fabrics.rib);
  assert.deepEqual([rib.stitch_course_mm, rib.stitch_wale_mm], [5, 4]);
  assert.equal(rib.law.stiffness_yyxx, 0.04);
  assert.equal(rib.law.shear_modulus, 0.02);
  assert.equal(rib.law.kappa_yy, 0.2);
  assert.equal(rib.standard_deviation.modulus_course, 0.005);
  assert.ok(!("stiffness_xxxx" in rib.standard_deviation)); // a yarn's file has no place for it
  assert.equal(rib.measured.course.pulls, 2);
  assert.equal(rib.law_source, "fitted to a.csv and b.xlsx, 0.0012 N/mm rms");
  assert.ok(isYarnFile(yarn));
  assert.ok(!isYarnFile({ format: "knitcore-design" }));
});

test("a changed yarn keeps its identifier, notes and tested fabrics; estimated ones are made anew", () => {
  const first = yarnOf(null, "Wool", {}, fitted("rib", "garter"), ["Five photos."]);
  const base = /** @type {MaterialDocument} */ ({
    ...first,
    fabrics: { ...first.fabrics, seed: { ...first.fabrics.rib, origin: "estimated" } },
  });
  const yarn = yarnOf(base, "My wool", { compression_exponent: 2.4 }, fitted("garter"), ["Five photos.", "A squeeze."]);
  assert.equal(yarn.identifier, "wool");
  assert.equal(yarn.name, "My wool");
  assert.deepEqual(Object.keys(yarn.fabrics).sort(), ["garter", "rib"]);
  assert.equal(yarn.note, "Five photos.\nA squeeze.");
});

test("a gauge changes the size of a stitch, unless it only repeats it, rounded", () => {
  const yarn = yarnOf(null, "Wool", {}, fitted("rib", "garter"));
  const given = withGauges(
    yarn,
    new Map([
      ["rib", { stitches: 20.01, rows: 25 }],
      ["garter", { stitches: 25, rows: 50 }],
    ]),
  );
  assert.equal(given.fabrics.rib, yarn.fabrics.rib);
  assert.deepEqual([given.fabrics.garter?.stitch_course_mm, given.fabrics.garter?.stitch_wale_mm], [4, 2]);
});
