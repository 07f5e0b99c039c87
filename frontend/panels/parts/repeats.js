/**
 * Linked repeats: their motifs, rules and copies.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {PlacementItem} from "../../design/design.js"
 * @import {Repeat} from "../../design/repeats.js"
 * @import {Box} from "../../grid/grid.js"
 * @import {Studio} from "../../state/studio.js"
 */

import { withKey } from "../../core/pointing.js";
import { action } from "../../actions/registry.js";
import { boxOf, filledBox } from "../../chart/placing.js";
import { MAX_ITEMS } from "../../design/design.js";
import { withPlace } from "../../design/repeats.js";
import { h, remark } from "../../elements/dom.js";
import { placeRepeat } from "../../tools/tools.js";
import { iconButton, textButton } from "../../widgets/buttons.js";
import { docked, refreshed } from "../../widgets/dock.js";
import { thumbnail } from "../../widgets/thumbnail.js";
import { numberField, textLine } from "../../widgets/fields.js";

/** @param {Studio} studio @param {ActionContext} context */
export function create(studio, context) {
  const { document: chart, selection, editing } = studio;
  const list = h("ol", { class: "plain-list" });
  const fromSelection = textButton("select", "New from the selection", () => action("make-repeat").perform(context), {
    id: "repeat-from-selection",
  });
  let closed = false;

  /** @param {Repeat} repeat */
  const item = (repeat) => {
    const { id, name, motif, placements, edgeColumns, edgeRows } = repeat;
    const open = !closed && editing.repeat?.id === id;
    const begin = () => {
      editing.repeatId.value = id;
      studio.tool.value = placeRepeat;
    };
    const fill = () => {
      const box = filledBox(repeat, selection.value ?? chart.grid.box);
      if (!box) return studio.tell(`${name} does not fit: it is a ${repeat.rule}.`);
      lay(repeat, withPlace(repeat, placed(box)), "Place a repeat");
    };
    /** @param {"edgeColumns" | "edgeRows"} field @param {string} label @param {number} value */
    const edge = (field, label, value) =>
      h(
        "label",
        { class: "edge-field line gap-6" },
        label,
        numberField({
          id: `${id}-${field}`,
          min: 0,
          max: 400,
          value,
          "aria-label": `${label} beyond whole motifs of ${name}`,
          onchange: (/** @type {Event} */ { target }) => {
            const number = /** @type {HTMLInputElement} */ (target).valueAsNumber;
            if (!Number.isInteger(number) || number < 0) return show();
            const next = repeat.with({ [field]: number });
            chart.changeRepeat(
              id,
              { [field]: number, placements: placements.map((place) => fitted(next, place)) },
              "Edge of a repeat",
            );
          },
        }),
      );
    return h(
      "li",
      { class: open ? "part open" : "part" },
      h(
        "div",
        { class: "part-head line gap-2" },
        thumbnail({ chart: motif.tiled(Math.max(6, motif.rows), Math.max(6, motif.columns)).text }, { side: 34 }),
        h(
          "button",
          {
            class: "part-name bare flex spread shrinks-x grows gap-8",
            id: `${id}-open`,
            "aria-expanded": String(open),
            onclick: () => ((closed = open), (editing.repeatId.value = id), show()),
          },
          h("span", {}, name),
          h("span", { class: "muted figures" }, `${motif.columns} × ${motif.rows}`),
        ),
      ),
      open &&
        h(
          "div",
          { class: "part-body stack" },
          textLine("Name", name, (value) => chart.changeRepeat(id, { name: value || name }, "Rename a repeat"), {
            id: `${id}-name`,
          }),
          h("p", { class: "muted figures" }, repeat.rule[0].toUpperCase() + repeat.rule.slice(1)),
          h(
            "div",
            { class: "line gap-12" },
            h("span", {}, "Edge"),
            edge("edgeColumns", "sts", edgeColumns),
            edge("edgeRows", "rows", edgeRows),
          ),
          h(
            "div",
            { class: "flex wrap gap-5" },
            textButton("repeat", "Place", begin, {
              id: `${id}-place`,
              "aria-pressed": String(studio.tool.value === placeRepeat),
              title: withKey("Then drag in the chart", "P"),
            }),
            textButton("fill", selection.value ? "Repeat over the selection" : "Repeat over the chart", fill, {
              id: `${id}-fill`,
            }),
          ),
          placements.length
            ? h("ul", { class: "plain-list" }, ...placements.map((place, at) => copy(repeat, place, at)))
            : remark("Not placed yet."),
          remark("Paint any copy: all follow."),
          h(
            "div",
            { class: "part-foot flex" },
            h("span", { class: "spacer" }),
            iconButton("trash", `Remove ${name}; its stitches stay`, () => chart.removeRepeat(id), {
              id: `${id}-remove`,
              title: "Remove; its stitches stay",
            }),
          ),
        ),
    );
  };

  /** @param {Repeat} repeat @param {PlacementItem[]} placements @param {string} label */
  const lay = (repeat, placements, label) => {
    if (placements.length > MAX_ITEMS) studio.tell(`A repeat has at most ${MAX_ITEMS} places.`);
    else chart.changeRepeat(repeat.id, { placements }, label);
  };

  /** @param {Repeat} repeat @param {PlacementItem} place @param {number} at */
  const copy = (repeat, place, at) => {
    const { id, motif, placements } = repeat;
    /** @param {"rows" | "columns"} axis @param {number} by */
    const resize = (axis, by) => {
      const next = { ...place, [axis]: place[axis] + by * motif[axis] };
      const start = axis === "rows" ? place.row : place.column;
      if (next[axis] < motif[axis] + (axis === "rows" ? repeat.edgeRows : repeat.edgeColumns)) return;
      if (start + next[axis] > chart.grid[axis]) {
        studio.tell("There is no room in the chart for another motif.");
        return;
      }
      lay(repeat, placements.with(at, next), "Resize a repeat");
    };
    /** @param {"rows" | "columns"} axis @param {string} word */
    const stepper = (axis, word) => {
      /** @param {"less" | "more"} which @param {number} by @param {string} sign */
      const step = (which, by, sign) =>
        h(
          "button",
          {
            class: "step bare",
            id: `${id}-${at}-${axis}-${which}`,
            "aria-label": `One motif ${which} ${word}`,
            onclick: () => resize(axis, by),
          },
          sign,
        );
      return h(
        "span",
        { class: "stepper inline", role: "group", "aria-label": `Motifs ${word}` },
        step("less", -1, "−"),
        h("span", { class: "figures" }, Math.floor(place[axis] / motif[axis])),
        step("more", 1, "+"),
      );
    };
    return h(
      "li",
      { class: "copy line muted" },
      h(
        "button",
        {
          class: "copy-name figures bare shrinks-x grows nowrap clipped",
          title: "Select this copy",
          id: `${id}-${at}-select`,
          onclick: () => (selection.value = boxOf(place)),
        },
        `Row ${place.row + 1}, st ${chart.grid.columns - place.column - place.columns + 1}`,
      ),
      stepper("columns", "across"),
      "×",
      stepper("rows", "up"),
      iconButton(
        "unlink",
        "Unlink this copy; its stitches stay",
        () => lay(repeat, placements.toSpliced(at, 1), "Unlink a copy"),
        { id: `${id}-${at}-unlink`, title: "Unlink this copy; its stitches stay" },
      ),
    );
  };

  const show = () => {
    fromSelection.disabled = !selection.value;
    refreshed(list, () =>
      chart.repeats.length
        ? chart.repeats.map(item)
        : [
            h(
              "li",
              { class: "muted part-empty small" },
              "A linked repeat is one motif in many places: change one copy and all follow. Select a motif (M) and press “New from the selection”.",
            ),
          ],
    );
  };
  const soon = () => {
    if (editing.panel.value === "repeats") show();
  };
  const open = docked(studio, "repeats", "Linked repeats", h("div", { class: "dock-buttons" }, fromSelection), list);
  editing.panel.watch(soon);
  editing.repeatId.listen(() => (closed = false));
  chart.onSettle(soon);
  selection.listen(soon);
  studio.tool.listen(soon);
  return open;
}

/**
 * A placement after its repeat's edge has changed: as many whole motifs as still fit.
 *
 * @param {Repeat} repeat
 * @param {PlacementItem} place
 */
function fitted(repeat, place) {
  const box = filledBox(repeat, boxOf(place));
  return box ? placed(box) : place;
}

/** A box as a place of a repeat. @param {Box} box @returns {PlacementItem} */
function placed({ row0, column0, row1, column1 }) {
  return { row: row0, column: column0, rows: row1 - row0, columns: column1 - column0 };
}
