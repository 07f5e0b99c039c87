import assert from "node:assert/strict";
import { test } from "node:test";
import { batlow, vik } from "../../state/colormaps.js";

test("colour maps end where Crameri's end, and take what is outside to the ends", () => {
  assert.deepEqual(batlow.at(0), [1, 25, 89]);
  assert.deepEqual(batlow.at(1), [250, 204, 250]);
  assert.deepEqual(vik.at(0.5), [236, 229, 224]);
  assert.deepEqual(batlow.at(-3), batlow.at(0));
  assert.deepEqual(batlow.at(Number.NaN), batlow.at(0));
});
