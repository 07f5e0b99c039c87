import assert from "node:assert/strict";
import { test } from "node:test";
import { TAUT, batlow, taut, vik } from "../../state/colormaps.js";

test("colour maps end where Crameri's end, and take what is outside to the ends", () => {
  assert.deepEqual(batlow.at(0), [1, 25, 89]);
  assert.deepEqual(batlow.at(1), [250, 204, 250]);
  assert.deepEqual(vik.at(0.5), [236, 229, 224]);
  assert.deepEqual(batlow.at(-3), batlow.at(0));
  assert.deepEqual(batlow.at(Number.NaN), batlow.at(0));
});

test("a stitch that runs out of stretch has a colour that no other has", () => {
  const warning = taut.at(TAUT);
  for (let share = 0; share < TAUT; share += 0.01) {
    const distance = Math.hypot(...taut.at(share).map((channel, i) => channel - warning[i]));
    assert.ok(distance > 60, `${share}: ${distance}`);
  }
});
