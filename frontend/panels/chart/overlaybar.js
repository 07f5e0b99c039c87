/**
 * What the chart's colours show: chips, the legend, and a read-out of the stitch under the pointer.
 *
 * @import {ChartView} from "../../chart/view.js"
 * @import {Studio} from "../../state/studio.js"
 */

import { byHand, withKey } from "../../core/pointing.js";
import { OVERLAYS, shownOverlay } from "../../state/overlays.js";
import { largestStrain } from "../../chart/crosses.js";
import { GROUNDED } from "../../chart/others.js";
import { inWords, loadSigns, signsLoaded } from "../../chart/symbols.js";
import { groupAt, largestExtensibility, meanExtensibility } from "../../chart/rectangles.js";
import { LINES } from "../../core/directions.js";
import { figure, percent, percentRange, range } from "../../core/format.js";
import { paced } from "../../core/paced.js";
import { h } from "../../elements/dom.js";
import { KIND_GROUPS, kindOf } from "../../grid/kinds.js";
import { legendOf } from "../../widgets/legend.js";

/** Sides of the blocks that rectangles may stand for. */
const BLOCKS = [2, 4, 8, 16];
const READ_MS = 80;
const IDLE = byHand(
  "Click or drag to paint. Right button: the opposite. Wheel: zoom. ?: all keys.",
  "Tap or drag to paint. Two fingers move and zoom.",
);

/**
 * @param {HTMLElement} host
 * @param {Studio} studio
 * @param {ChartView} view
 * @returns {() => void} draws the legend anew, for another theme
 */
export function overlaybar(host, studio, view) {
  const chips = OVERLAYS.map((overlay) =>
    h(
      "button",
      {
        class: "chip gap-6 small nowrap",
        role: "radio",
        id: `overlay-${overlay.id}`,
        title: overlay.hint,
        "aria-label": overlay.label,
        onclick: () => (studio.overlay.value = overlay),
      },
      overlay.short,
    ),
  );
  const rectangles = h(
    "button",
    {
      class: "chip gap-6 small nowrap",
      id: "overlay-rectangles",
      title: withKey("Extensibility rectangles: as wide and as high as a stitch stretches along rows and columns", "E"),
      onclick: () => (studio.rectangles.value = !studio.rectangles.value),
    },
    h("span", { class: "chip-rectangle", "aria-hidden": "true" }),
    "Rectangles",
  );
  const { crosses: crossing } = studio.seeing;
  const crosses = h(
    "button",
    { class: "chip gap-6 small nowrap", id: "overlay-crosses", onclick: () => (crossing.value = !crossing.value) },
    "Stretch crosses",
  );
  crossing.watch((on) => crosses.setAttribute("aria-pressed", String(on)));
  crossing.listen(() => show());
  const grouping = h(
    "select",
    {
      class: "chip-select",
      id: "rectangle-groups",
      title: "What one rectangle stands for",
      "aria-label": "What one rectangle stands for",
      onchange: () => {
        const [groups, block] = grouping.value.split("-");
        if (block) studio.seeing.block.value = Number(block);
        studio.seeing.groups.value = /** @type {import("../../state/seeing.js").Groups} */ (groups);
      },
    },
    h("option", { value: "stitch" }, "each stitch"),
    ...BLOCKS.map((n) => h("option", { value: `block-${n}` }, `${n} × ${n} stitches`)),
    h("option", { value: "region" }, "each region"),
  );
  const { groups, block } = studio.seeing;
  grouping.value = groups.value === "block" ? `block-${block.value}` : groups.value;
  const legend = h("div", { class: "legend line small nowrap clipped" });
  const readout = h("output", { class: "readout figures line small nowrap muted clipped", id: "readout" });

  let pulled = false;
  const show = () => {
    const shown = shownOverlay(studio);
    pulled = Boolean(studio.currentStrain());
    const needs = studio.currentStretch() ? "Needs a pull: move the slider" : "Needs a stretch test of this chart";
    OVERLAYS.forEach((overlay, i) => {
      chips[i].setAttribute("aria-checked", String(overlay === shown));
      const available = overlay.available(studio);
      chips[i].disabled = !available;
      chips[i].title = available ? overlay.hint : `${overlay.hint}. ${needs}.`;
    });
    crosses.disabled = !pulled;
    crosses.title = `Stretch crosses: how far the cloth stretches along rows and columns; red where it narrows${
      pulled ? "" : `. ${needs}.`
    }`;
    legend.replaceChildren(...legendOf(shown.legend(studio, view.palette)));
    if (GROUNDED.has(shown.id)) {
      legend.append(
        ...groupsOf(studio).map((group) =>
          h("span", { class: "legend-item gap-5" }, h("span", { class: `key-cell ${group}` }), group),
        ),
      );
    }
    if (studio.rectangles.value) {
      legend.append(
        h(
          "label",
          { class: "legend-item gap-5" },
          h("span", { class: "chip-rectangle" }),

          grouping,
        ),
        h(
          "span",
          {
            class: "muted figures",
            id: "legend-rectangles",
            title: "Sides grow as the square root of what a stitch gives, on one scale for all",
          },
          `${drawnFor(studio, view)}as large as ${square(view.room.value)}: ${figure(largestExtensibility(studio.kinds()), 2)} mm/N`,
        ),
      );
    }
    const { stitch_fields: fields } = studio.currentStretch() ?? {};
    if (crossing.value && pulled && fields) {
      legend.append(
        h(
          "span",
          { class: "legend-item gap-5", id: "legend-crosses" },
          h("span", { class: "key-cross", "aria-hidden": "true" }),
          `stretch along rows and columns, as large as ${square(view.crossedSide.value)}: ${percent(largestStrain(fields))}`,
        ),
        h(
          "span",
          { class: "legend-item gap-5" },
          h("span", { class: "key-cross narrowed", "aria-hidden": "true" }),
          "narrower",
        ),
      );
    }
  };
  for (const signal of [studio.overlay, studio.material, studio.rectangles, groups, block]) signal.listen(show);
  for (const signal of [view.blockSide, view.room, view.crossedSide]) signal.listen(show);
  for (const signal of [studio.rectangles, groups, block]) signal.listen(() => read());
  studio.rectangles.watch((on) => rectangles.setAttribute("aria-pressed", String(on)));

  let keyed = groupsOf(studio).join();
  studio.document.onSettle(() => {
    const now = groupsOf(studio).join();
    if (now !== keyed) show();
    keyed = now;
  });
  const read = () => (readout.textContent = describe(studio, view));
  read();
  const readSoon = paced(read, READ_MS);
  view.hover.listen(readSoon);
  signsLoaded.listen(readSoon);
  studio.document.onChange(readSoon);
  studio.step.listen(() => {
    if (pulled !== Boolean(studio.currentStrain())) show();
    read();
  });
  studio.stretch.watch(() => {
    show();
    read();
  });

  host.append(
    h(
      "div",
      { class: "chips line wrap gap-2" },
      h(
        "div",
        { class: "chips line wrap gap-2", role: "radiogroup", "aria-label": "Colours of the chart" },
        ...chips.slice(0, 3),
        h("span", { class: "chip-heading small muted", "aria-hidden": "true" }, "Stiffness"),
        ...chips.slice(3, 6),
        h("span", { class: "chip-divider", "aria-hidden": "true" }),
        ...chips.slice(6),
      ),
      h("div", { class: "chips line gap-2" }, rectangles, crosses),
    ),
    legend,
    readout,
  );
  return show;
}

