import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { DESIGN_NAME, shortName } from "../../core/names.js";

test("a name that is too long says so, and an ending stays whole", () => {
  assert.equal(shortName("  Cuff "), "Cuff");
  assert.equal(shortName("a".repeat(80)), "a".repeat(80));
  assert.equal(shortName("a".repeat(81)), `${"a".repeat(79)}…`);
  const copy = shortName("b".repeat(DESIGN_NAME), DESIGN_NAME, " (copy)");
  assert.equal(copy.length, DESIGN_NAME);
  assert.match(copy, /^b+… \(copy\)$/);
});

test("no name is cut in silence", () => {
  const root = join(import.meta.dirname, "..", "..");
  const modules = readdirSync(root, { recursive: true, encoding: "utf8" }).filter(
    (path) => path.endsWith(".js") && !/^(node_modules|dist|tests)\b/.test(path),
  );
  const cut = modules.filter((path) => /maxLength|name\.slice\(0/i.test(readFileSync(join(root, path), "utf8")));
  assert.deepEqual(cut, []);
});
