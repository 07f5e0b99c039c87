/**
 * Stitches from stiffness: parts of the chart, and how stiff each should be.
 *
 * @import {Studio} from "../../state/studio.js"
 * @import {FillResult, GaugeInput} from "../../types.js"
 *
 * @typedef {{course: number, wale: number}} Stiffness moduli in N/mm
 * @typedef {{name: string, cells: number[], course: number | null, wale: number | null, now: Stiffness | null,
 *   gauge: GaugeInput | null, wish: (() => Stiffness | null) | null, show?: () => void}} Part
 * `gauge` is that of the part as it is, if it was counted; `wish` is what was asked for in words, until the
 * numbers that it goes by have come
 */

import { UNDO } from "../../core/pointing.js";
import { ApiError, api } from "../../api.js";
import { figure, percent, thousands } from "../../core/format.js";
import { shortName } from "../../core/names.js";
import { Belonging } from "../../services/belonging.js";
import { Grid } from "../../grid/grid.js";
import { largestRectangle } from "../../grid/inscribed.js";
import { FABRICS } from "../../grid/segments.js";
import { selectedCells } from "../../design/selection.js";
import { clothIn, pieceOf } from "../../services/scope.js";
import { h } from "../../elements/dom.js";
import { iconButton, textButton } from "../../widgets/buttons.js";
import { nameField } from "../../widgets/fields.js";
import { nameOf, repeatPicture } from "./apply.js";
import { field, fillButton, form, verdict } from "./form.js";
import { Run } from "../../widgets/jobrun.js";

const SHOWN_PATCHES = 6;
/** @type {{axis: "course" | "wale", label: string}[]} */
const AXES = [
  { axis: "course", label: "rows" },
  { axis: "wale", label: "columns" },
];
/** What one says of a cloth, and the change of its stiffness. @type {Record<string, number>} */
const STEPS = { "a little softer": 1 / 1.3, "much softer": 1 / 2.5, "a little stiffer": 1.3, "much stiffer": 2.5 };
/** Nearer than this is as wanted. */
const NEAR = 0.1;

