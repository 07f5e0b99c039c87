/** Knitting a piece row by row. */

import assert from "node:assert/strict";
import { test } from "node:test";

import { Places, alongRequest, alongRows, repeatWords, stepOf, waysOf } from "../../services/along.js";

const content = { chart: "KP", outline: null, regions: [], repeats: [], shelf: [] };
const OWN = '{"identifier": "attic", "name": "My Passap", "dialect": "hand"}';
const studio = /** @type {any} */ ({
  document: { content },
  machine: { value: OWN },
  materialId: { value: "acrylic" },
});
const MACHINES = [
  { identifier: "brother", name: "Brother", reads_programs: false },
  { identifier: "kniterate", name: "Kniterate", reads_programs: true },
];

test("a way of knitting is a construction by hand, or a home machine of the service or the user's", () => {
  const { machine, construction } = alongRequest(studio, "round");
  assert.deepEqual([machine, construction], [null, "round"]);
  assert.deepEqual(Object.keys(waysOf(MACHINES, OWN)), ["flat", "round", "brother", "attic"]);
  assert.deepEqual(Object.keys(waysOf(MACHINES, "kniterate")), ["flat", "round", "brother"]);
  assert.equal(alongRequest(studio, "brother").machine, "brother");
  assert.equal(alongRequest(studio, "attic").machine, OWN);
});

/** A browser's storage, and a service that answers. @param {(path: string, method: string, body: string) => unknown} answer */
function world(answer) {
  /** @type {Map<string, string>} */
  const kept = new Map();
  const storage = {
    getItem: (/** @type {string} */ key) => kept.get(key) ?? null,
    setItem: (/** @type {string} */ key, /** @type {string} */ text) => kept.set(key, text),
  };
  const fetch = async (/** @type {string} */ path, /** @type {RequestInit} */ { method, body }) =>
    new Response(JSON.stringify(answer(path, method ?? "GET", String(body))));
  Object.assign(globalThis, { localStorage: storage, fetch });
}

test("a place is kept with the design, and in the browser while the service is away", async () => {
  /** @type {string[]} */
  const states = [];
  /** @type {unknown[]} */
  const sent = [];
  let isAway = false;
  world((path, method, body) => {
    if (isAway) throw new TypeError("away");
    if (method === "PUT") sent.push([path, JSON.parse(body)]);
    return { places: [{ way: "brother", row: 9, count: 2 }] };
  });
  const settled = () => new Promise((done) => setTimeout(done));
  const places = new Places(
    () => "d1",
    (state) => states.push(state),
  );
  assert.equal(await places.lastWay(), "brother");
  assert.deepEqual(await places.load("d1 brother", "brother"), { row: 9, count: 2 });
  isAway = true;
  places.save("d1 brother", "brother", { row: 10, count: 2 });
  await settled();
  assert.equal(states.at(-1), "browser");
  isAway = false;
  assert.equal((await places.load("d1 brother", "brother")).row, 10); // what was knitted meanwhile counts
  await settled();
  assert.deepEqual(sent, [["/api/v1/designs/d1/places/brother", { row: 10, count: 2 }]]);
  assert.equal(states.at(-1), "design");
  assert.equal((await places.load("d1 brother", "brother")).row, 9); // and then what the service says
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
