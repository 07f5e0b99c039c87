/**
 * Find a fabric: targets with tolerances, in this yarn or in all, and what comes nearest.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {Studio} from "../../state/studio.js"
 * @import {CandidateResult, FindResult, TargetInput} from "../../types.js"
 */

import { figure, percent } from "../../core/format.js";
import { sourceInWords } from "../../core/plainly.js";
import { Belonging } from "../../services/belonging.js";
import { h } from "../../elements/dom.js";
import { icon } from "../../elements/icons.js";
import { iconButton, textButton } from "../../widgets/buttons.js";
import { carry, chosenPlace, fillWith, nameOf, repeatPicture } from "./apply.js";
import { curlInWords, knittingInWords, paintWith } from "./atlas.js";
import { field, form, verdict } from "./form.js";
import { Run } from "../../widgets/jobrun.js";
import { sameWords, selectField } from "../../widgets/fields.js";

/**
 * @typedef {{id: string, label: string, short: string, unit: string, start: number, percent?: boolean,
 *   needs?: "load" | "limb", difference?: boolean}} Quantity `difference`: its tolerance is not a share
 */

/**
 * @param {string} id
 * @param {string} label
 * @param {string} short
 * @param {string} unit
 * @param {number} start
 * @param {Partial<Quantity>} [more]
 * @returns {Quantity}
 */
const quantity = (id, label, short, unit, start, more = {}) => ({ id, label, short, unit, start, ...more });

const QUANTITIES = [
  quantity("modulus_course_n_per_mm", "Stiffness, rows", "rows", "N/mm", 0.1),
  quantity("modulus_wale_n_per_mm", "Stiffness, columns", "columns", "N/mm", 0.1),
  quantity("stretch_course", "Stretch, rows", "stretch, rows", "%", 60, { percent: true, needs: "load" }),
  quantity("stretch_wale", "Stretch, columns", "stretch, columns", "%", 40, { percent: true, needs: "load" }),
  quantity("pressure_course_mmhg", "Pressure, rows around a limb", "pressure", "mmHg", 20, { needs: "limb" }),
  quantity("pressure_wale_mmhg", "Pressure, columns around a limb", "pressure", "mmHg", 20, { needs: "limb" }),
  quantity("anisotropy", "Ratio of the stiffnesses (rows over columns)", "ratio", "", 1),
  quantity("poisson_yx", "Poisson ratio, pulled along rows", "Poisson, rows", "", 0.2, { difference: true }),
  quantity("poisson_xy", "Poisson ratio, pulled along columns", "Poisson, columns", "", 0.4, { difference: true }),
];
const COUNT = 12;
/** How much a target counts. @type {Record<string, number>} */
const WEIGHTS = { minor: 0.25, normal: 1, major: 4 };

/** @param {string} label of a value, such as stretch_wale@0.1 */
const quantityOf = (label) => QUANTITIES.find(({ id }) => id === label.split("@")[0]) ?? QUANTITIES[0];

