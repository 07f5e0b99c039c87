import assert from "node:assert/strict";
import { test } from "node:test";
import { Grid } from "../../grid/grid.js";
import { QUARTERS, countSegments, fabricShares, surroundings } from "../../grid/segments.js";
import { random } from "../random.js";

test("the codes agree with the Python library's examples", () => {
  assert.deepEqual([...surroundings(Grid.fromText("KKP"))], [0, 2, 3]);
  assert.deepEqual([...surroundings(Grid.fromText("K"))], [0]);
  assert.deepEqual([...surroundings(Grid.fromText("KP\nKP"))], [3, 3, 3, 3]);
});

test("pure fabrics are pure up to their edges", () => {
  /** @type {[string, number[]][]} */
  const fabrics = [
    ["K", [1, 0, 0, 0]],
    ["P\nK", [0, 1, 0, 0]],
    ["KP", [0, 0, 1, 0]],
    ["PK\nKP", [0, 0, 0, 1]],
  ];
  for (const [repeat, shares] of fabrics) {
    assert.deepEqual(fabricShares(surroundings(Grid.fromText(repeat).tiled(7, 5))), shares);
  }
});

test("counts of a rib: all course-wise segments odd, all wale-wise ones even", () => {
  assert.deepEqual(countSegments(Grid.fromText("KPKP\nKPKP\nKPKP")), {
    course: { even: 0, odd: 9 },
    wale: { even: 8, odd: 0 },
  });
});

test("turning over keeps the numbers of segments and the shares of fabrics", () => {
  for (let seed = 1; seed < 30; seed++) {
    const grid = random(seed);
    const turned = grid.turnedOver();
    assert.deepEqual(countSegments(turned), countSegments(grid));
    assert.deepEqual(
      fabricShares(surroundings(turned)).map((share) => share.toFixed(9)),
      fabricShares(surroundings(grid)).map((share) => share.toFixed(9)),
    );
  }
});

test("quarters: a stitch between odd segments left and below is half of everything", () => {
  assert.deepEqual(QUARTERS[0], [0, 0, 0, 0]);
  assert.deepEqual(QUARTERS[15], [3, 3, 3, 3]);
  assert.deepEqual(QUARTERS[1 + 4], [3, 1, 2, 0]);
});

test("segments and shares of a shaped chart are of its stitches alone", () => {
  const grid = Grid.fromText("KPK\nPPP\nKPK");
  const outline = Uint8Array.of(0, 1, 1, 1, 1, 1, 0, 1, 0); // the lowest row first
  assert.deepEqual(countSegments(grid, outline), { course: { even: 2, odd: 1 }, wale: { even: 2, odd: 1 } });
  const shares = fabricShares(surroundings(grid, outline), outline);
  assert.equal(shares.reduce((sum, share) => sum + share).toFixed(12), "1.000000000000");
  const junk = Grid.fromText("PPP\nPPP\nPPK");
  assert.deepEqual(countSegments(junk, outline), countSegments(grid, outline));
  assert.deepEqual(fabricShares(surroundings(junk, outline), outline), shares);
});
