/**
 * Your own gauge of the cloth that the inspector describes.
 *
 * @import {Studio} from "../../state/studio.js"
 */

import { h } from "../../elements/dom.js";
import { scopeOf } from "../../services/scope.js";
import { numberField } from "../../widgets/fields.js";

/** @param {Studio} studio @returns {{element: HTMLElement, show: () => void}} `show` fills in what is known */
export function ownGauge(studio) {
  const cloth = () => ({ chart: scopeOf(studio).grid.text, material: studio.materialId.value });
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
  const element = h(
    "div",
    { class: "own-gauge line", title: "Counted on cloth of this chart at rest: it makes the numbers more certain" },
    "Your gauge, 10 cm:",
    stitches,
    "×",
    rows,
  );
  const show = () => {
    if (element.contains(document.activeElement)) return;
    const known = studio.gauges.changes.value ? studio.gauges.of(cloth()) : null;
    const counted = known?.known_by === "relaxation" ? null : known;
    stitches.value = counted ? String(counted.stitches_per_10_cm) : "";
    rows.value = counted ? String(counted.rows_per_10_cm) : "";
  };
  return { element, show };
}
