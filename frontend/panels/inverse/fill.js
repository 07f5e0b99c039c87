/**
 * Fill from a target: stiffness for parts of the chart becomes stitches.
 *
 * @import {Studio} from "../../studio.js"
 * @import {FillResult} from "../../types.js"
 *
 * @typedef {{name: string, cells: number[], course: number | null, wale: number | null}} Part
 */

import { figure, percent } from "../../core/format.js";
import { Grid } from "../../core/grid.js";
import { FABRICS } from "../../core/segments.js";
import { selectedCells } from "../../core/selection.js";
import { outlineText } from "../../core/snapshot.js";
import { h } from "../../dom.js";
import { icon } from "../../icons.js";
import { iconButton, textButton } from "../../widgets/buttons.js";
import { thumbnail } from "../../widgets/thumbnail.js";
import { nameOf } from "./apply.js";
import { field } from "./find.js";
import { Run } from "../../widgets/jobrun.js";

const SHOWN_PATCHES = 6;

/** @param {Studio} studio */
export function fillTab(studio) {
  const { document: chart, selection } = studio;
  const run = new Run();
  const list = h("ol", { class: "wish-list", id: "parts" });
  const answer = h("div", { class: "inverse-answer", id: "fill-answer" });
  /** @type {Part[]} */
  let parts = [];
  /** Size of the chart that the parts were drawn on. */
  let size = "";

  const sizeNow = () => `${chart.grid.rows} ${chart.grid.columns}`;
  const outlineNow = () => (chart.shaped ? outlineText(chart.outline, chart.grid.columns) : null);
  const add = (/** @type {string} */ name, /** @type {number[]} */ all) => {
    const cells = all.filter((i) => chart.outline[i]);
    if (!cells.length) return;
    if (size !== sizeNow()) parts = [];
    size = sizeNow();
    parts.push({ name, cells, course: null, wale: null });
    show();
  };
  const addSelection = () => {
    const { grid } = chart;
    const cells = selectedCells(selection.value ?? grid.box, grid);
    add(selection.value ? `Part ${parts.length + 1}` : "Whole chart", cells);
  };
  const addRegions = () => {
    for (const region of chart.regions) {
      const cells = [];
      for (let i = 0; i < region.cells.length; i++) if (region.cells[i]) cells.push(i);
      if (!parts.some(({ name }) => name === region.name)) add(region.name, cells);
    }
  };

  /** @param {Part} part @param {number} at */
  const item = (part, at) => {
    /** @param {"course" | "wale"} axis @param {string} label */
    const value = (axis, label) => {
      const input = field(`${label}: ${part.name}`, 0, {
        min: "0.0001",
        step: "any",
        required: false,
        placeholder: "any",
        id: `part-${at}-${axis}`,
      });
      input.value = part[axis] === null ? "" : String(part[axis]);
      input.onchange = () => (part[axis] = Number.isFinite(input.valueAsNumber) ? input.valueAsNumber : null);
      return h(
        "label",
        { class: "part-value" },
        h("span", { class: "muted" }, axis === "course" ? "rows" : "columns"),
        input,
      );
    };
    const like = h(
      "select",
      {
        class: "text",
        "aria-label": `As stiff as a fabric: ${part.name}`,
        onchange: () => {
          const fabrics = studio.materials.value.find(({ id }) => id === studio.materialId.value)?.fabrics;
          const one = fabrics?.[/** @type {typeof FABRICS[number]} */ (like.value)];
          if (!one) return;
          part.course = Number(one.modulus_course_n_per_mm.toPrecision(3));
          part.wale = Number(one.modulus_wale_n_per_mm.toPrecision(3));
          show();
        },
      },
      h("option", { value: "" }, "like …"),
      ...FABRICS.map((fabric) => h("option", { value: fabric }, `like ${fabric}`)),
    );
    return h(
      "li",
      { class: "wish" },
      h(
        "div",
        { class: "wish-line" },
        h("input", {
          type: "text",
          class: "text part-title",
          value: part.name,
          maxLength: 80,
          "aria-label": "Name",
          onchange: (/** @type {Event} */ { target }) =>
            (part.name = /** @type {HTMLInputElement} */ (target).value.trim() || part.name),
        }),
        h("span", { class: "muted figures part-count" }, `${part.cells.length} sts`),
        iconButton("close", `Remove ${part.name}`, () => {
          parts = parts.filter((other) => other !== part);
          show();
        }),
      ),
      h(
        "div",
        { class: "wish-extra" },
        h("span", { class: "muted" }, "stiffness along"),
        value("course", "Stiffness along rows, N/mm"),
        value("wale", "Stiffness along columns, N/mm"),
        h("span", { class: "muted" }, "N/mm"),
        h("span", { class: "spacer" }),
        like,
      ),
    );
  };
  const show = () => {
    list.replaceChildren(
      ...(parts.length
        ? parts.map(item)
        : [
            h(
              "li",
              { class: "muted inverse-hint" },
              "Select stitches in the chart (M, Q or W) and add them as a part, or add all regions; then enter how stiff each should be. Leave a field empty for no preference.",
            ),
          ]),
    );
  };

  const smallest = field("Smallest patch, stitches", 4, { min: "1", max: "100", step: "1" });
  const seed = field("Variant", 0, { min: "0", step: "1" });
  const large = h("input", { type: "checkbox" });

  const fill = async () => {
    const { rows, columns } = chart.grid;
    const wished = parts.filter(({ course, wale }) => course !== null || wale !== null);
    if (!wished.length || size !== sizeNow()) {
      run.say({
        title: wished.length ? "The chart has another size now" : "There is no target",
        detail: wished.length
          ? "The parts were drawn on the chart as it was."
          : "A part needs a stiffness along rows or columns.",
        remedy: wished.length ? "Add the parts again." : "Add a part, and give it a number.",
      });
      return;
    }
    answer.replaceChildren();
    /** @type {FillResult | null} */
    const found = await run.run(
      "fill",
      {
        material: studio.materialId.value,
        rows,
        columns,
        chart: chart.grid.text,
        outline: outlineNow(),
        wishes: wished.map(({ name, cells, course, wale }) => ({
          name,
          runs: runsOf(cells, columns),
          modulus_course_n_per_mm: course,
          modulus_wale_n_per_mm: wale,
        })),
        repeats: large.checked ? "all" : "small",
        smallest_patch: smallest.valueAsNumber || 4,
        seed: seed.valueAsNumber || 0,
      },
      "Filling",
    );
    if (found) preview(found, wished);
  };

  /** @param {FillResult} found @param {Part[]} wished */
  const preview = (found, wished) => {
    const filled = Grid.fromText(found.chart);
    const cells = [...new Set(wished.flatMap((part) => part.cells))];
    const use = textButton(
      "check",
      "Apply",
      () => {
        if (size !== sizeNow()) {
          run.say({
            title: "The chart has another size now",
            detail: "The preview does not fit it any more.",
            remedy: "Fill again.",
          });
          return;
        }
        chart.set(
          cells.map((i) => [i, filled.purl[i]]),
          "Fill from a target",
        );
        studio.tell("The chart is filled. Undo with Ctrl+Z.");
      },
      { class: "button primary", id: "fill-apply" },
    );
    const good = found.off_share <= 0.05;
    answer.replaceChildren(
      h(
        "p",
        { class: good ? "inverse-verdict good" : "inverse-verdict" },
        icon(good ? "check" : "info"),
        h("span", {}, `${percent(1 - found.off_share)} of the area with a target is within 10 % of it.`),
      ),
      h(
        "div",
        { class: "inverse-preview" },
        thumbnail({ chart: found.chart, outline: outlineNow() }, { side: 190, label: "The filled chart" }),
        h(
          "div",
          { class: "preview-words" },
          ...found.messages.slice(0, 4).map((message) => h("p", {}, message)),
          found.patches.length > 0 && patchTable(found),
          h(
            "div",
            { class: "inverse-buttons" },
            use,
            h("button", { class: "button", onclick: () => answer.replaceChildren() }, "Discard"),
          ),
        ),
      ),
    );
    use.focus();
  };

  selection.listen(
    () => addButton.lastChild && (addButton.lastChild.textContent = selection.value ? "Selection" : "Whole chart"),
  );
  const addButton = textButton("plus", selection.value ? "Selection" : "Whole chart", addSelection, { id: "part-add" });
  show();
  const element = h(
    "div",
    { class: "inverse-section" },
    h(
      "form",
      {
        class: "inverse-form",
        onsubmit: (/** @type {Event} */ event) => {
          event.preventDefault();
          void fill();
        },
      },
      list,
      h(
        "div",
        { class: "inverse-bar" },
        addButton,
        textButton("plus", "Regions", addRegions, { id: "part-regions" }),
        h("label", { class: "check" }, "patches from", smallest, "sts"),
        h("label", { class: "check", title: "The same number gives the same chart again" }, "variant", seed),
        h(
          "label",
          { class: "check", title: "Choose from repeats up to 4 × 4; the first time takes up to a minute" },
          large,
          "Up to 4 × 4",
        ),
        h("span", { class: "spacer" }),
        h("button", { class: "button primary", type: "submit", id: "fill-run" }, "Fill"),
      ),
    ),
    run.element,
    answer,
  );
  return { element };
}

/** @param {FillResult} found */
function patchTable({ patches }) {
  const rows = patches.toSorted((a, b) => b.stitches - a.stitches).slice(0, SHOWN_PATCHES);
  /** @param {number | null} share */
  const away = (share) => (share === null ? "–" : `${share < 0 ? "−" : "+"}${Math.abs(100 * share).toFixed(0)} %`);
  return h(
    "table",
    { class: "inverse-numbers patches" },
    h(
      "thead",
      {},
      h(
        "tr",
        {},
        ...["Patch", "sts", "rows", "columns", "in the swatch"].map((text) => h("th", { scope: "col" }, text)),
      ),
    ),
    h(
      "tbody",
      {},
      ...rows.map((p) =>
        h(
          "tr",
          {},
          h("td", {}, nameOf(p.repeat)),
          h("td", { class: "figures" }, figure(p.stitches)),
          h("td", { class: "figures" }, away(p.deviation_course)),
          h("td", { class: "figures" }, away(p.deviation_wale)),
          h("td", { class: "figures muted" }, `${away(p.swatch_course)}, ${away(p.swatch_wale)}`),
        ),
      ),
    ),
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
