import assert from "node:assert/strict";
import { test } from "node:test";

import { asItStands, hindrances, changed, inWords, isSaid, unitsOf, withColumn } from "../../services/tables.js";

/** @import {TableResult} from "../../types.js" */

/** @type {TableResult} */
const TABLE = {
  name: "a.csv",
  is_own: false,
  columns: [
    { title: "Load", unit: "N", quantity: "force_n" },
    { title: "Channel 2", unit: "", quantity: "" },
  ],
  rows: [],
  width_mm: null,
  length_mm: null,
  missing: ["strain_along", "width_mm"],
  problem: null,
  remedy: null,
  pulls: [],
  notes: [],
  doubts: [],
};

test("a column that holds something else takes its place, and what was read there is not used", () => {
  const moved = withColumn(asItStands(), TABLE, "Channel 2", "force_n");
  assert.deepEqual(moved.columns, { force_n: "Channel 2" });
  assert.deepEqual(withColumn(asItStands(), TABLE, "Load", "time").columns, { force_n: "", time: "Load" });
  assert.equal(inWords(withColumn(asItStands(), TABLE, "Load", "")), "no force");
});

test("a template says in words how a table is read, and an answer is known again", () => {
  const template = changed(asItStands(), { units: { force_n: "cN" }, width_mm: 70, narrowing_is_positive: true });
  assert.equal(inWords(template), "force in cN, 70 mm wide, narrowing is positive");
  assert.equal(inWords(asItStands()), "");
  const answer = { words: "cN", changes: { units: { force_n: "cN" } }, exchanges: false };
  assert.ok(isSaid(template, answer));
  assert.ok(!isSaid(asItStands(), answer));
  assert.ok(!isSaid(template, { words: "they stand", changes: {}, exchanges: false }));
});

test("what is missing or open is asked", () => {
  const doubt = { field: "a.csv", problem: "A width of 7 looks like cm.", remedy: "", readings: [], is_open: true };
  const problem = "a.csv has no column strain_along or extension_mm beside one force_n.";
  const open = hindrances({ ...TABLE, problem, doubts: [doubt, { ...doubt, is_open: false }] });
  assert.deepEqual(open, ["Still needed: a column of strain or extension, the width.", "A width of 7 looks like cm."]);
  assert.deepEqual(unitsOf("strain_across"), ["-", "%", "ratio"]);
  assert.deepEqual(unitsOf("run"), []);
});
