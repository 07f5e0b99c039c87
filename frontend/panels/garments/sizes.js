/**
 * One garment in several sizes: every measurement of the body grows evenly, and each size is planned by itself.
 *
 * @import {GarmentRequest, GarmentResult} from "../../types.js"
 */

import { ApiError, api } from "../../api.js";
import { figure } from "../../core/format.js";
import { h, remark } from "../../elements/dom.js";
import { numberField } from "../../widgets/fields.js";
import { problemText } from "../../widgets/problem.js";
import { table, tableRow } from "../../widgets/table.js";
import { textButton } from "../../widgets/buttons.js";

/** Names of the sizes, and how many steps they are from the one that is measured. */
const SIZES = /** @type {const} */ ([
  ["XS", -2],
  ["S", -1],
  ["as measured", 0],
  ["L", 1],
  ["XL", 2],
]);

/**
 * @param {() => object} request the plan of the size that is measured
 * @param {GarmentResult} measured
 */
export function sizes(request, measured) {
  const wider = numberField({ min: "0", max: "20", step: "0.5", value: "5", "aria-label": "Wider by, in percent" });
  const longer = numberField({ min: "0", max: "20", step: "0.5", value: "3", "aria-label": "Longer by, in percent" });
  const answer = h("div", { id: "planner-sizes", role: "status" });
  const run = async () => {
    answer.replaceChildren(h("span", { class: "spinner" }), "Planning the sizes …");
    const [around, along] = [wider, longer].map(({ valueAsNumber: percent }) => 1 + (percent || 0) / 100);
    try {
      const plans = await Promise.all(
        SIZES.map(async ([name, steps]) => {
          const body = scaled(/** @type {GarmentRequest} */ (request()), around ** steps, along ** steps);
          return { name, plan: steps ? await api.run("garment", body) : measured };
        }),
      );
      const parts = measured.regions.map(({ name }) => name);
      answer.replaceChildren(
        table(
          { class: "planner-table figures full-width small" },
          ["Size", "Stitches × rows", "Yarn", ...parts],
          h(
            "tbody",
            {},
            ...plans.map(({ name, plan }) =>
              tableRow(
                name,
                `${plan.columns} × ${plan.rows}`,
                `${figure(plan.yarn_m)} m`,
                ...parts.map((part) => {
                  const region = plan.regions.find((other) => other.name === part);
                  return region ? `${region.columns} × ${region.rows}` : "–";
                }),
              ),
            ),
          ),
        ),
      );
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      answer.replaceChildren(problemText(error.problem));
    }
  };
  return h(
    "details",
    { class: "planner-warnings small" },
    h("summary", {}, "Table of sizes"),
    h(
      "div",
      { class: "line wrap gap-6" },
      "Each size",
      wider,
      "% wider and",
      longer,
      "% longer than the one before",
      textButton(null, "Count stitches and rows", () => void run(), { id: "planner-sizes-run" }),
    ),
    answer,
    remark("The whole chart, then the longest row and column of each part."),
  );
}

/** Measures that are taken along the body and not around it. */
const ALONG = /^(length_mm|cuff_mm|palm_mm|thumb_crotch_mm|gusset_mm)$/;

/**
 * @param {GarmentRequest} request
 * @param {number} around factor on circumferences
 * @param {number} along factor on lengths
 * @returns {GarmentRequest}
 */
function scaled(request, around, along) {
  /** Of a glove, `wrist_mm` is how long its support is. */
  const isGlove = request.garment.template === "glove";
  /** @param {string} key @param {unknown} value @returns {unknown} */
  const grown = (key, value) => {
    if (key === "profile")
      return /** @type {[number, number][]} */ (value).map(([at, girth]) => [at * along, girth * around]);
    if (key === "mmhg_profile")
      return /** @type {[number, number][]} */ (value).map(([at, mmhg]) => [at * along, mmhg]);
    if (Array.isArray(value)) return value.map((each) => grown("", each));
    if (value && typeof value === "object")
      return Object.fromEntries(Object.entries(value).map(([name, inner]) => [name, grown(name, inner)]));
    if (typeof value !== "number" || !key.endsWith("_mm") || ["hem_mm", "edge_mm"].includes(key)) return value;
    return value * (ALONG.test(key) || (isGlove && key === "wrist_mm") ? along : around);
  };
  return { ...request, garment: /** @type {GarmentRequest["garment"]} */ (grown("garment", request.garment)) };
}
