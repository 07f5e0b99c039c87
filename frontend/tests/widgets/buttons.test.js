import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

const ROOT = join(import.meta.dirname, "../..");

test("a verb within a sentence is no button element, which would not break with its line", () => {
  const sources = ["panels", "widgets"].flatMap((folder) =>
    readdirSync(join(ROOT, folder), { recursive: true, encoding: "utf8" })
      .filter((path) => path.endsWith(".js"))
      .map((path) => join(ROOT, folder, path)),
  );
  assert.ok(sources.length > 50);
  const boxed = sources.filter((path) => /h\(\s*"button",\s*\{[^}]*class: "link\b/.test(readFileSync(path, "utf8")));
  assert.deepEqual(boxed, []);
});
