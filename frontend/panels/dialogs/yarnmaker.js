/**
 * The form in which a yarn is made of what is known of it, or changed: photos and a squeeze of the yarn,
 * the gauge of its fabrics, stretch tests of some. What was not tested is estimated.
 *
 * @import {Studio} from "../../state/studio.js"
 * @import {BendingResult, CompressionResult, Fabric, FitResult, MaterialDocument, YarnDocument} from "../../types.js"
 * @import {Gauge, Tests} from "../../services/yarns.js"
 */

import { FABRICS } from "../../grid/segments.js";
import { h, remark } from "../../elements/dom.js";
import {
  adopt,
  bendingRequest,
  compressionRequest,
  distinctLines,
  estimated,
  fitRequest,
  withGauges,
  yarnOf,
} from "../../services/yarns.js";
import { textButton } from "../../widgets/buttons.js";
import { labelled, nameField, numberField, sameWords, selectField } from "../../widgets/fields.js";
import { Run } from "../../widgets/jobrun.js";
import { table, tableRow } from "../../widgets/table.js";
import { attempt } from "../../widgets/problem.js";
import { testReader } from "./testreader.js";
import { untestedFabrics, usesOf } from "../../services/swatches.js";
import { usesList } from "./yarnuses.js";

const ESTIMATED = "estimated from the library's yarns";
const TABLES = ".csv,.xlsx,.xls";

