import assert from "node:assert/strict";
import test from "node:test";
import { choices } from "../../../panels/exports/machines.js";

/** @param {string} identifier @param {string} name */
const machine = (identifier, name, reads_programs = true) => ({ identifier, name, reads_programs });
const MACHINES = [machine("swg091n2", "Shima"), machine("kniterate", "Kniterate"), machine("ayab", "AYAB", false)];

test("machines that read programs can be chosen", () => {
  assert.deepEqual(choices(MACHINES, null), {
    options: { swg091n2: "Shima", kniterate: "Kniterate", file: "A profile of your own …" },
    value: "swg091n2",
  });
  assert.equal(choices(MACHINES, "kniterate").value, "kniterate");
});

test("a profile of one's own is named after itself", () => {
  const { options, value } = choices(MACHINES, '{"name": "My V-bed"}');
  assert.equal(options[value], "My V-bed");
  assert.equal(choices(MACHINES, "{broken").options.own, "Your own profile");
});

test("a machine that the service does not know is shown by its name", () => {
  const { options, value } = choices([], "stoll");
  assert.equal(options[value], "stoll");
});