/** @param {Studio} studio */
export function fromStiffness(studio) {
  const { document: chart, selection } = studio;
  const run = new Run(studio);
  const list = h("ol", { class: "plain-list stack gap-6", id: "parts" });
  const answer = h("div", { class: "inverse-answer", id: "fill-answer" });
  const belonging = new Belonging(studio, () => ({
    design: studio.designId,
    chart: [chart.grid.text, chart.outlineText],
    yarn: studio.materialId.value,
    wish: parts.map(({ name, cells, course, wale }) => [name, cells, course, wale]),
  }));
  belonging.marks(answer, "fill");
  belonging.bars(answer);
  const uncounted = h(
    "li",
    { class: "muted inverse-hint", id: "parts-uncounted", hidden: true },
    "Your gauge is of the whole chart: parts of it have their computed size.",
  );
  /** @type {Part[]} */
  let parts = [];
  /** Size of the chart that the parts were drawn on. */
  let size = "";
  /** Whose parts these are. */
  let designId = studio.designId;

  const sizeNow = () => `${chart.grid.rows} ${chart.grid.columns}`;
  /** What is known of the yarn's pure fabrics. */
  const fabricsNow = () => studio.yarn?.fabrics ?? {};
  const add = (/** @type {string} */ name, /** @type {number[]} */ all) => {
    const cells = all.filter((i) => chart.outline[i]);
    if (!cells.length) return;
    if (size !== sizeNow()) parts = [];
    size = sizeNow();
    parts.push({ name, cells, course: null, wale: null, now: null, gauge: null, wish: null });
    show();
  };
  const clear = () => {
    answer.replaceChildren();
    belonging.clear();
  };
  const addSelection = () => {
    const { grid } = chart;
    const cells = selectedCells(selection.value ?? grid.box, grid);
    add(selection.value ? `Part ${parts.length + 1}` : "Whole chart", cells);
  };
  const addRegions = () => {
    for (const { name, stitches } of chart.regions) if (!parts.some((part) => part.name === name)) add(name, stitches);
  };

  /** Ask what a part does now, and say so in its card. @param {Part} part */
  const measure = async (part) => {
    const { grid } = chart;
    const mask = new Uint8Array(grid.purl.length);
    for (const i of part.cells) mask[i] = 1;
    const inside = largestRectangle(mask, grid.columns);
    if (!inside || size !== sizeNow()) return;
    const body = clothIn(studio, { grid: grid.region(inside) });
    part.gauge = body.gauge;
    uncounted.hidden = !pieceOf(studio).gauge || parts.every(({ gauge }) => gauge);
    try {
      const predicted = await api.run("predict", body);
      part.now = { course: predicted.modulus_course_n_per_mm, wale: predicted.modulus_wale_n_per_mm };
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      part.now = null; // the inspector says why
    }
    for (const each of parts) each.show?.(); // another part may wait for these numbers
  };
  const measureAll = async () => {
    if (designId !== studio.designId) {
      designId = studio.designId;
      parts = [];
      clear();
      show();
    }
    if (parts.length && element.checkVisibility()) await Promise.all(parts.map(measure));
  };

  /** @param {Part} part @param {number} at */
  const item = (part, at) => {
    const inputs = AXES.map(({ axis, label }) => {
      const input = field(`Target stiffness along ${label}, N/mm: ${part.name}`, 0, {
        min: "0.0001",
        step: "any",
        required: false,
        placeholder: "any",
        id: `part-${at}-${axis}`,
      });
      input.oninput = () => {
        part[axis] = Number.isFinite(input.valueAsNumber) ? input.valueAsNumber : null;
        part.wish = null;
        part.show?.();
      };
      return input;
    });
    const now = AXES.map(({ axis }) => h("span", { class: "figures", id: `part-${at}-${axis}-now` }, "…"));
    const verdicts = AXES.map(() => h("span", { class: "muted part-verdict" }));
    part.show = () => {
      belonging.check();
      const numbers = part.wish?.();
      if (numbers) {
        for (const { axis } of AXES) part[axis] = Number(numbers[axis].toPrecision(3));
        part.wish = null;
      }
      if (!part.wish) like.value = "";
      AXES.forEach(({ axis }, i) => {
        now[i].textContent = figure(part.now?.[axis]);
        const target = part[axis];
        // What is being typed ("1.") stays as it is.
        if (inputs[i] !== document.activeElement) inputs[i].value = target === null ? "" : String(target);
        verdicts[i].textContent = target && part.now ? against(part.now[axis], target) : "";
      });
    };
    const others = parts.filter((other) => other !== part);
    const like = h(
      "select",
      {
        class: "text part-like full-width",
        id: `part-${at}-like`,
        "aria-label": `Make ${part.name} …`,
        onchange: () => {
          const chosen = like.value;
          part.wish = chosen ? () => targetAs(chosen) : null;
          part.show?.();
        },
      },
      h("option", { value: "" }, "make it …"),
      ...Object.entries(STEPS).map(([words]) => h("option", { value: words }, words)),
      ...FABRICS.filter((fabric) => fabricsNow()[fabric]).map((fabric) =>
        h("option", { value: fabric }, `as stretchy as ${fabric}`),
      ),
      ...others.map(({ name }, i) => h("option", { value: `part ${i}` }, `as stretchy as ${name} now`)),
    );
    /** @param {string} chosen @returns {Stiffness | null} */
    const targetAs = (chosen) => {
      const { now: mine } = part;
      if (chosen in STEPS) return mine && scaled(mine, STEPS[chosen]);
      if (chosen.startsWith("part ")) return others[Number(chosen.slice(5))].now;
      const fabric = fabricsNow()[/** @type {typeof FABRICS[number]} */ (chosen)];
      return fabric ? { course: fabric.modulus_course_n_per_mm, wale: fabric.modulus_wale_n_per_mm } : null;
    };
    part.show();
    return h(
      "li",
      { class: "target sunken rounded" },
      h(
        "div",
        { class: "target-line line wrap gap-6" },
        nameField({
          class: "text part-title full-width",
          value: part.name,
          "aria-label": "Name",
          onchange: (/** @type {Event} */ { target }) =>
            (part.name = shortName(/** @type {HTMLInputElement} */ (target).value) || part.name),
        }),
        h("span", { class: "muted figures part-count small nowrap" }, `${thousands(part.cells.length)} sts`),
        iconButton("close", `Remove ${part.name}`, () => {
          parts = parts.filter((other) => other !== part);
          show();
        }),
      ),
      like,
      ...AXES.map(({ label }, i) =>
        h(
          "div",
          { class: "part-number stack small" },
          h("span", { class: "muted" }, label),
          now[i],
          h("span", { class: "muted", "aria-hidden": "true" }, "→"),
          inputs[i],
          verdicts[i],
        ),
      ),
    );
  };
  const show = () => {
    belonging.check();
    list.replaceChildren(
      ...(parts.length
        ? [h("li", { class: "muted inverse-hint" }, "Stiffness in N/mm, now → target"), uncounted, ...parts.map(item)]
        : [
            h(
              "li",
              { class: "muted inverse-hint" },
              "Select stitches in the chart (M, Q or W) and add them as a part, or add all regions; then say how each should be: stiffer, softer, as stretchy as another fabric, or a number. An empty field is no preference.",
            ),
          ]),
    );
    void measureAll();
  };

  const smallest = field("Smallest patch, stitches", 4, { min: "1", max: "100", step: "1" });
  let seed = 0;
  const large = h("input", { type: "checkbox" });
  const scattered = h("input", { type: "checkbox" });

  const sayResized = () =>
    run.say({
      title: "The chart has another size now",
      detail: "The parts were drawn on the chart as it was.",
      remedy: "Add the parts again.",
    });

  const fill = async () => {
    if (parts.some(({ wish }) => wish)) {
      const known = await run.during("Computing the parts as they are …", () => measureAll().then(() => true));
      if (!known) return;
    }
    const waiting = parts.find(({ wish }) => wish);
    if (waiting) {
      run.say({
        title: `What ${waiting.name} does now is not known yet`,
        detail: "The target is counted from that.",
        remedy: "Try again in a moment, or enter a number.",
      });
      return;
    }
    // As they are now: the fields may be changed before the result is there.
    const targeted = parts.filter(({ course, wale }) => course !== null || wale !== null).map((part) => ({ ...part }));
    if (!targeted.length) {
      run.say({
        title: "There is no target",
        detail: "A part needs a stiffness along rows or columns.",
        remedy: "Add a part, and say how it should be, or give it a number.",
      });
      return;
    }
    if (size !== sizeNow()) return sayResized();
    clear();
    const { rows, columns, purl } = chart.grid;
    const start = { purl: purl.slice(), outline: chart.outlineText, basis: belonging.basis };
    /** @type {FillResult | null} */
    const fillResult = await run.run(
      "fill",
      {
        material: studio.materialId.value,
        rows,
        columns,
        chart: chart.grid.text,
        outline: start.outline,
        targets: targeted.map(({ name, cells, course, wale, gauge }) => ({
          name,
          gauge,
          runs: runsOf(cells, columns),
          modulus_course_n_per_mm: course,
          modulus_wale_n_per_mm: wale,
        })),
        repeats: large.checked ? "all" : "small",
        smallest_patch: smallest.valueAsNumber || 4,
        scattered: scattered.checked,
        seed,
      },
      "Filling",
    );
    if (!fillResult) return;
    await chart.rested();
    if (start.basis.design !== belonging.basis.design) return;
    if (size === sizeNow()) preview(fillResult, targeted, start);
    else sayResized();
  };

  /**
   * The result goes onto the chart at once, so that chart, 3D and numbers show it. Stitches that were painted
   * during the run stay; the result then counts as one of another chart.
   *
   * @param {FillResult} fillResult
   * @param {Part[]} targeted
   * @param {{purl: Uint8Array, outline: string | null, basis: Record<string, string>}} start the chart that was
   *   filled, and what the result belongs to
   */
  const preview = (fillResult, targeted, { purl: before, outline, basis }) => {
    const { rows, columns } = chart.grid;
    const filled = Grid.fromText(fillResult.chart);
    const differing = [...new Set(targeted.flatMap((part) => part.cells))].filter((i) => filled.purl[i] !== before[i]);
    const cells = differing.filter((i) => chart.grid.purl[i] === before[i]);
    const painted = differing.length - cells.length;
    const whole = new Grid(rows, columns, before.slice());
    for (const i of differing) whole.purl[i] = filled.purl[i];
    /** @param {Uint8Array} purl @param {string} words */
    const put = (purl, words) =>
      chart.set(
        cells.map((i) => [i, purl[i]]),
        words,
      );
    put(filled.purl, "Fill from a target");
    const done = (/** @type {string} */ words) => {
      clear();
      studio.tell(words);
    };
    const keep = textButton("check", "Use it", () => done(`The chart is filled. ${UNDO}`), {
      class: "button primary",
      id: "fill-keep",
    });
    const back = textButton(
      "undo",
      "Take it back",
      () => {
        put(before, "Take the fill back");
        done("The chart is as it was.");
      },
      { id: "fill-back" },
    );
    const other = textButton("wand", "Another try", () => {
      seed += 1;
      put(before, "Take the fill back");
      void fill();
    });
    const changed = fillResult.parts.some(({ repainted }) => repainted);
    answer.replaceChildren(
      verdict(
        fillResult.parts.every((part, i) => !missed(part, targeted[i]).length),
        inWords(fillResult),
      ),
      painted ? h("p", {}, `Painted meanwhile, and left so: ${thousands(painted)} sts.`) : "",
      partList(fillResult, targeted),
      fillResult.parts.some(({ repainted }, i) => repainted && targeted[i].gauge)
        ? h("p", { class: "muted small" }, "Before: with your gauge. Now: of the computed size, until you count it.")
        : "",
      h("div", { class: "inverse-buttons" }, changed && keep, changed && back, other),
      h(
        "details",
        {},
        h("summary", {}, "Which patterns, and how near they come"),
        fillResult.patches.length > 0 && patchList(fillResult, targeted),
        ...fillResult.messages.map((message) => h("p", { class: "muted" }, inKnitting(message))),
      ),
    );
    belonging.show({ ...basis, chart: JSON.stringify([whole.text, outline]) });
    (changed ? keep : other).focus();
  };

  selection.listen(
    () => addButton.lastChild && (addButton.lastChild.textContent = selection.value ? "Selection" : "Whole chart"),
  );
  const addButton = textButton("plus", selection.value ? "Selection" : "Whole chart", addSelection, { id: "part-add" });
  show();
  const element = h(
    "div",
    { class: "inverse-section" },
    form(
      fill,
      h("div", { class: "inverse-bar" }, addButton, textButton("plus", "Regions", addRegions, { id: "part-regions" })),
      list,
      h(
        "details",
        { class: "inverse-more small" },
        h("summary", {}, "Options"),
        h("label", { class: "check" }, "No patch narrower than", smallest, "stitches"),
        h("label", { class: "check" }, scattered, "Allow irregular patterns (closer match, harder to knit by hand)"),
        h("label", { class: "check" }, large, "Allow larger patterns (the first time takes up to a minute)"),
      ),
      fillButton(studio, "fill-run", "fill", "a fill", run),
    ),
    answer,
  );
  chart.onSettle(measureAll);
  studio.materialId.listen(show);
  studio.gauges.changes.listen(() => void measureAll());
  return { element, opened: measureAll };
}

