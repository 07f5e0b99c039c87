/**
 * What is known of a planned garment: sizes, yarn, regions, pressure, and what to watch.
 *
 * @import {GarmentResult} from "../../types.js"
 */

import { figure, percent, thousands } from "../../core/format.js";
import { PULL, STRETCH } from "../../core/hand.js";
import { h, remark } from "../../elements/dom.js";
import { icon } from "../../elements/icons.js";
import { isWarning } from "../../services/poser.js";
import { table, tableRow } from "../../widgets/table.js";

/** @param {GarmentResult} garment @param {string} unit mm or in @returns {Node[]} */
export function facts(garment, unit) {
  const { columns, rows, stitches, yarn_m, yarn_g, yarn_interval_m, yarn_interval_g, gauges } = garment;
  const gauge = gauges.find(({ fabric }) => fabric === "stockinette") ?? gauges[0];
  const mass = yarn_g === null || !yarn_interval_g ? "" : `, ${figure(yarn_g)} g (${span(yarn_interval_g)})`;
  return [
    h(
      "p",
      { class: "figures", title: `90 % intervals: ${garment.interval_source}` },
      h("strong", {}, `${columns} sts × ${rows} rows`),
      ` · ${thousands(stitches)} stitches · ${figure(yarn_m)} m (${span(yarn_interval_m)}) of yarn${mass} · gauge ${figure(gauge.stitches_per_10_cm)} sts × ${figure(gauge.rows_per_10_cm)} rows per 10 cm of ${gauge.fabric}`,
    ),
    ...garment.warnings.filter(isWarning).map((words) => h("p", { class: "problem-text", role: "alert" }, words)),
    regions(garment, unit),
    remark(
      "Sizes are those of each fabric by itself, from which its stitches are counted. In the piece its neighbours widen or narrow it; a pattern gives those sizes.",
    ),
    ...sizes(garment),
    ...pressure(garment, unit),
    h(
      "ul",
      { class: "planner-notes plain-list stack gap-5 small" },
      ...garment.warnings
        .filter((words) => !isWarning(words))
        .map((words) => h("li", { class: "warned" }, icon("warning"), words)),
      ...garment.notes.map((words) => h("li", {}, icon("info"), words)),
      h("li", {}, icon("info"), `To close: ${garment.closing}.`),
    ),
  ];
}

/** Stitches and rows of each size, where they were asked for. @param {GarmentResult} garment @returns {Node[]} */
function sizes({ sizes: all, regions: parts }) {
  if (!all?.length) return [];
  return [
    table(
      { class: "planner-table figures full-width small", id: "planner-sizes" },
      ["Size", "Stitches × rows", "Yarn", ...parts.map(({ name }) => name)],
      h(
        "tbody",
        {},
        ...all.map((size) =>
          tableRow(
            size.name,
            `${size.columns} × ${size.rows}`,
            `${figure(size.yarn_m)} m`,
            ...parts.map(({ name }) => {
              const part = size.parts.find((other) => other.name === name);
              return part ? `${part.columns} × ${part.rows}` : "–";
            }),
          ),
        ),
      ),
    ),
    remark("The whole chart, then the longest row and column of each part. The table goes into the design's note."),
  ];
}

/** @param {number} mm @param {string} unit */
const long = (mm, unit) => (unit === "in" ? (mm / 25.4).toFixed(1) : mm.toFixed(0));

/** @param {GarmentResult} garment @param {string} unit */
function regions({ regions: all }, unit) {
  return table(
    { class: "planner-table figures full-width small" },
    [
      "Region",
      "Stitches × rows",
      `By itself, at rest, ${unit}`,
      "Yarn",
      h("span", { title: PULL }, `${STRETCH}, rows × columns`),
    ],
    h(
      "tbody",
      {},
      ...all.map((region) => {
        const swatch = h("span", { class: "planner-swatch" });
        swatch.style.background = region.colour;
        return tableRow(
          h("span", { class: "line" }, swatch, region.name),
          `${region.columns} × ${region.rows}`,
          `${long(region.width_mm, unit)} × ${long(region.height_mm, unit)}`,
          `${figure(region.yarn_m)} m${region.yarn_g === null ? "" : `, ${figure(region.yarn_g)} g`}`,
          `${percent(region.hand.course.strain)} × ${percent(region.hand.wale.strain)}`,
        );
      }),
    ),
  );
}

/** @param {GarmentResult} garment @param {string} unit @returns {Node[]} */
function pressure({ worn }, unit) {
  if (!worn.length) return [];
  const pressed = worn.filter(({ ease }) => ease < 0);
  const warned = [...new Set(pressed.flatMap((place) => place.warnings))].filter((words) => !isWarning(words));
  return [
    table(
      { class: "planner-table figures full-width small", id: "planner-pressure" },
      ["Where it is worn", `Garment, ${unit}`, `Limb, ${unit}`, "Ease", "Pressure"],
      h(
        "tbody",
        {},
        ...worn.map((place) =>
          tableRow(
            `${place.part}, ${long(place.at_mm, unit)} ${unit}`,
            long(place.rest_mm, unit),
            long(place.worn_mm, unit),
            h("span", { class: "nowrap" }, percent(place.ease)),
            place.mmhg && place.kpa
              ? h(
                  "span",
                  {},
                  h("span", { class: "nowrap" }, `${span(place.mmhg)} mmHg`),
                  " ",
                  h("span", { class: "muted nowrap" }, `(${span(place.kpa)} kPa)`),
                )
              : place.ease < 0
                ? "not known"
                : "loose",
          ),
        ),
      ),
    ),
    ...(warned.length
      ? [
          h(
            "details",
            { class: "planner-warnings small" },
            h("summary", {}, `About the pressure (${warned.length})`),
            h("ul", {}, ...warned.map((words) => h("li", {}, words))),
          ),
        ]
      : []),
  ];
}

/** @param {[low: number, high: number]} ends */
const span = ([low, high]) => `${figure(low, 2)} – ${figure(high, 2)}`;
