/**
 * The atlas browser: the scatter, and what a chosen repeat will do and ask.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {Studio} from "../../state/studio.js"
 * @import {AtlasResult} from "../../types.js"
 * @import {Point} from "./scatter.js"
 */

import { sourceInWords } from "../../core/plainly.js";
import { figure, percent, range, thousands } from "../../core/format.js";
import { STRETCH } from "../../core/hand.js";
import { Belonging } from "../../services/belonging.js";
import { Ink } from "../../design/ink.js";
import { motifGrid } from "../../grid/grid.js";
import { h, remark } from "../../elements/dom.js";
import { carry, chosenPlace, fillWith, nameOf, repeatPicture } from "./apply.js";
import { Run } from "../../widgets/jobrun.js";
import { inWords, scatter } from "./scatter.js";
import { textButton } from "../../widgets/buttons.js";
import { segmented } from "../../widgets/fields.js";

/** @param {Studio} studio @param {ActionContext} context */
export function atlasTab(studio, context) {
  const run = new Run();
  /** @type {Map<string, AtlasResult>} */
  const loaded = new Map();
  /** @type {AtlasResult | null} */ let table = null;
  let extent = "small";

  const tip = h("div", { class: "inverse-tip raised line small nowrap gap-10", hidden: true, "aria-hidden": "true" });
  const detail = h("div", { class: "inverse-detail", id: "inverse-detail", "aria-live": "polite" });
  const plot = scatter({
    onHover: (point) => hint(point),
    onPress: (point, event) => carry(event, studio, context.view, point.key, () => choose(point)),
    onChoose: (point) => choose(point),
    onApply: () => apply(),
  });
  const frame = h("div", { class: "inverse-plot grows clipped relative" }, plot.canvas, tip);
  const count = h("span", { class: "muted figures" });
  const extents = segmented(
    "Which repeats",
    [
      ["small", "Up to 3 × 3", { id: "atlas-small" }],
      ["all", "Up to 4 × 4", { id: "atlas-all" }],
    ],
    extent,
    (id) => {
      extent = id;
      void load();
    },
  );
  const repeats = h("div", { class: "column shrinks-y grows gap-8" }, frame, detail);
  const belonging = new Belonging(studio, () => ({ yarn: studio.materialId.value, wish: extent }));
  belonging.marks(repeats, "atlas");
  belonging.bars(repeats);
  /** @type {Point | null} */ let chosen = null;

  /** @param {Point | null} point */
  const hint = (point) => {
    tip.hidden = !point;
    if (!point || !table) return;
    tip.replaceChildren(
      repeatPicture(point.key, 64),
      h("div", {}, h("strong", {}, nameOf(point.key)), h("div", { class: "figures" }, inWords(point, table))),
    );
    const right = point.x > frame.clientWidth / 2;
    tip.style.left = right ? "" : `${point.x + 14}px`;
    tip.style.right = right ? `${frame.clientWidth - point.x + 14}px` : "";
    tip.style.top = `${Math.min(frame.clientHeight - 84, Math.max(4, point.y - 30))}px`;
  };
  /** @param {Point} point */
  const choose = (point) => {
    chosen = point;
    plot.choose(point.index);
    describe();
  };
  const apply = () => chosen && fillWith(studio, chosen.key, chosenPlace(studio));

  const describe = () => {
    if (!chosen || !table) {
      detail.replaceChildren(
        remark(
          "Every dot is a repeat. Point at one to see it, press it for its numbers, or drag it onto the chart, a region or the selection.",
        ),
        h(
          "p",
          { class: "inverse-legend flex wrap small" },
          h("span", {}, h("i", { class: "mark pure" }), "four fabrics"),
          table?.provenance.includes("swept") && h("span", {}, h("i", { class: "mark square" }), "simulated"),
          h("span", {}, h("i", { class: "mark" }), "estimated"),
        ),
      );
      return;
    }
    const { key, index: k } = chosen;
    /** @param {[name: string, value: string, spread?: string][]} rows */
    const numbers = (rows) =>
      h(
        "table",
        { class: "inverse-numbers small full-width" },
        h(
          "tbody",
          {},
          ...rows.map(([name, value, spread = ""]) =>
            h(
              "tr",
              {},
              h("th", { scope: "row" }, name),
              h("td", { class: "value" }, value),
              h("td", { class: "interval muted" }, spread),
            ),
          ),
        ),
      );
    const size = table.relaxed_course_mm[k];
    const picture = repeatPicture(key, 92);
    const handle = h("div", { class: "inverse-handle", title: "Drag it onto the chart" }, picture);
    handle.addEventListener("pointerdown", (event) => carry(event, studio, context.view, key));
    detail.replaceChildren(
      h(
        "div",
        { class: "inverse-chosen flex" },
        handle,
        h(
          "div",
          { class: "inverse-title stack shrinks-x" },
          h("strong", { id: "inverse-name" }, nameOf(key)),
          h("span", { class: "muted" }, sourceInWords(table.provenance[k])),
          h(
            "div",
            { class: "inverse-buttons" },
            textButton("fill", studio.selection.value ? "Fill the selection" : "Fill the chart", apply, {
              class: "button primary",
              id: "atlas-apply",
            }),
            textButton("pencil", "Paint with it", () => paintWith(studio, key)),
          ),
        ),
      ),
      numbers([
        [
          "Along rows",
          `${figure(table.modulus_course_n_per_mm[k])} N/mm`,
          range(table.modulus_course_interval_n_per_mm.map((ends) => ends[k])),
        ],
        [
          "Along columns",
          `${figure(table.modulus_wale_n_per_mm[k])} N/mm`,
          range(table.modulus_wale_interval_n_per_mm.map((ends) => ends[k])),
        ],
        [STRETCH, `${percent(table.stretch_course[k])} rows, ${percent(table.stretch_wale[k])} columns`],
      ]),
      numbers([
        ["Poisson ratios", `${figure(table.poisson_yx[k], 2)} and ${figure(table.poisson_xy[k], 2)}`],
        ["Stitch at rest", size === null ? "unknown" : `${figure(size)} × ${figure(table.relaxed_wale_mm[k])} mm`],
        [
          "To knit, a stitch",
          `${knittingInWords(table.transfers_per_stitch[k], table.crossings_per_stitch[k])}; ${curlInWords(table.curl[k])}`,
        ],
      ]),
    );
  };

  const load = async () => {
    const { basis } = belonging;
    belonging.check();
    const material = studio.materialId.value;
    const id = `${material} ${extent}`;
    if (!loaded.has(id)) {
      /** @type {AtlasResult | null} */
      const atlas = await run.run("atlas", { material, repeats: extent }, "Predicting all repeats");
      if (atlas) loaded.set(id, atlas);
      if (`${studio.materialId.value} ${extent}` !== id) return;
    }
    table = loaded.get(id) ?? null;
    chosen = null;
    count.textContent = table ? `${thousands(table.repeats.length)} repeats` : "";
    frame.dataset.count = String(table?.repeats.length ?? 0);
    plot.show(table);
    describe();
    if (table) belonging.show(basis);
    else belonging.clear();
  };
  const own = () => {
    const { value } = studio.prediction.value;
    plot.mark(value && { x: value.modulus_course_n_per_mm, y: value.modulus_wale_n_per_mm });
  };
  studio.prediction.listen(({ busy }) => !busy && own());
  studio.selection.listen(() => chosen && describe());
  describe();

  const element = h(
    "div",
    { class: "inverse-tab column shrinks-y gap-8" },
    h("div", { class: "inverse-bar" }, extents.element, count, h("span", { class: "spacer" })),
    run.element,
    repeats,
  );
  return {
    element,
    open: () => {
      own();
      void load();
    },
    retheme: () => {
      plot.draw();
      describe();
    },
  };
}

/** @param {Studio} studio @param {string} key */
export function paintWith(studio, key) {
  studio.paintWith(new Ink(`atlas-${key}`, nameOf(key), motifGrid(key), "From the atlas"));
  studio.tell(`You are painting with ${nameOf(key)}.`);
}

/** What a repeat takes to knit. @param {number} transfers by machine, a stitch @param {number} crossings by hand, a stitch */
export const knittingInWords = (transfers, crossings) =>
  transfers || crossings
    ? `${figure(transfers, 2)} moves between beds a stitch by machine, ${figure(crossings, 2)} changes from knit to purl by hand`
    : "easy to knit";

/** @param {number} curl */
export function curlInWords(curl) {
  if (Math.abs(curl) < 0.15) return "lies flat";
  return `${percent(Math.abs(curl))} more ${curl > 0 ? "knits" : "purls"}: ${Math.abs(curl) > 0.5 ? "curls" : "may curl"}`;
}