/** @param {Studio} studio @param {() => void} made called when the yarn is kept */
export function yarnMaker(studio, made) {
  const status = h("div", { class: "dialog-status", role: "status" });
  const run = new Run();
  /** The yarn that is changed; null for a new one. @type {MaterialDocument | null} */
  let base = null;
  /** Whether the form holds a yarn that is not saved yet. */
  let isBegun = false;
  /** The yarn of which its user has seen what it lacks. */
  let seen = "";
  /** Where the figures come from, by subject. @type {Map<string, string>} */
  const evidence = new Map();
  /** Deviation and diameter, which have no field of their own. @type {Partial<YarnDocument>} */
  let measured = {};

  /** @param {string} title @param {string} detail */
  const say = (title, detail) => run.say({ title, detail, remedy: null });

  const name = nameField({ class: "text-field grows shrinks-x rounded", id: "yarn-name" });
  const bending = figure("yarn-bending", { min: "0.01", max: "10000" });
  const loop = figure("yarn-loop", { min: "1", max: "200" });
  const stiffness = figure("yarn-stiffness", { min: "0.0001", max: "100000" });
  const exponent = figure("yarn-exponent", { min: "1.01", max: "20" });

  // Bending, from photos.
  const photos = picker("yarn-photos", "image/*", true);
  const weight = figure("yarn-weight", { min: "0.005", max: "20" });
  const hanging = figure("yarn-hanging", { min: "10", max: "1000" });
  const bent = h("p", { class: "muted", role: "status" });
  const bend = async () => {
    const chosen = [...(photos.files ?? [])];
    const given = { gramsPerMetre: weight.valueAsNumber, lengthMm: hanging.valueAsNumber };
    if (!chosen.length || !(given.gramsPerMetre > 0) || !(given.lengthMm > 0)) {
      return say("Something is missing", "Choose photos, and give the yarn's weight and the length that hangs.");
    }
    /** @type {BendingResult | null} */
    const traced = await run.run("bending", await bendingRequest(chosen, given), "Tracing the yarn …");
    if (!traced) return;
    const spread = traced.standard_deviation;
    bending.value = milli(traced.bending_modulus_n_mm2);
    measured = { ...measured, bending_modulus_sd_n_mm2: spread };
    const words = `${milli(traced.bending_modulus_n_mm2)}${spread ? ` ± ${milli(spread)}` : ""} mN·mm² from ${counted(traced.photos.length, "photo")}`;
    evidence.set("bending", `Bending stiffness ${words}.`);
    bent.textContent = [`${words}.`, ...traced.notes].join(" ");
  };

  // Contact, from squeezing.
  const squeezes = picker("yarn-squeezes", TABLES);
  const diameter = figure("yarn-diameter", { min: "0.01", max: "50" });
  const which = h("select", {
    id: "yarn-which",
    hidden: true,
    "aria-label": "Yarn of the file",
    onchange: () => take(),
  });
  const squeezed = h("p", { class: "muted", role: "status" });
  /** @type {CompressionResult | null} */
  let compression = null;
  const take = () => {
    const mean = compression?.mean[which.value];
    if (!compression || !mean) return;
    stiffness.value = milli(mean.k_n_per_mm3);
    exponent.value = mean.p.toFixed(2);
    const diameters = compression.samples
      .filter((sample) => sample.yarn === mean.yarn)
      .map((sample) => sample.diameter_mm);
    measured = { ...measured, diameter_mm: diameters.reduce((sum, mm) => sum + mm, 0) / diameters.length };
    const words = `stiffness ${stiffness.value} mN/mm³, exponent ${exponent.value} from ${counted(mean.samples, "sample")} of ${squeezes.files?.[0]?.name}`;
    evidence.set("contact", `Squeezing test: ${words}.`);
    squeezed.textContent = [`${words}.`, ...compression.notes].join(" ");
  };
  const squeeze = async () => {
    const [file] = squeezes.files ?? [];
    if (!file) return say("There is no test yet", "Choose the file of a squeezing test.");
    compression = await run.run(
      "compression",
      await compressionRequest(file, diameter.valueAsNumber),
      "Reading the squeezing test …",
    );
    const yarns = Object.keys(compression?.mean ?? {});
    which.replaceChildren(...yarns.map((yarn) => h("option", { value: yarn }, yarn)));
    which.hidden = yarns.length < 2;
    take();
  };

  const rows = FABRICS.map(fabricRow);

  /** @returns {Promise<Map<Fabric, {tests: Tests, fit: FitResult}> | null>} null if one fails */
  const fittedFabrics = async () => {
    const fitted = new Map();
    for (const { fabric, tests } of rows) {
      const given = tests();
      if (!given) continue;
      const fit = await run.run("fit", await fitRequest(given), `Fitting ${fabric} …`);
      if (!fit) return null;
      fitted.set(fabric, { tests: given, fit });
    }
    return fitted;
  };

  /** @returns {Partial<YarnDocument>} figures of the yarn that are given */
  const figures = () => ({
    ...measured,
    ...(bending.valueAsNumber > 0 && { bending_modulus_n_mm2: bending.valueAsNumber / 1000 }),
    ...(stiffness.valueAsNumber > 0 && { compression_stiffness_n_per_mm3: stiffness.valueAsNumber / 1000 }),
    ...(exponent.valueAsNumber > 1 && { compression_exponent: exponent.valueAsNumber }),
  });

  const make = async () => {
    if (!name.value.trim()) return say("The yarn has no name", "Give it one.");
    const half = rows.find(({ incomplete }) => incomplete());
    if (half) return say(`${capital(half.fabric)} is not complete`, half.incomplete());
    const fitted = await fittedFabrics();
    if (!fitted) return;
    const known = yarnOf(base, name.value.trim(), figures(), fitted, [...evidence.values()]);
    const lacking = FABRICS.filter((fabric) => !(fabric in known.fabrics));
    const estimable = bending.valueAsNumber > 0 && loop.valueAsNumber > 0;
    if (lacking.length === FABRICS.length && !estimable) {
      return say(
        "That is not enough for a yarn",
        "Give its bending stiffness and the yarn in a stitch, or two stretch tests and the gauge of a fabric.",
      );
    }
    const yarn = await attempt(status, async () => (lacking.length ? completed(known, lacking, estimable) : known));
    if (!yarn) return;
    /** @type {Map<Fabric, Gauge>} */
    const gauges = new Map();
    for (const { fabric, gauge } of rows) {
      const given = gauge();
      if (given) gauges.set(fabric, given);
    }
    const whole = withGauges(yarn, gauges);
    const uses = await attempt(status, () => usesOf(whole));
    if (!uses) return;
    const text = JSON.stringify(whole);
    if (uses.some(({ serves }) => serves === "no") && text !== seen) {
      seen = text;
      return status.replaceChildren(remark("Some uses need more. Add it, or save the yarn as it is."), usesList(uses));
    }
    if (!(await attempt(status, () => adopt(studio, whole)))) return;
    isBegun = false;
    element.hidden = true;
    made();
  };

  /** @param {MaterialDocument} known @param {readonly Fabric[]} lacking @param {boolean} bends whether it is known how */
  const completed = async (known, lacking, bends) => {
    const { material, warnings } = await (bends ? estimated : untestedFabrics)(known, loop.valueAsNumber);
    const fabrics = Object.fromEntries(
      lacking.map((fabric) => [fabric, { ...material.fabrics[fabric], law_source: ESTIMATED }]),
    );
    return { ...known, fabrics: { ...known.fabrics, ...fabrics }, note: distinctLines(known.note ?? "", ...warnings) };
  };

  const title = h("h3", {}, "A yarn from stretch tests");
  const dropped = h("div", { class: "test-question line wrap rounded open", id: "yarn-dropped", hidden: true });
  /** Ask which test a table is that was dropped on the page. @param {File} file */
  const offer = (file) => {
    const fabric = selectField({ id: "yarn-dropped-fabric", "aria-label": "Fabric of the test" }, sameWords(FABRICS));
    const along = selectField(
      { id: "yarn-dropped-along", "aria-label": "Pulled along" },
      { course: "its rows", wale: "its columns" },
    );
    const use = () => {
      const row = rows.find((each) => each.fabric === fabric.value);
      const picker = row?.pickers[along.value === "wale" ? "wale" : "course"];
      if (!picker) return;
      const data = new DataTransfer();
      data.items.add(file);
      picker.files = data.files;
      picker.dispatchEvent(new Event("change"));
      dropped.hidden = true;
    };
    dropped.replaceChildren(
      h("span", {}, `${file.name} is a stretch test of`),
      fabric,
      h("span", {}, "pulled along"),
      along,
      textButton("check", "Use it", use, { id: "yarn-dropped-use" }),
    );
    dropped.hidden = false;
  };
  const element = h(
    "section",
    { class: "yarn-maker", id: "yarn-maker", hidden: true, "aria-label": "A yarn from stretch tests" },
    title,
    dropped,
    labelled("Name", name),
    h("h4", {}, "1. The yarn"),
    h(
      "div",
      { class: "yarn-facts" },
      labelled("Bending stiffness (EI)", bending, "mN·mm², optional"),
      labelled("Yarn per stitch", loop, "mm (unravel 10 stitches, divide by 10)"),
    ),
    h(
      "details",
      { id: "yarn-bend" },
      h("summary", {}, "Measure the bending stiffness on photos"),
      remark(
        "Let a known length hang over the edge of a table, 10 to 25 cm, before a plain background. Photograph it level from the side, crop the photo at the edge, and take five.",
      ),
      h(
        "div",
        { class: "yarn-facts" },
        labelled("Photos", photos),
        labelled("Weight", weight, "g/m"),
        labelled("Hanging length", hanging, "mm"),
      ),
      textButton("play", "Measure the photos", () => void bend(), { id: "yarn-bend-run" }),
      bent,
    ),
    h(
      "details",
      { id: "yarn-squeeze" },
      h("summary", {}, "Squeezing test (for yarn simulations only)"),
      h(
        "div",
        { class: "yarn-facts" },
        labelled("Test", squeezes, "XLSX, XLS or CSV"),
        labelled("Diameter", diameter, "mm, unless the file has it"),
        which,
      ),
      textButton("play", "Fit the test", () => void squeeze(), { id: "yarn-squeeze-run" }),
      h("div", { class: "yarn-facts" }, labelled("Stiffness", stiffness, "mN/mm³"), labelled("Exponent", exponent)),
      squeezed,
    ),
    h("h4", {}, "2. The fabrics"),
    remark(
      "Stitches and rows per 10 cm of a swatch at rest; and, for one fabric or more, two stretch tests (CSV, XLSX or HDF5), pulled along its rows and along its columns. A fabric without tests is estimated from the bending stiffness, the yarn in a stitch and the fabrics that have them.",
    ),
    h(
      "div",
      { class: "yarn-fabrics" },
      table(
        { class: "yarn-table small full-width" },
        ["Fabric", "Stitches per 10 cm", "Rows per 10 cm", "Pulled along the rows", "Pulled along the columns"],
        h("tbody", {}, ...rows.map((row) => row.element)),
      ),
    ),
    ...rows.map((row) => row.reader.element),
    run.element,
    status,
    h(
      "div",
      { class: "dialog-buttons" },
      textButton("yarn", "Save the yarn", () => void make(), { class: "button primary", id: "yarn-make" }),
    ),
  );

  return {
    element,
    offer,
    /** Show the form, for a new yarn or with what is known of one; a new one that was begun goes on. @param {MaterialDocument | null} yarn */
    open(yarn) {
      element.hidden = false;
      if (isBegun && !yarn && !base) return name.focus();
      isBegun = true;
      base = yarn;
      measured = {};
      evidence.clear();
      compression = null;
      for (const field of [photos, weight, hanging, squeezes, diameter]) field.value = "";
      for (const message of [bent, squeezed, status]) message.replaceChildren();
      which.hidden = true;
      title.textContent = yarn ? `Change ${yarn.name}` : "A yarn from stretch tests";
      name.value = yarn?.name ?? "";
      bending.value = milli(yarn?.yarn?.bending_modulus_n_mm2);
      stiffness.value = milli(yarn?.yarn?.compression_stiffness_n_per_mm3);
      exponent.value = String(yarn?.yarn?.compression_exponent ?? "");
      const loops = Object.values(yarn?.fabrics ?? {}).flatMap(({ loop_length_mm }) => loop_length_mm ?? []);
      loop.value = loops.length ? String(Number(loops[0].toPrecision(4))) : "";
      for (const row of rows) row.show(yarn?.fabrics[row.fabric] ?? null);
      name.focus();
    },
  };
}

