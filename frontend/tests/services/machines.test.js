/** Machines to choose from. */

import assert from "node:assert/strict";
import { test } from "node:test";

import { choices, ownMachine } from "../../services/machines.js";

/** @param {string} identifier @param {string} name */
const machine = (identifier, name, reads_programs = true) => ({ identifier, name, reads_programs });
const MACHINES = [
  machine("swg091n2", "Shima"),
  machine("kniterate", "Kniterate"),
  machine("brother", "Brother", false),
  machine("ayab", "AYAB", false),
];
const FILE = { file: "A profile of your own …" };

test("machines that read programs are for programs, and the others for plans", () => {
  const programs = { swg091n2: "Shima", kniterate: "Kniterate", ...FILE };
  assert.deepEqual(choices(MACHINES, null, "programs"), { options: programs, value: "swg091n2" });
  assert.deepEqual(choices(MACHINES, "ayab", "programs"), { options: programs, value: "swg091n2" });
  assert.equal(choices(MACHINES, "kniterate", "programs").value, "kniterate");
  const plans = { brother: "Brother", ayab: "AYAB", ...FILE };
  assert.deepEqual(choices(MACHINES, "kniterate", "plans"), { options: plans, value: "brother" });
  assert.equal(choices(MACHINES, "ayab", "plans").value, "ayab");
});

test("a profile of one's own is named after itself, where it fits", () => {
  const { options, value } = choices(MACHINES, '{"name": "My V-bed"}', "programs");
  assert.equal(options[value], "My V-bed");
  assert.equal(choices(MACHINES, '{"name": "My V-bed"}', "plans").value, "brother");
  assert.equal(choices(MACHINES, "{broken", "programs").options.own, "Your own profile");
  const hand = ownMachine('{"name": "Attic", "identifier": "attic", "dialect": "hand"}');
  assert.deepEqual(hand, { identifier: "attic", name: "Attic", reads_programs: false });
});

test("a machine that the service does not know is shown by its name", () => {
  const { options, value } = choices([], "stoll", "programs");
  assert.equal(options[value], "stoll");
});