/** What became of the chart. @param {FillResult} fillResult */
function inWords({ parts }) {
  const left = parts.filter(({ repainted }) => !repainted).length;
  if (left === parts.length) return "The chart stays as it is.";
  return left ? "On the chart now; not all parts were changed." : "On the chart now.";
}

/** How a part misses its target. @param {FillResult["parts"][number]} part @param {Part} wish @returns {string[]} */
const missed = (part, wish) =>
  AXES.flatMap(({ axis, label }) => {
    const [now, target] = [part[`${axis}_n_per_mm`], wish[axis]];
    if (now === null || target === null) return [];
    const words = against(now, target);
    return words === "as wanted" ? [] : [`${words} along ${label}`];
  });

/** @param {FillResult["parts"][number]} part @param {Part} wish */
function partInWords(part, wish) {
  const off = missed(part, wish).join(" and ");
  if (part.repainted) return off ? `nearer, but ${off}.` : "as wanted.";
  if (!off) return "left as it was, which is as wanted.";
  const wished = AXES.filter(({ axis }) => wish[axis] !== null);
  const { nearest } = part;
  const moduli = wished.map(({ axis, label }) => `${figure(nearest[`${axis}_n_per_mm`])} N/mm along ${label}`);
  return [
    `left as it was, ${off}.`,
    `Nothing tried comes 10 % nearer${wished.length > 1 ? " without going away in the other direction" : ""}.`,
    `Nearest in a large cloth: ${nameOf(nearest.repeat)}, ${moduli.join(" and ")}.`,
  ].join(" ");
}

