import assert from "node:assert/strict";
import { readFileSync, readdirSync } from "node:fs";
import { join } from "node:path";
import { test } from "node:test";

const IS_TOUCHED = { matches: true };

/** The module as another device has it. @param {string} platform @param {boolean} touched */
async function pointing(platform, touched) {
  Object.defineProperty(globalThis, "navigator", { value: { platform }, configurable: true });
  Object.assign(globalThis, { matchMedia: touched ? () => IS_TOUCHED : undefined });
  return /** @type {typeof import("../../core/pointing.js")} */ (
    await import(`../../core/pointing.js?${platform}${touched}`)
  );
}

test("mouse and keys are named as the device has them, and not at all on a touch screen", async () => {
  const linux = await pointing("Linux x86_64", false);
  const mac = await pointing("MacIntel", false);
  const tablet = await pointing("iPad", true);
  assert.equal(linux.withKey("Paste", "Mod+V"), "Paste (Ctrl+V)");
  assert.equal(mac.withKey("Paste", "Mod+V"), "Paste (⌘V)");
  assert.equal(mac.besides("Select", "Shift adds, Alt takes away"), "Select; Shift adds, Option takes away");
  assert.equal(tablet.besides("Select", "Shift adds"), "Select");
  assert.equal(tablet.byHand("Click", "Tap"), "Tap");
});

test("no text names a mouse or a key past the helper", () => {
  const root = join(import.meta.dirname, "..", "..");
  const said = readdirSync(root, { recursive: true, encoding: "utf8" })
    .filter((path) => path.endsWith(".js") && !/^(node_modules|dist|tests|core)\b/.test(path))
    .flatMap((path) => {
      const rest = readFileSync(join(root, path), "utf8").replace(
        /\b(byHand|besides|withKey)\(\s*"[^"]*"(,\s*"[^"]*")?/g,
        "",
      );
      return rest.split("\n").map((line) => `${path}: ${line.trim()}`);
    })
    .filter((line) => /["`][^"`]*(Ctrl\+|[Rr]ight (mouse )?button|\b[Ww]heel\b|Shift )/.test(line))
    .filter((line) => !/["`]wheel["`]/.test(line));
  assert.deepEqual(said, []);
});
