/**
 * The stitch number of the machine on show: from two swatches of the user's, or a guess. Swatches are kept in the
 * machine's profile, which goes with the design.
 *
 * @import {Studio} from "../../state/studio.js"
 */

import { ApiError, api } from "../../api.js";
import { h } from "../../elements/dom.js";
import { download } from "../../services/exporter.js";
import { textButton } from "../../widgets/buttons.js";
import { numberField } from "../../widgets/fields.js";

const SWATCHES = ["First swatch", "Second swatch"];

/**
 * @param {Studio} studio
 * @param {() => string} machine the machine on show
 */
export function swatchFields(studio, machine) {
  const rows = SWATCHES.map((name) => {
    const number = numberField({ min: "0", step: "any", "aria-label": `${name}, stitch number` });
    const length = numberField({ min: "0", step: "any", "aria-label": `${name}, yarn per stitch in mm` });
    const row = h(
      "div",
      { class: "line gap-8" },
      h("span", {}, `${name}: number`),
      number,
      length,
      "mm of yarn a stitch",
    );
    return { number, length, row };
  });
  const words = h("p", { class: "small", role: "status" });
  const use = textButton("check", "Use these swatches", () => void keep(), { class: "button", id: "export-swatches" });
  const save = textButton("export", "Save the profile", () => store(), { class: "button quiet" });
  let profile = "";

  /** @param {Partial<import("../../types.js").DialRequest>} more */
  async function ask(more) {
    const shown = machine();
    const material = studio.materialId.value;
    try {
      const dial = await api.run("dial", { machine: shown, material, ...more });
      if (shown !== machine()) return null; // another one is on show by now
      words.textContent = dial.interval_source;
      save.hidden = dial.swatches.length === 0;
      profile = dial.profile;
      return dial;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      words.textContent = `${error.problem.detail} ${error.problem.remedy ?? ""}`.trim();
      save.hidden = true;
      return null;
    }
  }

  async function keep() {
    const swatches = rows
      .map(({ number, length }) => ({ number: number.valueAsNumber, loop_length_mm: length.valueAsNumber }))
      .filter((swatch) => Object.values(swatch).every(Number.isFinite));
    if (swatches.length === 0) words.textContent = "Give the stitch number and the yarn per stitch of each swatch.";
    else if (await ask({ swatches })) studio.machine.value = profile;
  }

  const store = () => {
    const { identifier } = JSON.parse(profile);
    download(`${identifier}.json`, new Blob([profile], { type: "application/json" }));
  };

  const hint =
    "Knit two swatches of this yarn at different numbers. Unravel ten stitches of each and divide their length by ten.";
  const element = h(
    "details",
    { class: "small" },
    h("summary", {}, "Stitch number from two swatches of yours"),
    h(
      "div",
      { class: "stack gap-8" },
      h("p", { class: "muted" }, hint),
      ...rows.map(({ row }) => row),
      h("div", { class: "line gap-8" }, use, save),
      words,
    ),
  );
  element.addEventListener("toggle", () => void show());

  /** Show what is known of the machine and the yarn, where it is looked at. */
  async function show() {
    if (!element.open) return;
    const dial = await ask({});
    for (const [index, { number, length }] of rows.entries()) {
      const kept = dial?.swatches[index];
      if (document.activeElement === number || document.activeElement === length) continue;
      number.value = kept ? String(kept.number) : "";
      length.value = kept ? String(kept.loop_length_mm) : "";
    }
  }
  save.hidden = true;
  return { element, show };
}
