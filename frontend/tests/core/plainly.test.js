import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";
import { labelOf, plainly } from "../../core/plainly.js";

const TITLE = "This input cannot be used";

test("a refusal names what was entered, not the field of a request", () => {
  const { detail, remedy } = plainly({
    title: TITLE,
    field: "request.force_n",
    detail: "request.force_n: Input should be less than or equal to 10000.",
    remedy: "Use 10000.0 or less.",
  });
  assert.equal(detail, "Force is too large.");
  assert.equal(remedy, "Use 10,000 or less.");
  assert.equal(labelOf("garment.glove.wrist_circumference_mm"), "Wrist circumference");
  assert.equal(labelOf("garment.limb.profile.2"), "Measurements along the limb");
});

test("what the library says keeps its sentence, in knitters' directions", () => {
  const { detail, remedy } = plainly({
    title: TITLE,
    field: "strain",
    detail: "strain: 1.3 wale-wise is too much: this swatch runs out of stretch before that.",
    remedy: "Use at most 1.221.",
  });
  assert.equal(detail, "Stretch: 1.3 along the columns is too much: this swatch runs out of stretch before that.");
  assert.equal(remedy, "Use at most 1.221.");
  assert.equal(
    plainly({ title: TITLE, field: "material", detail: "material: is missing.", remedy: "Give material." }).remedy,
    "Give material.",
  );
  const other = { title: "Not now", detail: "The computation took longer than 120 s." };
  assert.deepEqual(plainly(other), other);
});

test("a file keeps its name", () => {
  for (const name of ["photo.png", "course.csv, column force", "Prüfung 3.xlsx", "H15_depth_in_um.csv"]) {
    assert.equal(labelOf(name), name);
  }
  const of = { title: TITLE, field: "photo.png", detail: "photo.png: is too small.", remedy: "Give photo.png anew." };
  assert.deepEqual(plainly(of), { ...of, title: "photo.png cannot be used", detail: "photo.png is too small." });
});

test("no remedy shows a field's name", () => {
  const root = join(import.meta.dirname, "..", "..", "..");
  const texts = ["knitcore", "app"].flatMap(
    (room) =>
      readdirSync(join(root, room), { recursive: true, encoding: "utf8" })
        .filter((path) => path.endsWith(".py"))
        .map((path) => readFileSync(join(root, room, path), "utf8"))
        .filter((text) => text.includes("InputError("))
        .flatMap((text) => [...text.matchAll(/f?"((?:Give|Use|Correct|Check|Exchange|Add|Choose|Send)\b[^"\n]*)"/g)])
        .map(([, text]) => text.replaceAll(/\{[^}]*\}/g, "7"))
        .filter((text) => /[a-z]_[a-z]/.test(text) && !/knitcore\.|\w\(/.test(text)), // nor calls of the library
  );
  assert.ok(texts.length > 5);
  for (const remedy of texts) {
    assert.doesNotMatch(plainly({ title: TITLE, field: "strain", detail: "", remedy }).remedy ?? "", /[a-z]_[a-z]/);
  }
  const { title, remedy } = plainly({
    title: TITLE,
    field: "rest_mm",
    detail: "rest_mm: is missing.",
    remedy: "Give rest_mm, or a target_mmhg.",
  });
  assert.equal(title, "Tube at rest cannot be used");
  assert.equal(remedy, "Give tube at rest, or a pressure.");
});
