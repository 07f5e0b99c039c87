/**
 * A yarn without a tester, in five steps: ball band, gauge and weight, ten stitches, photos of the hanging
 * swatch, and what is known: intervals, what each measurement brought, what is missing for which use.
 *
 * @import {Studio} from "../../state/studio.js"
 * @import {Fabric, PhotosResult, SwatchRequest, SwatchResult} from "../../types.js"
 */

import { percent } from "../../core/format.js";
import { FABRICS } from "../../grid/segments.js";
import { h, remark } from "../../elements/dom.js";
import { icon } from "../../elements/icons.js";
import { download } from "../../services/exporter.js";
import { inKnittersWords, marksSheet, photosRequest, stepCells, swatchYarn, texOf } from "../../services/swatches.js";
import { adopt, identifierOf } from "../../services/yarns.js";
import { textButton } from "../../widgets/buttons.js";
import { labelled, nameField, numberField, sameWords, selectField } from "../../widgets/fields.js";
import { Run } from "../../widgets/jobrun.js";
import { attempt, problemBox } from "../../widgets/problem.js";
import { table, tableRow } from "../../widgets/table.js";
import { usesList } from "./yarnuses.js";

const STEPS = ["Ball band", "Gauge and weight", "Ten stitches", "Photos", "What we know"];
const BROUGHT = {
  library: "The library's yarns",
  "ball band": "Ball band",
  "gauge and weight": "Gauge and weight",
  "ten stitches": "Ten stitches",
};