/** Groups of the chart's stitches that are neither knit nor purl. @param {Studio} studio */
function groupsOf({ document: { others } }) {
  const groups = new Set(Array.from(others.all, ([, code]) => kindOf(code).group));
  return KIND_GROUPS.filter((group) => groups.has(group));
}

/** @param {number} side */
const square = (side) => (side === 1 ? "a stitch" : `${side} × ${side} stitches`);

/** What one rectangle stands for, where the zoom is too small for what was chosen. @param {Studio} studio @param {ChartView} view */
function drawnFor({ seeing: { groups, block } }, { blockSide }) {
  const chosen = groups.value === "block" ? block.value : 1;
  return groups.value === "region" || blockSide.value === chosen
    ? ""
    : `too small to see: drawn for ${square(blockSide.value)}, `;
}

/** @param {Studio} studio @param {ChartView} view */
function describe(studio, view) {
  const { grid, codes } = studio.document;
  const cell = view.hover.value;
  if (!cell || !grid.has(...cell)) return IDLE;
  const [row, column] = cell;
  const i = grid.index(row, column);
  const side = studio.editing.round.value || row % 2 === 0 ? "RS" : "WS";
  const place = `Row ${row + 1} ${side}, stitch ${grid.columns - column}`;
  const other = studio.document.others.kind(i);
  if (other) void loadSigns(); // and the names
  if (other) return `${place}: ${inWords(other.code)}`;
  const parts = [`${place}: ${grid.purl[i] ? "purl" : "knit"}`];
  if (studio.rectangles.value && studio.kinds().length) {
    parts.push(give(studio, row, column, view.blockSide.value));
    return parts.join(" · ");
  }
  const kind = studio.kinds()[codes[i]];
  const { id } = shownOverlay(studio);
  const strain = studio.field("strain")?.[i];
  const used = studio.field("utilisation")?.[i];
  /** @param {"strain" | "utilisation"} name @param {number} [decimals] */
  const within = (name, decimals) => {
    const ends = studio.interval(name, i);
    return ends ? ` (${percentRange(ends, decimals)})` : "";
  };
  if (id === "strain" && strain !== undefined) {
    parts.push(`stretch ${percent(strain, 1)}${within("strain", 1)}`);
  } else if (id === "utilisation" && used !== undefined) {
    parts.push(`${percent(used)}${within("utilisation")} of its stretch used`);
  } else if (kind) {
    const value = (/** @type {"course" | "wale"} */ direction) => {
      const interval = range(kind[`modulus_${direction}_interval_n_per_mm`]);
      return `${LINES[direction]} ${figure(kind[`modulus_${direction}_n_per_mm`])}${interval && ` (${interval})`}`;
    };
    parts.push(`${value("course")}, ${value("wale")} N/mm`);
  }
  return parts.join(" · ");
}

/**
 * What the rectangle at a stitch says.
 *
 * @param {Studio} studio
 * @param {number} row
 * @param {number} column
 * @param {number} size of the blocks
 */
function give(studio, row, column, size) {
  const group = groupAt(studio, row, column, size);
  if (!group) return studio.seeing.groups.value === "region" ? "in no region" : "outside the piece";
  const kinds = studio.kinds();
  const { codes } = studio.document;
  const { course, wale } = meanExtensibility(kinds, codes, group.cells, group.count);
  const interval = (/** @type {"course" | "wale"} */ direction) => {
    let low = 0;
    let high = 0;
    for (const i of group.cells) {
      const [least, most] = kinds[codes[i]][`modulus_${direction}_interval_n_per_mm`] ?? [NaN, NaN];
      low += 1 / most;
      high += 1 / least;
    }
    const text = range([low / group.count, high / group.count]);
    return Number.isFinite(low) && text ? ` (${text})` : "";
  };
  const of = group.count > 1 ? `${group.count} stitches stretch` : "stretches";
  return `${of} along rows ${figure(course)}${interval("course")}, columns ${figure(wale)}${interval("wale")} mm/N`;
}
