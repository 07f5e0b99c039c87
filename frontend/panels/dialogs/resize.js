/**
 * The chart's size: cut or add at chosen sides, repeat what there is, or begin anew.
 *
 * @import {Studio} from "../../state/studio.js"
 */

import { Grid, MAX_SIDE } from "../../grid/grid.js";
import { tiledStitches } from "../../design/others.js";
import { resized } from "../../design/reshape.js";
import { h, remark } from "../../elements/dom.js";
import { dialog } from "../../widgets/dialog.js";
import { sizeFields } from "../../widgets/fields.js";
import { textButton } from "../../widgets/buttons.js";

const UP = /** @type {const} */ ([
  [1, "top"],
  [0.5, "middle"],
  [0, "bottom"],
]);
const ACROSS = /** @type {const} */ ([
  [0, "left"],
  [0.5, "middle"],
  [1, "right"],
]);

/** @param {Studio} studio */
export function create(studio) {
  const { document } = studio;
  const size = sizeFields("new", MAX_SIDE, () => advise());
  const advice = h("div", { class: "resize-advice line wrap spread gap-8" });
  const anchors = UP.flatMap(([up, vertical]) =>
    ACROSS.map(([across, horizontal]) => {
      const name = vertical === horizontal ? "middle" : `${vertical} ${horizontal}`;
      return h("input", {
        type: "radio",
        name: "anchor",
        class: "anchor",
        value: `${up} ${across}`,
        "aria-label": name,
        title: name,
        id: `anchor-${vertical}-${horizontal}`,
      });
    }),
  );

  /** @param {(rows: number, columns: number) => void} make */
  const apply = (make) => {
    const chosen = size.read();
    if (!chosen) return;
    make(chosen.rows, chosen.columns);
    element.close();
  };
  /** Repeats that span the chart stay whole only at some sizes: offer the nearest. */
  const advise = () => {
    const chosen = size.read();
    const { grid, repeats } = document;
    const spanning = repeats.filter(({ placements }) =>
      placements.some((place) => place.columns === grid.columns || place.rows === grid.rows),
    );
    advice.replaceChildren(
      ...spanning.flatMap((repeat) => {
        if (!chosen) return [];
        const wide = repeat.placements.some((place) => place.columns === grid.columns);
        const high = repeat.placements.some((place) => place.rows === grid.rows);
        const fits = repeat.snapped(chosen.rows, chosen.columns);
        const next = { rows: high ? fits.rows : chosen.rows, columns: wide ? fits.columns : chosen.columns };
        if (next.rows === chosen.rows && next.columns === chosen.columns) return [];
        return [
          h("p", { class: "muted" }, `${repeat.name} is a ${repeat.rule}.`),
          textButton(null, `Keep it whole: ${next.columns} × ${next.rows}`, () => {
            size.show(next);
            advise();
          }),
        ];
      }),
    );
  };
  const anchor = () => {
    const chosen = anchors.find(({ checked }) => checked)?.value ?? "0 0";
    const [up, across] = chosen.split(" ").map(Number);
    return /** @type {const} */ ([up, across]);
  };

  /** What only a chart with something in it needs. */
  const forContent = [
    h(
      "fieldset",
      { class: "anchors flex" },
      h("legend", {}, "The chart stays at"),
      h("div", { class: "anchor-grid stack" }, ...anchors),
    ),
    remark("Regions, outline and linked repeats move along. All three can be undone."),
    textButton(null, "New, all knit", () => apply((r, c) => document.replace(new Grid(r, c), "New chart"))),
    textButton(null, "Repeat to this size", () =>
      apply((r, c) => document.replace(document.grid.tiled(r, c), "Repeat", tiledStitches(document, r, c))),
    ),
  ];
  const [anchoring, note, anew, repeating] = forContent;
  const element = dialog(
    "resize-dialog",
    "Size of the chart",
    h("div", { class: "resize-fields flex wrap" }, h("div", { class: "fields" }, ...size.elements), anchoring),
    size.problem,
    advice,
    note,
    h(
      "div",
      { class: "dialog-buttons" },
      anew,
      repeating,
      textButton(
        null,
        "Set the size",
        () =>
          apply((r, c) => {
            const same = r === document.grid.rows && c === document.grid.columns;
            if (!same) document.reshape("Resize", resized(document.grid, r, c, anchor()));
          }),
        { class: "button primary", id: "resize-apply" },
      ),
    ),
  );
  return () => {
    const { grid, regions, repeats, shaped } = document;
    const empty = !grid.purl.some(Boolean) && !regions.length && !repeats.length && !shaped;
    for (const part of forContent) part.hidden = empty;
    size.show(grid);
    if (!anchors.some(({ checked }) => checked)) anchors[6].checked = true; // bottom left
    advise();
    element.showModal();
    size.columns.select();
  };
}