/** What each part has now, beside what it had and what was wanted. @param {FillResult} fillResult @param {Part[]} targeted */
function partList({ parts }, targeted) {
  return h(
    "ul",
    { class: "plain-list stack gap-6 small", id: "fill-parts" },
    ...parts.map((part, i) =>
      h(
        "li",
        {},
        h("strong", {}, part.name),
        `: ${partInWords(part, targeted[i])}`,
        ...AXES.map(({ axis, label }) => {
          const [before, now, target] = [part[`${axis}_before_n_per_mm`], part[`${axis}_n_per_mm`], targeted[i][axis]];
          const change = part.repainted ? `${figure(before)} → ${figure(now)}` : figure(now);
          const wished = target === null ? "" : h("span", { class: "muted" }, `, target ${figure(target)}`);
          return h("div", { class: "figures" }, `${label} ${change}`, wished);
        }),
      ),
    ),
  );
}

/** @param {Stiffness} now @param {number} times @returns {Stiffness} */
const scaled = ({ course, wale }, times) => ({ course: course * times, wale: wale * times });

/** How a stiffness compares with the wanted one, in words. @param {number} now @param {number} target */
function against(now, target) {
  const share = now / target;
  if (Math.abs(share - 1) <= NEAR) return "as wanted";
  const times = Math.max(share, 1 / share);
  const more = times >= 2 ? `${times.toFixed(1)} times ` : `${percent(times - 1)} `;
  return `${more}${share > 1 ? "too stiff" : "too soft"}`;
}

