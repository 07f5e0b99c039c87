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
import {
  LengthField,
  choice,
  labelled,
  numberFault,
  numberField,
  sameWords,
  selectField,
} from "../../widgets/fields.js";
import { drawGarment } from "./preview.js";
import { facts } from "./facts.js";
import { DIGITS, FINGER, LIMB, TEMPLATES } from "./templates.js";
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
    const fault = lengths.map((field) => field.fault).find(Boolean) ?? shownNumbers().map(numberFault).find(Boolean);
    if (fault) {
      latest.cancel();
      refuse({ detail: fault });
    } else latest.run(plan, ({ problem }) => refuse(problem));
  };
  /** @param {{detail: string, remedy?: string | null}} problem */
  const refuse = (problem) => {
    garment = null;
    result.replaceChildren();
    canvas.hidden = true;
    belonging.clear();
    status.replaceChildren(problemBox({ ...problem, title: "This garment cannot be planned" }));
    planned();
  };

  /** Fields for numbers that can be seen; lengths know their bounds in every unit. */
  const shownNumbers = () =>
    [...element.querySelectorAll("input")].filter(({ type, offsetParent }) => type === "number" && offsetParent);

  // --- what is asked ----------------------------------------------------------------------------
  const measures = h("div", { class: "stack gap-6" });
  const fabrics = h("div", { class: "stack gap-6", id: "planner-fabrics" });
  /** What was entered for parts of the body and other measures, in mm, for the next template that needs it. @type {Map<string, number>} */
  const kept = new Map();
  /** Fabrics that were chosen, by part, and the eases of a tube and of fingers. @type {Map<string, string>} */
  const chosenFits = new Map();
  /** @type {() => Record<string, string>} */
  let ofParts = () => ({});
  const about = h("p", { class: "muted" });
  const ease = numberField({
    id: "planner-ease",
    required: true,
    min: "-60",
    max: "100",
    step: "1",
    oninput: () => {
      chosenFits.set(easeOf(), ease.value);
      changed();
    },
  });
  const target = numberField({
    id: "planner-target",
    required: true,
    min: "1",
    max: "300",
    step: "1",
    value: String(TARGET_MMHG),
    oninput: changed,
  });
  const graded = numberField({
    id: "planner-graded",
    min: "1",
    max: "300",
    step: "1",
    placeholder: "same",
    "aria-label": "Pressure at the upper end, mmHg",
    oninput: changed,
  });
  let byPressure = true;
  const [easeName, targetName] = [h("span", {}), h("span", {})];
  const easeOf = () => (template.fingers ? "ease of fingers" : "ease");
  const easeRow = labelled(easeName, ease, "negative is tighter");
  const targetRow = labelled(targetName, target);
  const gradedRow = labelled("At the upper end, mmHg", graded, "falls or rises evenly");
  const fit = choice("planner-fit", "How tight", { ease: "by ease", pressure: "by pressure" }, "pressure", (value) => {
    byPressure = value === "pressure";
    showFit();
    changed();
  });
  /** The yarn that was chosen, for every template; else each has its own. */
  let chosenYarn = "";
  const yarn = h("select", {
    class: "text-field full-width rounded",
    id: "planner-material",
    "aria-label": "Yarn",
    onchange: () => {
      chosenYarn = yarn.value;
      changed();
    },
  });
  const tex = numberField({
    min: "1",
    max: "99999",
    step: "any",
    placeholder: "–",
    "aria-label": "Yarn in tex",
    oninput: changed,
  });
  const loop = numberField({
    min: "1",
    max: "1000",
    step: "any",
    placeholder: "–",
    "aria-label": "Yarn in a stitch of the swatch, mm",
    id: "planner-loop",
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
  const count = (label, value) =>
    numberField({ required: true, min: "1", max: "200", step: "any", value, "aria-label": label, oninput: changed });
  const [stitches, rows] = [count("Stitches of the swatch", "22"), count("Rows of the swatch", "30")];
  /** @param {string} label @param {readonly string[]} options */
  const select = (label, options) =>
    selectField(
      { class: "text-field grows shrinks-x rounded", "aria-label": label, onchange: changed },
      sameWords(options),
    );
  const [per, of] = [select("Counted over", ["10 cm", "4 in", "5 cm"]), select("Fabric of the swatch", FABRICS)];
  const counted = ["sts ×", rows, "rows per", per, "of", of];
  const gaugeRow = h("div", { class: "planner-gauge line wrap gap-6", hidden: true }, stitches, ...counted);
  const inSizes = h("input", {
    type: "checkbox",
    id: "planner-sizes-shown",
    onchange: () => {
      stepsRow.hidden = !inSizes.checked;
      changed();
    },
  });
  /** @param {string} label @param {string} value */
  const step = (label, value) =>
    numberField({ required: true, min: "0", max: "20", step: "0.5", value, "aria-label": label, oninput: changed });
  const [wider, longer] = [step("Wider by, in percent", "5"), step("Longer by, in percent", "3")];
  const stepsRow = h(
    "div",
    { class: "line wrap gap-6", hidden: true },
    "Each",
    h("span", { class: "line gap-6" }, wider, "% wider and"),
    h("span", { class: "line gap-6" }, longer, "% longer than the one before"),
  );

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
      if (template.id === "glove") studio.seeing.planned(hand, garment.design);
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
        gradedRow,
        fabrics,
        h("h3", {}, "Yarn and gauge"),
        yarn,
        labelled("Yarn, tex (g/km)", tex, "for its mass"),
        labelled("Yarn in a stitch of a swatch, mm", loop, "unravel ten, for a surer amount"),
        h("label", { class: "planner-check line gap-8" }, own, "My own gauge"),
        gaugeRow,
        h("label", { class: "planner-check line gap-8" }, intarsia, "A colour for each fabric (intarsia)"),
        h("label", { class: "planner-check line gap-8" }, inSizes, "A table of sizes, XS to XL"),
        stepsRow,
      ),
      h(
        "section",
        { class: "planner-result column shrinks-x gap-12", "aria-label": "The garment", tabIndex: 0 },
        h("div", { class: "planner-picture centred rounded sunken" }, canvas),
        result,
      ),
    ),
    h("div", { class: "dialog-buttons" }, status, make),
  );
  /** A glove's ease is that of its fingers; the pressure is shown for its wrist. */
  function showFit() {
    easeName.textContent = template.fingers ? "Ease of fingers and thumb, %" : "Ease, %";
    targetName.textContent = template.fingers ? "Pressure at the wrist, mmHg" : "Target pressure, mmHg";
    easeRow.hidden = byPressure && template.id !== "glove";
    targetRow.hidden = !byPressure;
    gradedRow.hidden = !byPressure || !template.graded;
  }

  function showTemplate() {
    showFit();
    about.textContent = template.note;
    ease.value = chosenFits.get(easeOf()) ?? String(Math.round(template.ease * 100));
    showMaterials(chosenYarn || template.material);
    lengths = [];
    /** @param {string} label @param {number} mm @param {import("./templates.js").Bounds} bounds @param {string} [key] */
    const length = (label, mm, bounds, key = `${template.id} ${label}`) => {
      const field = new LengthField(label, kept.get(key) ?? mm, bounds, () => {
        kept.set(key, field.mm);
        changed();
      });
      field.show(unit);
      lengths.push(field);
      return field;
    };
    const fields = template.measures.map(({ key, label, value, of: bounds, hint, body }) => ({
      key,
      label,
      hint,
      field: length(label, value, bounds, body),
    }));
    const ofFabric = template.fabrics.map((part) => {
      const fabric = select(part.label, FABRICS);
      const name = part.key.replace("_fabric", ""); // several garments have a support, or a body
      fabric.value = chosenFits.get(name) ?? part.fabric;
      fabric.addEventListener("change", () => chosenFits.set(name, fabric.value));
      return { ...part, select: fabric };
    });
    fabrics.replaceChildren(
      ...(ofFabric.length
        ? [h("h3", {}, "Fabrics"), ...ofFabric.map(({ label, select: fabric }) => labelled(label, fabric))]
        : []),
    );
    ofParts = () => Object.fromEntries(ofFabric.map(({ key, select: fabric }) => [key, fabric.value]));
    const parts = fields.map(({ label, hint, field }) => labelled(label, field.input, hint));
    const digits = template.fingers
      ? DIGITS.map(([name, long, around]) => ({
          name,
          long: length(`${name}: length`, long, FINGER.long),
          around: length(`${name}: around`, around, FINGER.around),
        }))
      : [];
    const profile = template.profile
      ? profileTable(girthsOf.get(template.id) ?? template.profile, (places) => girthsOf.set(template.id, places))
      : null;
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

  /** Girths along a limb, by template. @type {Map<string, [number, number][]>} */
  const girthsOf = new Map();

  /** @param {[number, number][]} start @param {(places: [number, number][]) => void} keep */
  function profileTable(start, keep) {
    const entered = () => {
      keep(places.map(({ at, around }) => [at.mm, around.mm]));
      changed();
    };
    /** @param {string} label @param {number} mm @param {import("./templates.js").Bounds} bounds */
    const length = (label, mm, bounds) => {
      const field = new LengthField(label, mm, bounds, entered);
      field.show(unit);
      lengths.push(field);
      return field;
    };
    /** @type {{at: LengthField, around: LengthField}[]} */
    const places = [];
    const body = h("tbody", {});
    /** @param {[number, number]} place */
    const add = ([at, around]) => {
      const place = {
        at: length("Distance along the limb", at, LIMB.at),
        around: length("Circumference there", around, LIMB.around),
      };
      places.push(place);
      const remove = iconButton("close", "Remove this measurement", () => {
        if (places.length <= 2) return;
        places.splice(places.indexOf(place), 1);
        lengths = lengths.filter((field) => field !== place.at && field !== place.around);
        row.remove();
        entered();
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
          entered();
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

  /** One target, or one at each end. */
  const pressures = () => {
    if (!byPressure) return { target_mmhg: null };
    const [first, last] = [target.valueAsNumber, graded.valueAsNumber];
    if (!template.graded || !Number.isFinite(last)) return { target_mmhg: first };
    const ends = [Math.min, Math.max].map((end) => end(...(along() ?? [0, 0])));
    return {
      target_mmhg: null,
      mmhg_profile: [
        [ends[0], first],
        [ends[1], last],
      ],
    };
  };
  /** Where a garment along a limb begins and ends, mm. @returns {number[] | null} */
  const along = () => {
    const { profile, length_mm } = /** @type {{profile?: [number, number][], length_mm?: number}} */ (measured());
    return profile ? profile.map(([at]) => at) : length_mm ? [0, length_mm] : null;
  };
  /** What is asked for. */
  const request = () => ({
    garment: {
      template: template.id,
      ...measured(),
      ...ofParts(),
      ...pressures(),
      ease: Number.isFinite(ease.valueAsNumber) ? ease.valueAsNumber / 100 : template.ease,
    },
    material: yarn.value,
    gauge: own.checked
      ? { stitches: stitches.valueAsNumber, rows: rows.valueAsNumber, per: per.value, fabric: of.value }
      : null,
    linear_density_tex: Number.isFinite(tex.valueAsNumber) ? tex.valueAsNumber : null,
    yarn_per_stitch_mm: Number.isFinite(loop.valueAsNumber) ? loop.valueAsNumber : null,
    intarsia: intarsia.checked,
    sizes: inSizes.checked
      ? { wider_percent: wider.valueAsNumber || 0, longer_percent: longer.valueAsNumber || 0 }
      : null,
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
    showMaterials(chosenYarn || template.material);
    changed();
  };
}
