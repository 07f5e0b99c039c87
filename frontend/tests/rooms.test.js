/** The import contract: every folder of the page imports from the floors below it only. */

import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { dirname, join, normalize, sep } from "node:path";
import { test } from "node:test";

const ROOT = join(import.meta.dirname, "..");
const FLOORS = [
  ["types", "theme", "viser"],
  ["core"],
  ["grid"],
  ["design"],
  ["api", "elements"],
  ["tools"],
  ["state"],
  ["services", "chart"],
  ["sync", "plots"],
  ["actions"],
  ["widgets"],
  ["panels"],
  ["app"],
];
/** The floor of each folder; a module beside the folders is one by itself. */
const FLOOR = new Map(FLOORS.flatMap((names, floor) => names.map((name) => [name, floor])));

/** @param {string} path within the page's sources */
const room = (path) => path.split(sep)[0].replace(/\.(d\.ts|js)$/, "");

const MODULES = readdirSync(ROOT, { recursive: true, encoding: "utf8" }).filter(
  (path) => /\.js$/.test(path) && !/^(node_modules|dist|tests)\b/.test(path),
);

test("a module imports from its own folder and from lower floors only, types too", () => {
  const upward = [];
  for (const path of MODULES) {
    const own = FLOOR.get(room(path));
    assert.notEqual(own, undefined, `${room(path)} has no floor yet: add it to FLOORS`);
    const text = readFileSync(join(ROOT, path), "utf8");
    for (const [, target] of text.matchAll(/(?:from\s+|import\(?\s*)"(\.[^"]+)"/g)) {
      const other = room(normalize(join(dirname(path), target)));
      if (other !== room(path) && !((FLOOR.get(other) ?? Infinity) < Number(own))) upward.push(`${path} -> ${target}`);
    }
  }
  assert.deepEqual(upward, []);
});
