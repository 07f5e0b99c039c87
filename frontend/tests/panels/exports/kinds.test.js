import assert from "node:assert/strict";
import { test } from "node:test";
import { KINDS, hindrance, ofExtensions } from "../../../panels/exports/kinds.js";

test("what the service would refuse is not offered", () => {
  const glove = { shaped: true, stitches: 77 * 132 };
  const largest = { glb: 2500, knitout: 20_000 };
  assert.match(hindrance("knitspeak", glove, largest), /outline/);
  assert.match(hindrance("glb", glove, largest), /2,500/);
  assert.equal(hindrance("knitout", glove, largest), "");
  for (const { to } of KINDS) assert.equal(hindrance(to, { shaped: false, stitches: 100 }, largest), "");
});

test("formats of extensions are offered, with the package that they come from", () => {
  const house = { name: "house", package: "knit-house 1.0", problem: null };
  const offered = ofExtensions([
    { ...house, group: "knitcore.exporters", offers: ["punchcard", "jacquard"] },
    { ...house, group: "knitcore.materials", offers: ["waffle"] },
    { ...house, group: "knitcore.exporters", offers: ["broken"], problem: "It cannot be loaded." },
  ]);
  assert.deepEqual(
    offered.map(({ to }) => to),
    ["punchcard", "jacquard"],
  );
  assert.match(offered[0].note, /knit-house 1\.0/);
});
