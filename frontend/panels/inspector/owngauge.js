/**
 * Your own gauge of the cloth that the inspector describes.
 *
 * @import {Studio} from "../../state/studio.js"
 * @import {PredictResult} from "../../types.js"
 */

import { percent } from "../../core/format.js";
import { h } from "../../elements/dom.js";
import { scopeOf } from "../../services/scope.js";
import { anyClothIn } from "../../services/stitches.js";
import { numberField } from "../../widgets/fields.js";

/** Half of a 90 % interval of a size that was counted, as a share of it. */
const COUNTED = 0.05;
const OF_A_PART = "It is of this part only: the whole chart, in 3D and in tests, keeps its own size.";

/**
 * `show` fills in what is known, and says what a count would bring.
 *
 * @param {Studio} studio
 * @returns {{element: HTMLElement, show: (predicted: PredictResult | null) => void}}
 */
export function ownGauge(studio) {
  const cloth = () => anyClothIn(studio, scopeOf(studio));
  const keep = () => {
    const fields = [stitches, rows];
    if (fields.some((field) => !field.validity.valid)) return;
    const given = fields.filter((field) => field.value).length;
    if (given === 1) return; // the other is still to come
    const counted = { stitches_per_10_cm: stitches.valueAsNumber, rows_per_10_cm: rows.valueAsNumber };
    studio.gauges.keep(cloth(), given ? counted : null);
  };
  /** @param {string} id @param {string} label */
  const field = (id, label) =>
    numberField({ id, min: "1", max: "400", step: "any", "aria-label": label, onchange: keep });
  const stitches = field("own-gauge-stitches", "Stitches per 10 cm of your knitted cloth");
  const rows = field("own-gauge-rows", "Rows per 10 cm of your knitted cloth");
  const brings = h("span", { class: "muted full-width", id: "gauge-brings" });
  const element = h(
    "div",
    { class: "own-gauge line small", title: "Stitches and rows counted on 10 cm of cloth of this chart, at rest" },
    h("span", { class: "muted" }, "Your gauge, 10 cm:"),
    stitches,
    "×",
    rows,
    brings,
  );
  const show = (/** @type {PredictResult | null} */ predicted) => {
    const { gauge } = cloth();
    const counted = gauge?.known_by === "relaxation" ? null : gauge;
    const ofPart = scopeOf(studio).kind === "chart" ? "" : OF_A_PART;
    brings.textContent = counted ? ofPart : predicted ? gain(predicted) : "";
    if (element.contains(document.activeElement)) return;
    stitches.value = counted ? String(counted.stitches_per_10_cm) : "";
    rows.value = counted ? String(counted.rows_per_10_cm) : "";
  };
  return { element, show };
}

/** What a counted gauge would narrow, in words; "" if it would not. @param {PredictResult} predicted */
function gain({ relaxed_course_mm: width, relaxed_course_interval_mm: ends, hand }) {
  const size = half(ends, width);
  const stretch = hand.find(({ pull }) => pull === "hand")?.course;
  if (size <= COUNTED) return "";
  const [now, then] = [stretch?.strain_interval, stretch?.strain_with_gauge].map((of) =>
    stretch && of ? half(of, stretch.strain) : 0,
  );
  const narrows = then && now - then >= 0.02 ? `, and stretch from ${aboutOf(now)} to ${aboutOf(then)}` : "";
  return `A count narrows the size from ${aboutOf(size)} to ${aboutOf(COUNTED)}${narrows}.`;
}

/** Half of an interval as a share of its value. @param {readonly number[]} interval @param {number} value */
const half = ([low, high], value) => (high - low) / 2 / value;

/** @param {number} share */
const aboutOf = (share) => `±${percent(share)}`;
