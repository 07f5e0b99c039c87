import assert from "node:assert/strict";
import { test } from "node:test";

import { Grid } from "../../grid/grid.js";
import { limbOf, pieceIn, scopeOf, sizeAtRest } from "../../services/scope.js";

/** @param {Partial<{purl: string, mask: number[]}>} options */
function lassoed({ purl = "KKKK\nKPPK\nKKKK", mask } = {}) {
  const grid = Grid.fromText(purl);
  const box = { row0: 0, row1: 3, column0: 0, column1: 3, mask: mask && Uint8Array.from(mask) };
  const studio = { document: { grid, shaped: false }, selection: { value: box }, seeing: {} };
  return scopeOf(/** @type {import("../../state/studio.js").Studio} */ (/** @type {unknown} */ (studio)));
}

test("numbers of a lasso are those of its stitches, not of the box around it", () => {
  const lasso = lassoed({ mask: [1, 1, 0, 1, 1, 0, 0, 1, 1] });
  assert.equal(lasso.size, "6 stitches");
  assert.deepEqual([lasso.grid.rows, lasso.grid.columns], [2, 2]);
  assert.equal(lasso.counted.mask?.length, 9);
  assert.match(lasso.note, /2 × 2/);
  const box = lassoed();
  assert.deepEqual([box.size, box.note, box.counted.mask], ["3 × 3", "", null]);
});

test("a part is as wide as its widest row and as high as its highest column, without gaps", () => {
  const stitch = { relaxed_course_mm: 5, relaxed_wale_mm: 3 };
  const ends = { relaxed_course_interval_mm: [4, 6], relaxed_wale_interval_mm: [2, 4] };
  const predicted = /** @type {import("../../types.js").PredictResult} */ (
    /** @type {unknown} */ ({ ...stitch, ...ends })
  );
  const { course, wale } = sizeAtRest(lassoed({ mask: [1, 0, 1, 0, 0, 0, 1, 0, 0] }), predicted);
  assert.deepEqual(course, { value: 10, interval: [8, 12] });
  assert.deepEqual(wale, { value: 6, interval: [4, 8] });
});

test("a part is worn as the piece it is, on a limb of its own size", () => {
  const mask = [1, 1, 0, 1, 1, 0, 1, 1, 0];
  const gauges = { of: () => null };
  for (const [scope, outline] of /** @type {const} */ ([
    [lassoed(), null],
    [lassoed({ mask }), "xx.\nxx.\nxx."],
  ])) {
    const studio = {
      gauges,
      materialId: { value: "acrylic" },
      seeing: { limb: { value: { direction: "wale", girths: null } } },
    };
    const page = /** @type {import("../../state/studio.js").Studio} */ (/** @type {unknown} */ (studio));
    const piece = pieceIn(page, scope);
    assert.deepEqual([piece.chart, piece.outline], [scope.counted.grid.text, outline]);
    const stitch = /** @type {import("../../types.js").PredictResult} */ ({
      relaxed_course_mm: 50,
      relaxed_wale_mm: 30,
    });
    const { girths } = limbOf(page, scope, stitch);
    assert.equal(girths[0].girth_mm, Math.round(1.12 * 3 * 30));
    assert.equal(girths.at(-1)?.at_mm, 150);
  }
});
