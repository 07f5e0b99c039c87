/**
 * The chart's regions, uppermost first: paint them, name them, fill them, lock them.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {Region} from "../../design/regions.js"
 * @import {IconName} from "../../elements/icons.js"
 * @import {Studio} from "../../state/studio.js"
 */

import { thousands } from "../../core/format.js";
import { besides } from "../../core/pointing.js";
import { nameOf } from "../inverse/apply.js";
import { action } from "../../actions/registry.js";
import { hasRoom } from "../../actions/selection.js";
import { nextRegionColour } from "../../state/palette.js";
import { isFilled } from "../../design/regions.js";
import { KNIT, regionInk } from "../../design/ink.js";
import { motifGrid, motifText } from "../../grid/grid.js";
import { selectedCells, selectionOf } from "../../design/selection.js";
import { ownPatterns } from "../../design/shelf.js";
import { loadShelf } from "../../design/store.js";
import { h } from "../../elements/dom.js";
import { iconButton, textButton } from "../../widgets/buttons.js";
import { textLine } from "../../widgets/fields.js";
import { docked, refreshed } from "../../widgets/dock.js";

/** @param {Studio} studio @param {ActionContext} context */
export function create(studio, context) {
  const { document: chart, selection, ink } = studio;
  const list = h("ol", { class: "plain-list", reversed: true });
  let chosen = chart.regions.at(-1)?.id ?? "";

  const fromSelection = textButton("select", "From selection", () => action("make-region").perform(context), {
    id: "region-from-selection",
  });
  const empty = textButton(
    "plus",
    "New",
    () => {
      if (!hasRoom(studio, "regions", "regions")) return;
      const name = `Region ${chart.regions.length + 1}`;
      const region = chart.region(chart.addRegion({ name, colour: nextRegionColour(chart.regions) }));
      if (region) studio.paintWith(regionInk(region));
    },
    { id: "region-new", title: "A new region, to be painted" },
  );

  /** @param {Region} region @param {number} at */
  const item = (region, at) => {
    const { id, name, colour, hidden, locked, fill, yarn } = region;
    const open = id === chosen;
    /** @param {string} what @param {IconName} picture @param {string} label @param {() => void} perform @param {Record<string, unknown>} [more] */
    const small = (what, picture, label, perform, more = {}) =>
      iconButton(picture, `${label}: ${name}`, perform, { id: `${id}-${what}`, title: label, ...more });
    /** @param {string} what @param {IconName} picture @param {string} label @param {() => void} perform @param {Record<string, unknown>} [more] */
    const wide = (what, picture, label, perform, more = {}) =>
      textButton(picture, label, perform, { id: `${id}-${what}`, ...more });
    /** @param {number} value */
    const selected = (value) => {
      if (!selection.value) return;
      chart.set(
        selectedCells(selection.value, chart.grid).map((i) => [i, value]),
        name,
        `region:${id}`,
      );
    };
    const count = region.count;
    const filled = !fill || isFilled(region, chart);
    const painting = ink.value.target === `region:${id}`;
    return h(
      "li",
      { class: open ? "part open" : "part" },
      h(
        "div",
        { class: "part-head line gap-2" },
        h("input", {
          type: "color",
          id: `${id}-colour`,
          value: colour,
          title: "Colour",
          "aria-label": `Colour of ${name}`,
          onchange: (/** @type {Event} */ { target }) =>
            chart.changeRegion(id, { colour: /** @type {HTMLInputElement} */ (target).value }, "Recolour a region"),
        }),
        h(
          "button",
          {
            class: "part-name bare flex spread shrinks-x grows gap-8",
            id: `${id}-open`,
            "aria-expanded": String(open),
            onclick: () => ((chosen = open ? "" : id), show()),
          },
          h("span", {}, name),
          h("span", { class: "muted figures" }, `${thousands(count)} sts`),
        ),
        small(
          "hide",
          hidden ? "hidden" : "eye",
          hidden ? "Show" : "Hide",
          () => chart.changeRegion(id, { hidden: !hidden }, "Hide or show a region"),
          { "aria-pressed": String(hidden) },
        ),
        small(
          "lock",
          locked ? "lock" : "unlock",
          locked ? "Unlock" : "Lock",
          () => chart.changeRegion(id, { locked: !locked }, "Lock or unlock a region"),
          { "aria-pressed": String(locked) },
        ),
      ),
      open &&
        h(
          "div",
          { class: "part-body stack" },
          textLine("Name", name, (value) => chart.changeRegion(id, { name: value || name }, "Rename a region"), {
            id: `${id}-name`,
          }),
          h("label", { class: "line-field stack gap-8" }, h("span", {}, "Fill"), fills(region, filled)),
          textLine("Yarn", yarn ?? "", (value) => chart.changeRegion(id, { yarn: value || null }, "Yarn of a region"), {
            id: `${id}-yarn`,
            placeholder: "main yarn",
          }),
          h(
            "div",
            { class: "flex wrap gap-5" },
            wide(
              "paint",
              "pencil",
              painting ? "Painting it" : "Paint it",
              () => (painting ? (ink.value = KNIT) : studio.paintWith(regionInk(region))),
              {
                "aria-pressed": String(painting),
                title: besides("With any tool", "the right button takes stitches out"),
              },
            ),
            wide("select", "select", "Select it", () => (selection.value = selectionOf(region.cells, chart.grid)), {
              disabled: !count,
            }),
            wide("add", "plus", "Add selection", () => selected(1), { disabled: !selection.value || locked }),
            wide("take", "minus", "Take out", () => selected(0), {
              disabled: !selection.value || locked,
              title: "Take the selected stitches out",
            }),
            !filled &&
              wide("refill", "fill", "Fill again", () => chart.fillRegion(id), {
                disabled: locked,
                title: "Reapply the pattern over later changes",
              }),
          ),
          h(
            "div",
            { class: "part-foot flex" },
            small("up", "up", "Further up", () => chart.orderRegion(id, at + 1), {
              disabled: at === chart.regions.length - 1,
            }),
            small("down", "down", "Further down", () => chart.orderRegion(id, at - 1), { disabled: at === 0 }),
            h("span", { class: "spacer" }),
            small("remove", "trash", "Remove; its stitches stay", () => {
              if (painting) ink.value = KNIT;
              chart.removeRegion(id);
            }),
          ),
        ),
    );
  };

  /** @param {Region} region @param {boolean} filled whether it looks as its fill says */
  const fills = ({ id, fill, locked }, filled) => {
    const own = fill ? motifText(fill) : "";
    const patterns = [
      ...studio.shelf.value.flatMap(({ name, repeat }) => (repeat ? [{ name, motif: motifText(repeat) }] : [])),
      ...ownPatterns(chart.shelf, loadShelf()),
    ];
    const known = patterns.some(({ motif }) => motif === own);
    return h(
      "select",
      {
        id: `${id}-fill`,
        class: "text full-width",
        disabled: locked,
        onchange: (/** @type {Event} */ { target }) => {
          const { value } = /** @type {HTMLSelectElement} */ (target);
          chart.changeRegion(id, { fill: value ? motifGrid(value) : null }, "Fill a region");
        },
      },
      h("option", { value: "", selected: !own }, "None: as painted"),
      own && !known && h("option", { value: own, selected: true }, nameOf(own.replaceAll("\n", "/"))),
      ...patterns.map(({ name, motif }) =>
        h(
          "option",
          { value: motif, selected: motif === own },
          motif === own && !filled ? `${name}, painted over` : name,
        ),
      ),
    );
  };

  let known = chart.regions;
  const show = () => {
    fromSelection.disabled = !selection.value;
    const fresh = chart.regions.find((region) => !known.some(({ id }) => id === region.id));
    if (fresh) chosen = fresh.id;
    known = chart.regions;
    refreshed(list, () =>
      chart.regions.length
        ? chart.regions.map(item).reverse()
        : [
            h(
              "li",
              { class: "muted part-empty small" },
              "Regions name parts of the chart, such as a cuff or a heel: select some stitches (M, Q or W) and press “From selection”, or paint a new one.",
            ),
          ],
    );
  };
  const soon = () => {
    if (studio.editing.panel.value === "regions") show();
  };
  const open = docked(studio, "regions", "Regions", h("div", { class: "dock-buttons" }, fromSelection, empty), list);
  studio.editing.panel.watch(soon);
  chart.onSettle(soon);
  selection.listen(soon);
  ink.listen(soon);
  studio.shelf.listen(soon);
  return open;
}