/** @param {Studio} studio @param {() => void} made called when the yarn is kept */
export function swatchWay(studio, made) {
  const status = h("div", { class: "dialog-status", role: "status" });
  let step = 0;
  /** Whether the form holds a yarn that is not saved yet. */
  let isBegun = false;
  /** @type {SwatchResult | null} */
  let known = null;

  const name = nameField({ class: "text-field grows shrinks-x rounded", id: "swatch-name" });
  const fibre = nameField({ class: "text-field shrinks-x rounded", id: "swatch-fibre" });
  const grams = figure("swatch-ball-grams");
  const metres = figure("swatch-ball-metres");
  const wraps = figure("swatch-wraps");
  const fabric = selectField({ id: "swatch-fabric", class: "select" }, sameWords(FABRICS));
  const stitches = figure("swatch-stitches");
  const rows = figure("swatch-rows");
  const weight = figure("swatch-weight");
  const width = figure("swatch-width");
  const height = figure("swatch-height");
  const ten = figure("swatch-ten");
  const coin = figure("swatch-coin");
  const pulls = [pullFields("wale", "along its columns"), pullFields("course", "along its rows")];

  /** @param {string} title @param {string} detail */
  const say = (title, detail) => status.replaceChildren(problemBox({ title, detail }));

  /** @returns {SwatchRequest} */
  const request = () => ({
    name: name.value.trim() || "Own yarn",
    fibre: fibre.value.trim(),
    tex: texOf(grams.valueAsNumber, metres.valueAsNumber),
    wraps_per_inch: given(wraps),
    fabric: /** @type {Fabric} */ (fabric.value),
    stitches_per_10_cm: stitches.valueAsNumber,
    rows_per_10_cm: rows.valueAsNumber,
    weight_g: given(weight),
    width_mm: given(width),
    height_mm: given(height),
    ten_stitches_mm: given(ten),
    points: pulls.flatMap(({ points }) => points()),
  });

  /** What a step still needs, in words; empty if it may be left. @type {(() => string)[]} */
  const needs = [
    () => (name.value.trim() ? "" : "Give the yarn a name."),
    () => (stitches.valueAsNumber > 0 && rows.valueAsNumber > 0 ? "" : "Count stitches and rows per 10 cm."),
    () => "",
    () => (pulls.some((pull) => pull.chosen() && !pull.points().length) ? "Read the photos, or take them out." : ""),
    () => "",
  ];

  /** @param {"course" | "wale"} direction @param {string} words */
  function pullFields(direction, words) {
    const run = new Run();
    const clamped = figure(`swatch-${direction}-clamped`);
    const photos = [0, 1, 2].map((i) => ({
      photo: h("input", { type: "file", id: `swatch-${direction}-photo-${i}`, accept: "image/*" }),
      grams: i ? figure(`swatch-${direction}-grams-${i}`) : null,
    }));
    const seen = h("p", { class: "muted", role: "status" });
    /** @type {PhotosResult | null} */
    let result = null;
    const forget = () => {
      result = null;
      seen.replaceChildren();
    };
    const hung = () =>
      photos.flatMap(({ photo, grams: load }) => {
        const [file] = photo.files ?? [];
        return file ? [{ photo: file, grams: load ? load.valueAsNumber : 0 }] : [];
      });
    const read = async () => {
      const shown = hung();
      if (!shown.some(({ grams: load }) => load > 0) || !(clamped.valueAsNumber > 0)) {
        return run.say({
          title: "Something is missing",
          detail: "Choose a photo with a weight, and give its grams and the width that the clamps hold.",
          remedy: null,
        });
      }
      const pull = { direction, clampedMm: clamped.valueAsNumber, coinMm: coin.valueAsNumber, hung: shown };
      result = await run.run("photos", await photosRequest(pull, request()), "Reading the photos …");
      if (!result) return seen.replaceChildren();
      const points = result.points.map(
        (point) =>
          `${point.force_n_per_mm.toFixed(3)} N/mm: ${percent(point.strain_along, 1)} ± ${percent(point.strain_along_sd, 1)} longer, ${percent(-point.strain_across, 1)} narrower`,
      );
      seen.textContent = [...points, ...result.notes.map(inKnittersWords)].join(". ");
    };
    const element = h(
      "fieldset",
      { class: "swatch-pull" },
      h("legend", {}, `Pulled ${words}`),
      h(
        "div",
        { class: "yarn-facts" },
        labelled("Clamped width", clamped, "mm"),
        ...photos.flatMap(({ photo, grams: load }, i) => [
          labelled(i ? `Photo with weight ${i}` : "Photo without weight", photo),
          load && labelled("Weight", load, "g, with the clamp"),
        ]),
      ),
      textButton("play", "Read the photos", () => void read(), { id: `swatch-${direction}-read` }),
      seen,
      run.element,
    );
    element.addEventListener("change", forget);
    return {
      element,
      points: () => result?.points ?? [],
      chosen: () => hung().length > 0,
      clear() {
        for (const { photo } of photos) photo.value = "";
        forget();
      },
    };
  }

  const knownPlace = h("div", { class: "swatch-known" });
  const showKnown = async () => {
    known = null;
    const result = await attempt(status, () => swatchYarn(request()));
    if (!result) return knownPlace.replaceChildren();
    known = result;
    const lines = result.steps.map((each, i) => {
      const cells = stepCells(each, result.steps[i - 1] ?? null).map(({ words, brought }) =>
        h("span", { class: brought ? "swatch-brought" : "muted" }, words),
      );
      return tableRow(
        each.name in BROUGHT
          ? BROUGHT[/** @type {keyof BROUGHT} */ (each.name)]
          : inKnittersWords(each.name).replace(/^./, (letter) => letter.toUpperCase()),
        ...cells,
      );
    });
    knownPlace.replaceChildren(
      remark(
        "90 % intervals after each measurement. What it brought is in bold; stretch is that at a hand's pull, 10 N on 10 cm of cloth.",
      ),
      h(
        "div",
        { class: "yarn-fabrics" },
        table(
          { class: "yarn-table small full-width", id: "swatch-steps" },
          ["After", "Yarn in a stitch", "Bending stiffness", `Stretch of ${fabric.value} along rows`, "Along columns"],
          h("tbody", {}, ...lines),
        ),
      ),
      ...result.notes.map((note) => h("p", { class: "swatch-note line gap-6" }, icon("info"), inKnittersWords(note))),
      h("h4", {}, "What it serves for"),
      usesList(result.uses),
    );
  };

  const keep = async () => {
    if (!known) return;
    const document = { ...known.material, identifier: identifierOf(known.material.name) };
    if (!(await attempt(status, () => adopt(studio, document)))) return;
    isBegun = false;
    element.hidden = true;
    made();
  };

  const sheet = async () => {
    const file = await attempt(status, marksSheet);
    if (file) download(file.name, file.blob);
  };

  const pages = [
    h(
      "section",
      {},
      labelled("Name", name),
      h(
        "div",
        { class: "yarn-facts" },
        labelled("Fibre", fibre),
        labelled("Ball", grams, "g"),
        labelled("Length", metres, "m"),
        labelled("Wraps per inch", wraps, "wound around a ruler"),
      ),
      remark(
        "Weight and length of the ball, or the wraps around a ruler, say how thick the yarn is, and so about how stiffly it bends.",
      ),
    ),
    h(
      "section",
      {},
      h(
        "div",
        { class: "yarn-facts" },
        labelled("Fabric", fabric),
        labelled("Stitches", stitches, "per 10 cm"),
        labelled("Rows", rows, "per 10 cm"),
        labelled("Weight", weight, "g"),
        labelled("Width", width, "mm"),
        labelled("Height", height, "mm"),
      ),
      remark(
        "A swatch of 20 stitches and 30 rows or more, washed and laid flat. Weight and size of all of it give the yarn in a stitch, with the ball band.",
      ),
    ),
    h(
      "section",
      {},
      labelled("Yarn in ten stitches", ten, "mm: unravel ten, pull the yarn just straight, measure"),
      remark("It says best how much yarn a stitch holds."),
    ),
    h(
      "section",
      {},
      remark(
        "Print the sheet at 100 % and fix it upright. Hang the swatch before its middle, face to you, from a straight bar that holds its whole width, with another such bar at its lower edge. Photograph it straight on, all four marks in the photo: without a weight, then with one or two, such as bottles of water of 0.5 and 1.5 kg. Wait a minute after hanging each.",
      ),
      h(
        "div",
        { class: "yarn-facts" },
        textButton("export", "Save the sheet of marks", () => void sheet(), { id: "swatch-sheet" }),
        labelled("Or a coin beside it", coin, "mm in diameter: less precise"),
      ),
      ...pulls.map((pull) => pull.element),
    ),
    h("section", {}, knownPlace),
  ];
  const tabs = STEPS.map((words, i) =>
    h(
      "li",
      {},
      h(
        "button",
        { class: "button quiet", id: `swatch-step-${i + 1}`, onclick: () => void go(i) },
        `${i + 1}. ${words}`,
      ),
    ),
  );
  const back = textButton(null, "Back", () => void go(step - 1), { id: "swatch-back" });
  const next = textButton(null, "Next", () => (step === STEPS.length - 1 ? void keep() : void go(step + 1)), {
    class: "button primary",
    id: "swatch-next",
  });

  /** @param {number} to */
  const go = async (to) => {
    status.replaceChildren();
    const open = needs.findIndex((need, i) => i < to && need());
    if (open >= 0) {
      show(open);
      return say("This step is not complete", needs[open]());
    }
    show(to);
    if (to === STEPS.length - 1) await showKnown();
  };
  /** @param {number} to */
  const show = (to) => {
    step = to;
    pages.forEach((page, i) => (page.hidden = i !== to));
    tabs.forEach((tab, i) => {
      if (i === to) tab.firstElementChild?.setAttribute("aria-current", "step");
      else tab.firstElementChild?.removeAttribute("aria-current");
    });
    back.disabled = to === 0;
    next.textContent = to === STEPS.length - 1 ? "Save the yarn" : "Next";
  };
  show(0);

  const element = h(
    "section",
    { class: "yarn-maker", id: "swatch-way", hidden: true, "aria-label": "A yarn measured at home" },
    h("h3", {}, "A yarn measured at home"),
    h("ol", { class: "swatch-steps flex wrap gap-6" }, ...tabs),
    ...pages,
    status,
    h("div", { class: "dialog-buttons" }, back, next),
  );

  return {
    element,
    /** Begin with nothing known, or go on with what was begun. */
    open() {
      element.hidden = false;
      if (isBegun) return;
      isBegun = true;
      for (const field of [name, fibre, grams, metres, wraps, stitches, rows, weight, width, height, ten, coin])
        field.value = "";
      for (const pull of pulls) pull.clear();
      known = null;
      status.replaceChildren();
      show(0);
      name.focus();
    },
  };
}

/** @param {string} id */
const figure = (id) => numberField({ id, min: "0", step: "any" });

/** @param {HTMLInputElement} field @returns {number | null} */
const given = (field) => (field.valueAsNumber > 0 ? field.valueAsNumber : null);
