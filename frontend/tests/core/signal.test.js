import assert from "node:assert/strict";
import { test } from "node:test";

import { Signal } from "../../core/signal.js";

test("after a listener has set the value again, the last that others hear is the present one", () => {
  const signal = new Signal("flat");
  const heard = /** @type {string[]} */ ([]);
  signal.listen((value) => value === "lying" && (signal.value = "flat"));
  signal.listen((value) => heard.push(value));
  signal.value = "lying";
  assert.equal(heard.at(-1), "flat");
});
