import assert from "node:assert/strict";
import { test } from "node:test";
import { logScale } from "../../state/overlays.js";

test("a logarithmic scale halves ratios", () => {
  const { low, high, at } = logScale([0.01, 1]);
  assert.deepEqual([low, high], [0.01, 1]);
  assert.ok(Math.abs(at(0.1) - 0.5) < 1e-12);
  assert.equal(logScale([2, 2]).at(2), 0);
});
