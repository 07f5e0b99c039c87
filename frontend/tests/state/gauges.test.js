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

test("counted gauges outlast the page, relaxed ones do not", () => {
  const kept = new Map();
  globalThis.localStorage = /** @type {any} */ ({
    getItem: (/** @type {string} */ key) => kept.get(key) ?? null,
    setItem: (/** @type {string} */ key, /** @type {string} */ text) => kept.set(key, text),
  });
  const gauges = new Gauges();
  gauges.keep(RIB, COUNTED);
  gauges.keep({ ...RIB, chart: "KK" }, { ...COUNTED, known_by: "relaxation" });
  const again = new Gauges();
  assert.deepEqual(again.of(RIB), COUNTED);
  assert.equal(again.of({ ...RIB, chart: "KK" }), null);
});
