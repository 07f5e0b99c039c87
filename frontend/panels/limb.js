/**
 * The chart (or its part) worn as a tube: how hard it presses on a limb.
 *
 * @import {Studio} from "../studio.js"
 * @import {Direction, PressureResult} from "../types.js"
 */

import { ApiError, api, isAbort } from "../api.js";
import { figure, percent, range } from "../core/format.js";
import { Latest } from "../core/latest.js";
import { loadSettings, saveSettings } from "../core/store.js";
import { h } from "../dom.js";
import { scopeOf } from "../services/scope.js";
import { labelled, numberField } from "../widgets/fields.js";
import { problemText } from "../widgets/problem.js";

const DELAY_MS = 250;
/** A limb that a tube of the chart's size sits on firmly, over the size of the tube. */
const SNUG = 1.2;
const SETTINGS = { limbAround: /** @type {Direction} */ ("course") };

/**
 * @param {HTMLElement} host
 * @param {Studio} studio
 * @returns {() => void} asks anew
 */
export function limb(host, studio) {
  const settings = loadSettings(SETTINGS);
  const latest = new Latest(DELAY_MS);
  /** Whether somebody gave the tube's size; else it is the chart's. */
  let given = false;
  const ask = () => {
    const size = studio.prediction.value.value;
    if (host.hidden || !size) return;
    const { grid, counted } = scopeOf(studio);
    const direction = /** @type {Direction} */ (around.value);
    const wide =
      direction === "course" ? counted.grid.columns * size.relaxed_course_mm : counted.grid.rows * size.relaxed_wale_mm;
    if (!given) tube.value = wide.toFixed(0);
    if (!worn.value) worn.value = (SNUG * wide).toFixed(0);
    const body = {
      chart: grid.text,
      material: studio.materialId.value,
      direction,
      rest_mm: tube.valueAsNumber,
      worn_mm: worn.valueAsNumber,
    };
    if (!(body.rest_mm > 0 && body.worn_mm > 0)) return;
    saveSettings({ limbAround: direction });
    latest.run(async (signal) => {
      try {
        show(await api.pressure(body, signal));
      } catch (error) {
        if (isAbort(error)) return;
        if (!(error instanceof ApiError)) throw error;
        answer.replaceChildren(problemText(error.problem));
      }
    });
  };
  const worn = numberField({ id: "limb-worn", min: "10", max: "3000", oninput: ask });
  const tube = numberField({
    id: "limb-tube",
    min: "10",
    max: "3000",
    oninput: () => {
      given = tube.value !== "";
      ask();
    },
  });
  const around = h(
    "select",
    { class: "select", id: "limb-around", onchange: ask },
    h("option", { value: "course" }, "rows"),
    h("option", { value: "wale" }, "columns"),
  );
  around.value = settings.limbAround;
  const answer = h("div", { class: "limb-answer", role: "status", id: "limb-answer" });
  /** @param {PressureResult} found */
  const show = (found) => {
    const spread = found.mmhg_with_law_spread ?? found.mmhg;
    answer.replaceChildren(
      h(
        "p",
        { class: "limb-pressure" },
        h("span", { class: "value figures" }, `${range(found.mmhg)} mmHg`),
        h("span", { class: "muted figures" }, `90 % interval ${range(spread)}`),
      ),
      h(
        "p",
        { class: "muted figures" },
        `Stretched by ${percent(found.strain)} around the limb. From free to shorten along it (by ${percent(
          -found.axial_strain_free,
        )}) to held in its length; pulls with ${figure(found.tension_n_per_mm[1], 2)} N/mm at most.`,
      ),
      h("p", { class: "muted" }, "A mean over the limb, without friction or posture; not a medical class."),
    );
  };
  host.append(
    h(
      "div",
      { class: "limb-fields" },
      labelled("Limb, around", worn, "mm"),
      labelled("Tube at rest", tube, "mm"),
      labelled("Around it run the", around),
    ),
    answer,
  );
  studio.prediction.listen(({ busy }) => !busy && ask());
  return ask;
}