/** @param {Studio} studio @param {ActionContext} context */
export function findTab(studio, context) {
  const run = new Run();
  const rows = h("div", { class: "plain-list stack gap-6", id: "targets" });
  const answer = h("div", { class: "inverse-answer", id: "find-answer" });
  /** @type {(() => TargetInput | null)[]} */
  const readers = [];

  /** @param {Quantity} first @param {number} [value] */
  const addRow = (first, value = first.start) => {
    const select = selectField(
      { class: "text full-width", "aria-label": "Quantity" },
      Object.fromEntries(QUANTITIES.map(({ id, label }) => [id, label])),
    );
    select.value = first.id;
    const number = field("Value", value, { step: "any", class: "number figures target-value framed rounded" });
    const unit = h("span", { class: "muted target-unit small" });
    const tolerance = field("Tolerance", 10, { min: "0.1", step: "any" });
    const toleranceUnit = h("span", { class: "muted" }, "%");
    const weight = selectField({ class: "text full-width", "aria-label": "Weight" }, sameWords(Object.keys(WEIGHTS)));
    weight.value = "normal";
    const load = field("Load in N/mm", 0.1, { min: "0.001", max: "0.5", step: "any" });
    const rest = field("Tube, unworn, in mm", 180, { min: "1", step: "any" });
    const worn = field("Limb in mm", 220, { min: "1", step: "any" });
    const extra = h("div", { class: "target-extra line wrap small gap-6" });
    const remove = iconButton("close", "Remove this target", () => {
      readers.splice(readers.indexOf(read), 1);
      row.remove();
    });
    const show = () => {
      const q = quantityOf(select.value);
      unit.textContent = q.unit;
      toleranceUnit.textContent = q.difference ? "" : "%";
      extra.replaceChildren(
        ...(q.needs === "load" ? [h("label", {}, "at", load), h("span", { class: "muted" }, "N/mm of width")] : []),
        ...(q.needs === "limb"
          ? [
              h("label", {}, "tube", rest),
              h("label", {}, "on a limb of", worn),
              h("span", { class: "muted" }, "mm around"),
            ]
          : []),
      );
      extra.hidden = !q.needs;
    };
    select.onchange = () => {
      const q = quantityOf(select.value);
      number.value = String(q.start);
      tolerance.value = q.difference ? "0.05" : "10";
      show();
    };
    const read = () => {
      const q = quantityOf(select.value);
      const numbers = [number, tolerance, load, rest, worn].map(({ valueAsNumber }) => valueAsNumber);
      if (!Number.isFinite(numbers[0]) || !(numbers[1] > 0)) return null;
      /** @type {TargetInput} */
      const target = {
        quantity: /** @type {TargetInput["quantity"]} */ (q.id),
        value: q.percent ? numbers[0] / 100 : numbers[0],
        tolerance: q.difference ? numbers[1] : numbers[1] / 100,
        weight: WEIGHTS[weight.value],
      };
      if (q.needs === "load") target.load_n_per_mm = numbers[2];
      if (q.needs === "limb") target.limb = { rest_mm: numbers[3], worn_mm: numbers[4] };
      return target;
    };
    show();
    readers.push(read);
    const row = h(
      "div",
      { class: "target sunken rounded" },
      h(
        "div",
        { class: "target-line line wrap gap-6" },
        select,
        number,
        unit,
        h("label", { class: "target-tolerance" }, "±", tolerance, toleranceUnit),
        weight,
        remove,
      ),
      extra,
    );
    rows.append(row);
  };

  const across = h("input", { type: "checkbox", id: "find-all-yarns" });
  const large = h("input", { type: "checkbox", id: "find-large" });
  const transfers = limit("Moves between beds", { any: null, none: 0, "≤ ¼ a stitch": 0.25, "≤ ½ a stitch": 0.5 });
  const curl = limit("Curl", { any: null, "lies flat": 0.15, little: 0.5 });

  const request = () => {
    const targets = readers.map((read) => read()).filter((target) => target !== null);
    const all = studio.completeYarns.map(({ id }) => id);
    const { value: own } = studio.materialId;
    return {
      materials: across.checked ? [own, ...all.filter((id) => id !== own)] : [own],
      targets,
      repeats: large.checked ? "all" : "small",
      limits: { transfers_per_stitch: transfers.most(), curl: curl.most() },
      count: COUNT,
      elsewhere: false,
    };
  };
  const belonging = new Belonging(studio, () => {
    const { materials, ...wish } = request();
    return { yarn: across.checked || materials, wish };
  });
  belonging.marks(answer, "find");
  belonging.bars(answer);

  const search = async () => {
    const wish = request();
    const { materials, targets } = wish;
    if (targets.length < readers.length || !targets.length) {
      run.say({
        title: "A target is incomplete",
        detail: "Every target needs a value and a tolerance.",
        remedy: "Fill it in, or remove it.",
      });
      return;
    }
    const { basis } = belonging;
    /** @type {FindResult | null} */
    const findResult = await run.run("find", wish, "Searching");
    if (!findResult) return;
    show(findResult, targets);
    belonging.show(basis);
    if (findResult.reached || materials.length === studio.completeYarns.length) return;
    /** @type {FindResult | null} */
    const more = await run.run("find", { ...wish, repeats: "small", elsewhere: true }, "Searching the other yarns");
    if (more) show({ ...findResult, elsewhere: more.elsewhere }, targets);
  };

  /** @param {FindResult} findResult @param {TargetInput[]} targets */
  const show = (findResult, targets) => {
    answer.replaceChildren(
      verdict(findResult.reached, inWords(findResult, targets)),
      h("ol", { class: "candidates" }, ...findResult.candidates.map(item)),
      ...(findResult.elsewhere.length
        ? [h("h3", {}, "In other yarns"), h("ol", { class: "candidates" }, ...findResult.elsewhere.map(item))]
        : []),
    );
  };

  /** @param {CandidateResult} candidate */
  const item = (candidate) => {
    const key = candidate.repeat;
    const name = studio.materials.value.find(({ id }) => id === candidate.material)?.name ?? candidate.material;
    const picture = h("div", { class: "inverse-handle", title: "Drag it onto the chart" }, repeatPicture(key, 60));
    picture.addEventListener("pointerdown", (event) =>
      carry(event, studio, context.view, key, undefined, candidate.material),
    );
    return h(
      "li",
      { class: candidate.reached ? "candidate reached flex gap-12" : "candidate flex gap-12" },
      picture,
      h(
        "div",
        { class: "small shrinks-x grows" },
        h(
          "div",
          { class: "candidate-title line gap-8" },
          h("strong", {}, nameOf(key)),
          h("span", { class: "muted ellipsis" }, name),
          h(
            "span",
            {
              class: candidate.reached ? "reached-mark inline small nowrap" : "muted",
              title: "Probability that all targets are met within their tolerances, from the 90 % intervals",
            },
            candidate.reached && icon("check"),
            `${percent(candidate.chance)} chance of meeting ${Object.keys(candidate.values).length > 1 ? "all targets" : "the target"}`,
          ),
        ),
        h(
          "div",
          { class: "candidate-values figures flex wrap" },
          ...Object.keys(candidate.values).map((label) => valueOf(candidate, label)),
        ),
        h(
          "div",
          { class: "muted" },
          `${knittingInWords(candidate.transfers_per_stitch, candidate.crossings_per_stitch)}; ${curlInWords(candidate.curl)}. ${sourceInWords(candidate.provenance)}.`,
        ),
      ),
      h(
        "div",
        { class: "candidate-buttons stack gap-4" },
        iconButton(
          "fill",
          `Fill with ${nameOf(key)}`,
          () => fillWith(studio, key, chosenPlace(studio), candidate.material),
          { title: "Fill the selection or the chart" },
        ),
        iconButton("pencil", `Paint with ${nameOf(key)}`, () => paintWith(studio, key), { title: "Paint with it" }),
      ),
    );
  };

  addRow(QUANTITIES[0]);
  addRow(QUANTITIES[1]);
  const targetForm = form(
    search,
    rows,
    h(
      "div",
      { class: "inverse-bar" },
      textButton(
        "plus",
        "Target",
        () => addRow(QUANTITIES.find(({ id }) => !readers.some((read) => read()?.quantity === id)) ?? QUANTITIES[0]),
        { id: "target-add" },
      ),
      transfers.label,
      curl.label,
      h("label", { class: "check" }, across, "All yarns"),
      h(
        "label",
        { class: "check", title: "Up to 4 × 4 instead of 3 × 3; the first time takes up to a minute per yarn" },
        large,
        "Larger patterns",
      ),
      h("span", { class: "spacer" }),
      h("button", { class: "button primary", type: "submit", id: "find-run" }, "Find"),
    ),
  );
  // A row that is added or taken away is clicked.
  for (const event of ["input", "change", "click"]) targetForm.addEventListener(event, () => belonging.check());
  const element = h("div", { class: "inverse-tab scrolls column shrinks-y gap-8" }, targetForm, run.element, answer);
  return { element, open: () => {}, retheme: () => {} };
}

