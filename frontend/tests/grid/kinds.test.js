import assert from "node:assert/strict";
import { test } from "node:test";
import { IMAGES, KINDS, KIND_GROUPS, isOther, kindOf, readCodes } from "../../grid/kinds.js";
import { NAMES } from "../../grid/names.js";

test("every stitch of the library has a group, words and images that lead back", () => {
  for (const { code, group, width } of KINDS) {
    assert.ok(NAMES[code].every(Boolean) && KIND_GROUPS.includes(group), code);
    for (const how of ["mirrored", "rotated", "turnedOver", "swapped"]) {
      const image = IMAGES[how](code);
      assert.equal(kindOf(image).width, width);
      assert.equal(IMAGES[how](image), code, `${how} of ${code}`);
    }
  }
  assert.equal(IMAGES.mirrored("/"), "\\");
  assert.equal(IMAGES.mirrored("[2/1RP]"), "[2/1LP]");
  assert.deepEqual([isOther("K"), isOther("P"), isOther("O"), isOther("?")], [false, false, true, false]);
});

test("a text of codes is a chart of knits and purls, and the others", () => {
  assert.deepEqual(readCodes("P[2/2R]P;PKVKKP"), {
    chart: "PKKKKP\nPKKKKP",
    others: [
      [0, 2, "V"],
      [1, 1, "[2/2R]"],
    ],
  });
  assert.equal(readCodes("TK\nPK")?.chart, "PK\nPK", "a tuck looks like the stitch that it holds");
  for (const text of ["", "KX", "KK;K", "[9/9R]"]) assert.equal(readCodes(text), null);
});
