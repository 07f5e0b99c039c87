/**
 * What would narrow the intervals of the inspector: a line for each act, and the place where its result is given.
 *
 * @import {Studio} from "../../state/studio.js"
 * @import {Direction, Fabric, PredictResult} from "../../types.js"
 */

import { api } from "../../api.js";
import { LINES } from "../../core/directions.js";
import { percent, percentRange, unbroken } from "../../core/format.js";
import { byId, h } from "../../elements/dom.js";
import { adopt, uploaded } from "../../services/yarns.js";
import { verb } from "../../widgets/buttons.js";
import { attempt } from "../../widgets/problem.js";

/** @typedef {PredictResult["narrowing"][number]} Narrowing */

/**
 * `show` says what would narrow the stretch at a pull, and the size.
 *
 * @param {Studio} studio
 * @returns {{element: HTMLElement, show: (predicted: PredictResult | null, pull: string) => void}}
 */
export function narrower(studio) {
  const status = h("div", { role: "status" });
  const lines = h("div", {});
  /** The strip to pull. @type {{fabric: Fabric, direction: Direction} | null} */
  let strip = null;
  const file = h("input", {
    type: "file",
    id: "pull-file",
    accept: ".csv,.xlsx,.xls,.h5,.hdf5",
    class: "visually-hidden",
    tabIndex: -1,
    "aria-label": "Stretch test of the strip",
    onchange: async () => {
      const chosen = file.files?.[0];
      if (!chosen || !strip) return;
      file.value = "";
      const request = { test: await uploaded(chosen), material: studio.materialId.value, ...strip };
      await attempt(status, async () => {
        const { material, warning } = await api.run("measure/pull", request);
        await adopt(studio, material);
        status.textContent = warning;
      });
    },
  });
  /** @param {Narrowing} first of an act */
  const give = ({ act, fabric, direction }) => {
    if (act === "count") return byId("own-gauge-stitches").focus();
    strip = fabric && direction && { fabric, direction };
    file.click();
  };
  const show = (/** @type {PredictResult | null} */ predicted, /** @type {string} */ pull) => {
    const force = predicted?.hand.find((each) => each.pull === pull)?.n_per_mm;
    const shown = (predicted?.narrowing ?? []).filter((each) => isShown(each, force));
    const acts = new Set(shown.map(({ how }) => how));
    lines.replaceChildren(
      ...[...acts].map((how) => {
        const helped = shown.filter((each) => each.how === how);
        const because = helped.map((each) => `${NAMES[each.quantity]}: ${inShares(each)}`).join("\n");
        return h(
          "div",
          { title: because },
          verb(capital(how), () => give(helped[0])),
          unbroken(`: then ${inNumbers(helped)}.`),
        );
      }),
    );
  };
  return { element: h("div", { class: "small", id: "narrower" }, lines, file, status), show };
}

/** @type {Record<string, string>} */
const NAMES = {
  strain_course: `stretch along ${LINES.course}`,
  strain_wale: `stretch along ${LINES.wale}`,
  relaxed_course_mm: "width",
  relaxed_wale_mm: "height",
};

/** Whether the inspector shows a number, and something narrows it. @param {Narrowing} of @param {number | undefined} force */
const isShown = ({ quantity, n_per_mm, left }, force) =>
  left !== null && quantity in NAMES && (n_per_mm === null || n_per_mm === force);

/** What is left of intervals: of a stretch its ends, of sizes how far they may be off. @param {readonly Narrowing[]} all */
export function inNumbers(all) {
  const stretches = all
    .filter(({ n_per_mm }) => n_per_mm !== null)
    .map(
      ({ quantity, left }) =>
        `${percentRange(left ?? [])} % along ${quantity === "strain_course" ? LINES.course : LINES.wale}`,
    );
  const off = all
    .filter(({ n_per_mm }) => n_per_mm === null)
    .map(({ left }) => (left ? Math.sqrt(left[1] / left[0]) - 1 : 0));
  return [...stretches, ...(off.length ? [`size ±${percent(Math.max(...off))}`] : [])].join(", ");
}

/** Where an interval comes from, the largest part first. @param {Narrowing} of */
export const inShares = ({ shares }) =>
  Object.entries(shares)
    .filter(([, share]) => share >= 0.05)
    .map(([part, share]) => `${percent(share)} ${part}`)
    .join(", ");

/** @param {string} words */
const capital = (words) => words[0].toUpperCase() + words.slice(1);
