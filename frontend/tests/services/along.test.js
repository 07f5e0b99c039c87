/** Knitting a piece row by row. */

import assert from "node:assert/strict";
import { test } from "node:test";

import { HOME_MACHINES, WAYS, alongRequest, alongRows, repeatWords, stepOf } from "../../services/along.js";

const content = { chart: "KP", outline: null, regions: [], repeats: [], shelf: [] };
const studio = /** @type {any} */ ({ document: { content } });

test("a way of knitting is a construction by hand, or a machine", () => {
  const { machine, construction } = alongRequest(studio, "round");
  assert.deepEqual([machine, construction], [null, "round"]);
  for (const way of Object.keys(HOME_MACHINES)) assert.equal(alongRequest(studio, way).machine, way);
  assert.ok(Object.keys(WAYS).length > Object.keys(HOME_MACHINES).length);
});

test("repeats of the pattern are counted", () => {
  assert.equal(repeatWords(1, 12, 4), "Repeat 1 of 3, row 1 of 4");
  assert.equal(repeatWords(8, 12, 4), "Repeat 2 of 3, row 4 of 4");
  assert.equal(repeatWords(13, 13, 4), "Repeat 4 of 4, row 1 of 4");
  assert.equal(repeatWords(3, 12, 12), "");
  assert.equal(repeatWords(3, 12, 1), "");
});

test("keys and pedals step", () => {
  assert.deepEqual(["ArrowRight", "PageDown", " ", "ArrowLeft", "PageUp", "x"].map(stepOf), [1, 1, 1, -1, -1, 0]);
});

test("rows that were seen are there when the service is not", async () => {
  /** @type {Map<string, string>} */
  const kept = new Map();
  const storage = {
    getItem: (/** @type {string} */ key) => kept.get(key) ?? null,
    setItem: (/** @type {string} */ key, /** @type {string} */ text) => kept.set(key, text),
  };
  Object.assign(globalThis, { localStorage: storage });
  const away = globalThis.fetch;
  const request = alongRequest(studio, "flat");
  try {
    globalThis.fetch = async () => new Response(JSON.stringify({ rows: ["first"] }));
    await alongRows(request);
    globalThis.fetch = async () => {
      throw new TypeError("away");
    };
    assert.deepEqual(await alongRows(request), { rows: ["first"] });
    await assert.rejects(alongRows(alongRequest(studio, "round")), /cannot be reached/);
  } finally {
    globalThis.fetch = away;
  }
});
