import assert from "node:assert/strict";
import { test } from "node:test";
import { KINDS, hindrance } from "../panels/exports/kinds.js";

test("what the service would refuse is not offered", () => {
  const glove = { shaped: true, stitches: 77 * 132 };
  assert.match(hindrance("knitspeak", glove), /outline/);
  assert.match(hindrance("glb", glove), /2,500/);
  assert.equal(hindrance("knitout", glove), "");
  for (const { to } of KINDS) assert.equal(hindrance(to, { shaped: false, stitches: 100 }), "");
});
