/**
 * Your own gauge of the cloth that the inspector describes.
 *
 * @import {Studio} from "../../state/studio.js"
 */

import { h } from "../../elements/dom.js";
import { scopeOf } from "../../services/scope.js";
import { anyClothIn } from "../../services/stitches.js";
import { numberField } from "../../widgets/fields.js";

const OF_A_PART = "It is of this part only: the whole chart, in 3D and in tests, keeps its own size.";

/**
 * `show` fills in what is known.
 *
 * @param {Studio} studio
 * @returns {{element: HTMLElement, show: () => void}}
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
  const scope = h("span", { class: "muted full-width", id: "gauge-scope" });
  const element = h(
    "div",
    { class: "own-gauge line small", title: "Stitches and rows counted on 10 cm of cloth of this chart, at rest" },
    h("span", { class: "muted" }, "Your gauge, 10 cm:"),
    stitches,
    "×",
    rows,
    scope,
  );
  const show = () => {
    const { gauge } = cloth();
    const counted = gauge?.known_by === "relaxation" ? null : gauge;
    const ofPart = scopeOf(studio).kind === "chart" ? "" : OF_A_PART;
    scope.textContent = counted ? ofPart : "";
    if (element.contains(document.activeElement)) return;
    stitches.value = counted ? String(counted.stitches_per_10_cm) : "";
    rows.value = counted ? String(counted.rows_per_10_cm) : "";
  };
  return { element, show };
}