/** @param {FindResult} findResult @param {TargetInput[]} targets */
function inWords({ reached, candidates, searched, ranges, elsewhere }, targets) {
  const within = candidates.filter((candidate) => candidate.reached).length;
  if (reached)
    return [
      `The most likely of ${searched} repeats.`,
      within === 1 ? "One of these is within all tolerances." : `${within} of these are within all tolerances.`,
    ].join(" ");
  const beyond = Object.entries(ranges).flatMap(([label, [low, high]]) => {
    const q = quantityOf(label);
    const targetValue = targets.find(({ quantity }) => quantity === q.id)?.value ?? low;
    const scale = q.percent ? 100 : 1;
    return targetValue < low || targetValue > high
      ? [`${q.label}: all span ${figure(scale * low)} to ${figure(scale * high)} ${q.unit}.`]
      : [];
  });
  return [
    `None of ${searched} repeats meets all targets; the most likely come first.`,
    ...(beyond.length ? beyond : targets.length > 1 ? ["Each target can be met, but not all at once."] : []),
    elsewhere.some((candidate) => candidate.reached)
      ? "Another yarn does, see below."
      : "Widen a tolerance, or search more yarns.",
  ].join(" ");
}

/** @param {CandidateResult} candidate @param {string} label */
function valueOf(candidate, label) {
  const q = quantityOf(label);
  const value = candidate.values[label];
  const off = candidate.deviations[label];
  const scale = q.percent ? 100 : 1;
  if (value === null || off === null) return h("span", {}, `${q.short}: runs out of stretch first`);
  const [low, high] = candidate.intervals[label].map((end) => (end === null ? "…" : figure(scale * end, 2)));
  const away = q.difference
    ? `${off < 0 ? "−" : "+"}${figure(Math.abs(off), 2)}`
    : `${off < 0 ? "−" : "+"}${Math.abs(100 * off).toFixed(0)} %`;
  return h(
    "span",
    { title: `90 % interval ${low} to ${high} ${q.unit}` },
    h("span", { class: "muted" }, `${q.short} `),
    `${figure(scale * value)} ${q.unit} `,
    h("span", { class: "away" }, away),
    h("span", { class: "muted" }, ` (${low}–${high})`),
  );
}

/** A choice of a limit. @param {string} label @param {Record<string, number | null>} limits by their words */
function limit(label, limits) {
  const select = selectField({ class: "text full-width" }, sameWords(Object.keys(limits)));
  return { most: () => limits[select.value], label: h("label", { class: "check" }, label, select) };
}
