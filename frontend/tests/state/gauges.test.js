import assert from "node:assert/strict";
import { test } from "node:test";

import { Gauges } from "../../state/gauges.js";

const RIB = { chart: "KP", material: "acrylic" };
const COUNTED = { stitches_per_10_cm: 25, rows_per_10_cm: 36 };

test("a gauge belongs to the stitches and the yarn it was counted on", () => {
  const gauges = new Gauges();
  gauges.keep(RIB, COUNTED);
  assert.equal(gauges.of(RIB), COUNTED);
  assert.equal(gauges.of({ ...RIB, chart: "KK" }), null);
  assert.equal(gauges.of({ ...RIB, material: "cotton" }), null);
});

test("a gauge can be taken back, and both are heard", () => {
  const gauges = new Gauges();
  let heard = 0;
  gauges.changes.listen(() => heard++);
  gauges.keep(RIB, COUNTED);
  gauges.keep(RIB, null);
  assert.equal(gauges.of(RIB), null);
  assert.equal(heard, 2);
});