/** A message of the service, which speaks engineering, in the page's words. @param {string} message */
const inKnitting = (message) =>
  message
    .replaceAll("course-wise", "along rows")
    .replaceAll("wale-wise", "along columns")
    .replace(/[KP/]+(?= comes nearest)|(?<=The nearest, )[KP/]+/, nameOf);

/** @param {FillResult} fillResult @param {Part[]} targeted */
function patchList({ patches, columns }, targeted) {
  /** @param {{row: number, column: number}} patch */
  const partOf = ({ row, column }) => targeted.find(({ cells }) => cells.includes(row * columns + column));
  /** One entry for all patches of a part with the same pattern. @type {Map<string, FillResult["patches"][number]>} */
  const alike = new Map();
  for (const patch of patches) {
    const key = `${partOf(patch)?.name} ${patch.repeat}`;
    alike.set(key, { ...patch, stitches: patch.stitches + (alike.get(key)?.stitches ?? 0) });
  }
  const shown = [...alike.values()].toSorted((a, b) => b.stitches - a.stitches).slice(0, SHOWN_PATCHES);
  return h(
    "ul",
    { class: "candidates" },
    ...shown.map((patch) => {
      const part = partOf(patch);
      return h(
        "li",
        { class: "candidate flex gap-12" },
        repeatPicture(patch.repeat, 60),
        h(
          "div",
          { class: "small shrinks-x grows" },
          h("strong", { class: "candidate-title line gap-8" }, nameOf(patch.repeat)),
          h("div", { class: "muted" }, `${part?.name ?? ""}, ${thousands(patch.stitches)} sts`),
          ...AXES.map(({ axis, label }) => {
            const value = patch[`modulus_${axis}_n_per_mm`];
            const [low, high] = patch[`modulus_${axis}_interval_n_per_mm`];
            const target = part?.[axis];
            return h(
              "div",
              { class: "figures" },
              `${label} ${figure(value)} (${figure(low, 2)} – ${figure(high, 2)})`,
              target && h("div", { class: "muted" }, against(value, target)),
            );
          }),
        ),
      );
    }),
  );
}

/**
 * @param {number[]} cells in ascending order
 * @param {number} columns
 * @returns {[number, number, number][]} row, first column, length
 */
function runsOf(cells, columns) {
  /** @type {[number, number, number][]} */
  const runs = [];
  for (const i of cells) {
    const [row, column] = [Math.floor(i / columns), i % columns];
    const last = runs.at(-1);
    if (last && last[0] === row && last[1] + last[2] === column) last[2] += 1;
    else runs.push([row, column, 1]);
  }
  return runs;
}
