/**
 * The garment planner: measurements, yarn and gauge at the left; at the right what comes of them, as
 * they are typed. What it makes is a design like any other.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {Studio} from "../../state/studio.js"
 * @import {DesignDocument, GarmentRequest, GarmentResult} from "../../types.js"
 */

import { api } from "../../api.js";
import { FABRICS } from "../../grid/segments.js";
import { Belonging } from "../../services/belonging.js";
import { Latest } from "../../services/latest.js";
import { h } from "../../elements/dom.js";
import { iconButton, textButton } from "../../widgets/buttons.js";
import { dialog } from "../../widgets/dialog.js";
import { table, tableRow } from "../../widgets/table.js";
import { LengthField, choice, labelled, numberField, sameWords, selectField } from "../../widgets/fields.js";
import { drawGarment } from "./preview.js";
import { facts } from "./facts.js";
import { DIGITS, TEMPLATES } from "./templates.js";
import { problemBox } from "../../widgets/problem.js";

const TYPING_MS = 250;
/** The middle of the range that the paper wanted for its glove, 20 to 30. */
const TARGET_MMHG = 25;

/** @param {Studio} studio @param {ActionContext} context */
export function create(studio, { keeper }) {
  let unit = "mm";
  let template = TEMPLATES[0];
  /** @type {LengthField[]} */
  let lengths = [];
  /** @type {() => Record<string, unknown>} */
  let measured = () => ({});
  /** @type {GarmentResult | null} */
  let garment = null;
  /** What was asked for the plan that is shown. @type {any} */
  let hand = null;
  const latest = new Latest(TYPING_MS);
  const changed = () => {
    belonging.check();
    make.disabled = true; // until the new plan is there, the old one must not be made
    latest.run(plan, ({ problem }) => {
      garment = null;
      result.replaceChildren();
      canvas.hidden = true;
      belonging.clear();
      status.replaceChildren(problemBox({ ...problem, title: "This garment cannot be planned" }));
      planned();
    });
  };

  // --- what is asked ----------------------------------------------------------------------------
  const measures = h("div", { class: "stack gap-6" });
  const about = h("p", { class: "muted" });
  const ease = numberField({
    id: "planner-ease",
    min: "-60",
    max: "100",
    step: "1",
    "aria-label": "Ease in percent",
    oninput: changed,
  });
  const target = numberField({
    id: "planner-target",
    min: "1",
    max: "300",
    step: "1",
    value: String(TARGET_MMHG),
    "aria-label": "Target pressure in mmHg",
    oninput: changed,
  });
  let byPressure = true;
  const easeRow = labelled("Ease, %", ease, "negative is tighter");
  const targetRow = labelled("Target pressure, mmHg", target);
  const fit = choice("planner-fit", "How tight", { ease: "by ease", pressure: "by pressure" }, "pressure", (value) => {
    byPressure = value === "pressure";
    showFit();
    changed();
  });
  const yarn = h("select", { class: "text-field grows shrinks-x rounded", id: "planner-material", onchange: changed });
  const tex = numberField({
    min: "1",
    step: "any",
    placeholder: "–",
    "aria-label": "Yarn in tex",
    oninput: changed,
  });
  const intarsia = h("input", { type: "checkbox", id: "planner-intarsia", onchange: changed });
  const own = h("input", {
    type: "checkbox",
    id: "planner-own-gauge",
    onchange: () => {
      gaugeRow.hidden = !own.checked;
      changed();
    },
  });
  /** @param {string} label @param {string} value */
  const count = (label, value) => numberField({ min: "1", step: "any", value, "aria-label": label, oninput: changed });
  const [stitches, rows] = [count("Stitches", "22"), count("Rows", "30")];
  /** @param {string} label @param {readonly string[]} options */
  const select = (label, options) =>
    selectField(
      { class: "text-field grows shrinks-x rounded", "aria-label": label, onchange: changed },
      sameWords(options),
    );
  const [per, of] = [select("Counted over", ["10 cm", "4 in", "5 cm"]), select("Fabric of the swatch", FABRICS)];
  const counted = ["sts ×", rows, "rows per", per, "of", of];
  const gaugeRow = h("div", { class: "line wrap gap-6", hidden: true }, stitches, ...counted);

  // --- what comes of it -------------------------------------------------------------------------
  const canvas = h("canvas", { role: "img", id: "planner-preview", "aria-label": "The garment, laid flat" });
  const result = h("div", { class: "planner-facts column gap-12", id: "planner-facts", "aria-live": "polite" });
  const status = h("div", { class: "dialog-status", role: "status" });
  const make = textButton(
    null,
    "Make this design",
    () => {
      if (!garment) return;
      element.close();
      const { outline } = garment.design;
      if (template.id === "glove" && outline) studio.seeing.glove.value = { request: hand, outline };
      keeper.openNew(/** @type {DesignDocument} */ (garment.design)); // a plan has a material
      studio.tell(
        `${garment.design.name}: ${garment.columns} stitches × ${garment.rows} rows. The design before it is still among your designs.`,
      );
    },
    { class: "button primary", id: "planner-make", disabled: true },
  );

  const element = dialog(
    "planner-dialog",
    "Plan a garment",
    h(
      "div",
      { class: "planner stack" },
      h(
        "form",
        {
          class: "planner-form column shrinks-x gap-12",
          onsubmit: (/** @type {Event} */ event) => event.preventDefault(),
        },
        choice(
          "planner-template",
          "Garment",
          Object.fromEntries(TEMPLATES.map(({ id, name }) => [id, name])),
          template.id,
          (id) => {
            template = TEMPLATES.find((candidate) => candidate.id === id) ?? template;
            showTemplate();
            changed();
          },
        ),
        about,
        h(
          "div",
          { class: "planner-heading line spread gap-10" },
          h("h3", {}, "Measurements"),
          choice("planner-unit", "Unit", { mm: "mm", in: "inches" }, unit, (value) => {
            unit = value;
            for (const field of lengths) field.show(unit);
            if (garment) show(garment);
          }),
        ),
        measures,
        h("div", { class: "planner-heading line spread gap-10" }, h("h3", {}, "Fit"), fit),
        easeRow,
        targetRow,
        h("h3", {}, "Yarn and gauge"),
        labelled("Material", yarn),
        labelled("Yarn, tex (g/km)", tex, "for its mass"),
        h("label", { class: "planner-check line gap-8" }, own, "My own gauge"),
        gaugeRow,
        h("label", { class: "planner-check line gap-8" }, intarsia, "A colour for each fabric (intarsia)"),
      ),
      h(
        "section",
        { class: "planner-result column shrinks-x gap-12", "aria-label": "The garment" },
        h("div", { class: "planner-picture centred rounded sunken" }, canvas),
        status,
        result,
      ),
    ),
    h("div", { class: "dialog-buttons" }, make),
  );
  /** A glove's ease is that of its fingers; the pressure is shown for its wrist. */
  function showFit() {
    easeRow.hidden = byPressure && template.id !== "glove";
    targetRow.hidden = !byPressure;
  }

  function showTemplate() {
    showFit();
    about.textContent = template.note;
    ease.value = String(Math.round(template.ease * 100));
    const chosen = yarn.value;
    showMaterials(template.id === "glove" || !chosen ? template.material : chosen);
    lengths = [];
    /** @param {string} label @param {number} mm */
    const length = (label, mm) => {
      const field = new LengthField(label, mm, changed);
      field.show(unit);
      lengths.push(field);
      return field;
    };
    const fields = template.measures.map(({ key, label, value, hint }) => ({
      key,
      label,
      hint,
      field: length(label, value),
    }));
    const parts = fields.map(({ label, hint, field }) => labelled(label, field.input, hint));
    const digits = template.fingers
      ? DIGITS.map(([name, long, around]) => ({
          name,
          long: length(`${name}: length`, long),
          around: length(`${name}: around`, around),
        }))
      : [];
    const profile = template.profile ? profileTable(template.profile, length) : null;
    measures.replaceChildren(
      ...(profile ? [profile.element] : []),
      ...parts,
      ...(digits.length
        ? [
            table(
              { class: "planner-table full-width small" },
              ["", "Length", "Around"],
              h("tbody", {}, ...digits.map(({ name, long, around }) => tableRow(name, long.input, around.input))),
            ),
          ]
        : []),
    );
    measured = () => ({
      ...Object.fromEntries(fields.map(({ key, field }) => [key, field.mm])),
      ...(profile ? { profile: profile.read() } : {}),
      ...(digits.length ? fingers(digits) : {}),
    });
  }

  /** @param {{long: LengthField, around: LengthField}[]} digits */
  function fingers(digits) {
    const [thumb, ...rest] = digits.map(({ long, around }) => ({ length_mm: long.mm, circumference_mm: around.mm }));
    return { thumb, fingers: rest };
  }

  /** @param {[number, number][]} start @param {(label: string, mm: number) => LengthField} length */
  function profileTable(start, length) {
    /** @type {{at: LengthField, around: LengthField}[]} */
    const places = [];
    const body = h("tbody", {});
    /** @param {[number, number]} place */
    const add = ([at, around]) => {
      const place = { at: length("Distance along the limb", at), around: length("Circumference there", around) };
      places.push(place);
      const remove = iconButton("close", "Remove this measurement", () => {
        if (places.length <= 2) return;
        places.splice(places.indexOf(place), 1);
        row.remove();
        changed();
      });
      const row = tableRow(null, place.at.input, place.around.input, remove);
      body.append(row);
    };
    start.forEach(add);
    const element = h(
      "div",
      {},
      table({ class: "planner-table full-width small" }, ["Along the limb", "Around it", ""], body),
      textButton(
        "plus",
        "Add a measurement",
        () => {
          const last = places[places.length - 1];
          add([last.at.mm + 40, last.around.mm]);
          changed();
        },
        { id: "planner-add" },
      ),
    );
    return { element, read: () => places.map(({ at, around }) => [at.mm, around.mm]) };
  }

  /** @param {string} chosen */
  function showMaterials(chosen) {
    const all = studio.completeYarns.map(({ id, name }) => ({ id, name }));
    if (!all.some(({ id }) => id === "glove-wool:glove")) {
      all.push({ id: "glove-wool:glove", name: "Glove wool, stockinette on 2.0 mm needles as in the study" });
    }
    yarn.replaceChildren(...all.map(({ id, name }) => h("option", { value: id, selected: id === chosen }, name)));
  }

  /** What is asked for. */
  const request = () => ({
    garment: {
      template: template.id,
      ...measured(),
      ease: ease.valueAsNumber / 100,
      target_mmhg: byPressure ? target.valueAsNumber : null,
    },
    material: yarn.value,
    gauge: own.checked
      ? { stitches: stitches.valueAsNumber, rows: rows.valueAsNumber, per: per.value, fabric: of.value }
      : null,
    linear_density_tex: Number.isFinite(tex.valueAsNumber) ? tex.valueAsNumber : null,
    intarsia: intarsia.checked,
  });
  const belonging = new Belonging(studio, () => ({ wish: request() }));
  belonging.marks(result, "planner");

  /** @param {AbortSignal} signal */
  async function plan(signal) {
    const [body, { basis }] = [request(), belonging];
    garment = await api.run("garment", /** @type {GarmentRequest} */ (body), signal);
    belonging.show(basis);
    hand = { garment: body.garment, material: body.material, gauge: body.gauge };
    status.replaceChildren();
    show(garment);
    planned();
  }

  function planned() {
    make.disabled = garment === null;
  }

  /** @param {GarmentResult} fitted */
  function show(fitted) {
    const gauge = fitted.gauges.find(({ fabric }) => fabric === "stockinette") ?? fitted.gauges[0];
    canvas.hidden = false;
    drawGarment(canvas, fitted.design, gauge.stitches_per_10_cm / gauge.rows_per_10_cm);
    canvas.setAttribute(
      "aria-label",
      `${fitted.name}: ${fitted.columns} stitches by ${fitted.rows} rows, with ${fitted.regions.map(({ name }) => name).join(", ")}`,
    );
    result.replaceChildren(...facts(fitted, unit));
  }

  showTemplate();
  return () => {
    element.showModal();
    showMaterials(yarn.value || template.material);
    changed();
  };
}