/** @param {Fabric} fabric */
function fabricRow(fabric) {
  const course = picker(`yarn-${fabric}-along-rows`, `${TABLES},.h5,.hdf5`);
  const wale = picker(`yarn-${fabric}-along-columns`, `${TABLES},.h5,.hdf5`);
  course.ariaLabel = `${fabric}, pulled along the rows`;
  wale.ariaLabel = `${fabric}, pulled along the columns`;
  const stitches = figure(`yarn-${fabric}-stitches`, { "aria-label": `Stitches of ${fabric} per 10 cm` });
  const rows = figure(`yarn-${fabric}-rows`, { "aria-label": `Rows of ${fabric} per 10 cm` });
  const known = h("span", { class: "muted" });
  const reader = testReader(fabric, { course, wale });
  const gauge = () => {
    const given = { stitches: stitches.valueAsNumber, rows: rows.valueAsNumber };
    return given.stitches > 0 && given.rows > 0 ? given : null;
  };
  /** @returns {Tests | null} null until all is given */
  const tests = () => {
    const [along, across, size] = [course.files?.[0], wale.files?.[0], gauge()];
    const { templates } = reader;
    return along && across && size ? { course: along, wale: across, templates, ...size } : null;
  };
  /** What is missing, in words; empty if it is all or nothing. */
  const incomplete = () => {
    const files = [course, wale].filter((field) => field.files?.length).length;
    const numbers = [stitches, rows].filter((field) => field.value).length;
    if (files === 1) return "A fabric needs two tests: along its rows and along its columns.";
    if (numbers === 1) return "Give both its stitches and its rows per 10 cm.";
    return files && !numbers ? "Its tests need its gauge, too." : reader.open();
  };
  /** @param {MaterialDocument["fabrics"][Fabric] | null} record */
  const show = (record) => {
    course.value = wale.value = "";
    reader.clear();
    stitches.value = record ? perTenCm(record.stitch_course_mm) : "";
    rows.value = record ? perTenCm(record.stitch_wale_mm) : "";
    known.textContent = record ? ` ${record.origin === "estimated" ? "estimated" : "tested"}` : "";
  };
  const element = tableRow(h("span", {}, fabric, known), stitches, rows, course, wale);
  return { fabric, gauge, tests, incomplete, show, element, reader, pickers: { course, wale } };
}

/** @param {string} id @param {Record<string, unknown>} more */
const figure = (id, more) => numberField({ id, min: "1", max: "400", step: "any", ...more });

/** @param {string} id @param {string} accept @param {boolean} [multiple] */
const picker = (id, accept, multiple = false) => h("input", { type: "file", id, accept, multiple });

/** @param {number | null | undefined} value in thousandths, or nothing */
const milli = (value) => (value ? String(Number((1000 * value).toPrecision(3))) : "");

/** @param {string} word */
const capital = (word) => word.charAt(0).toUpperCase() + word.slice(1);

/** @param {number} mm */
const perTenCm = (mm) => String(Number((100 / mm).toPrecision(4)));

/** @param {number} count @param {string} thing */
const counted = (count, thing) => `${count} ${thing}${count === 1 ? "" : "s"}`;
