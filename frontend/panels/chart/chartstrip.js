/**
 * Above the chart: its key, which side of the cloth is seen, how it is knitted and drawn, and zoom.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {Look} from "../../state/editing.js"
 * @import {Signal} from "../../core/signal.js"
 */

import { action } from "../../actions/registry.js";
import { h } from "../../elements/dom.js";
import { segmented, selectField } from "../../widgets/fields.js";
import { actionButton } from "../../widgets/buttons.js";

/** @type {Record<Look, string>} */
const LOOKS = { both: "Dots", colours: "Colours", symbols: "Symbols", loops: "Loops" };

/** @param {HTMLElement} host @param {ActionContext} context */
export function chartstrip(host, context) {
  const { studio } = context;
  const { editing, document: chart } = studio;
  const key = h("div", { class: "chart-key flex gap-12", role: "img" });
  const showKey = () => {
    const look = editing.look.value;
    const drawn = look === "loops" ? "loops" : look === "colours" ? "plain" : "dots";
    /** @param {string} kind @param {string} label */
    const entry = (kind, label) =>
      h(
        "span",
        { class: "legend-item gap-5" },
        h("span", { class: `key-cell relative ${kind} ${drawn}${look === "symbols" ? " paper" : ""}` }),
        label,
      );
    key.replaceChildren(
      entry("knit", "knit"),
      entry("purl", "purl"),
      ...(chart.shaped ? [entry("none", "no stitch")] : []),
    );
    const symbol = drawn === "dots" ? "a purl has a dot" : drawn === "loops" ? "stitches drawn as loops" : "no symbols";
    key.ariaLabel = `Key: ${symbol}${chart.shaped ? "; outside the outline there is no stitch" : ""}`;
  };
  editing.look.watch(showKey);
  let shaped = chart.shaped;
  chart.onSettle(() => {
    if (shaped !== chart.shaped) showKey();
    shaped = chart.shaped;
  });

  const look = selectField(
    {
      class: "strip-select raised shrinks-x rounded",
      id: "look",
      title: "How stitches are drawn (V)",
      "aria-label": "How stitches are drawn",
      onchange: () => (editing.look.value = /** @type {Look} */ (look.value)),
    },
    LOOKS,
  );
  editing.look.watch((value) => (look.value = value));
  // Colours were asked for: show them.
  studio.overlay.listen(() => {
    if (editing.look.value === "symbols") editing.look.value = "both";
  });

  /** @param {"fit" | "zoom-in" | "zoom-out"} id */
  const small = (id) => actionButton(action(id), context, "strip-button bare centred rounded");

  host.append(
    h(
      "div",
      { class: "chart-strip line small nowrap gap-10" },
      key,
      h("span", { class: "spacer" }),
      choice("Side of the cloth", "K", editing.back, [
        [false, "Face"],
        [true, "Back"],
      ]),
      choice("Knitted", "Shift+R", editing.round, [
        [false, "Flat"],
        [true, "Round"],
      ]),
      look,
      h("div", { class: "group flex gap-2" }, small("zoom-out"), small("zoom-in"), small("fit")),
    ),
  );
}

/**
 * Two choices side by side.
 *
 * @param {string} label
 * @param {string} key
 * @param {Signal<boolean>} signal
 * @param {[boolean, string][]} options
 */
function choice(label, key, signal, options) {
  const choices = options.map(
    ([value, text]) => /** @type {const} */ ([value, text, { id: `choose-${text.toLowerCase()}` }]),
  );
  const title = `${label} (${key})`;
  const { element, show } = segmented(label, choices, signal.value, (value) => (signal.value = value), {
    class: "segmented small",
    title,
  });
  signal.listen(show);
  return element;
}
