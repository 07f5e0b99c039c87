/**
 * Above the chart: its key, which side of the cloth is seen, how it is knitted and drawn, and zoom.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {Look, Symbols} from "../../state/editing.js"
 * @import {Signal} from "../../core/signal.js"
 */

import { withKey } from "../../core/pointing.js";
import { action } from "../../actions/registry.js";
import { h } from "../../elements/dom.js";
import { segmented } from "../../widgets/fields.js";
import { actionButton } from "../../widgets/buttons.js";
import { fullButton } from "../../widgets/full.js";

/** @type {Record<Symbols, string>} */
const SYMBOLS = { dots: "Dots", dashes: "Dashes", japanese: "Japanese" };
/** What a purl has, and a knit. @type {Record<Symbols, string>} */
const SAID = { dots: "a purl has a dot", dashes: "a purl has a dash", japanese: "a knit is upright, a purl is a dash" };
/** The looks that have symbols come in each kind. */
const LOOKS = {
  "on colours": /** @type {const} */ ("both"),
  "on paper": /** @type {const} */ ("symbols"),
};

/** @param {HTMLElement} host @param {ActionContext} context */
export function chartstrip(host, context) {
  const { studio } = context;
  const { editing, document: chart } = studio;
  const key = h("div", { class: "chart-key flex gap-12", role: "img" });
  const showKey = () => {
    const look = editing.look.value;
    const drawn = look === "loops" ? look : look === "colours" ? "plain" : editing.symbols.value;
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
    const symbol = drawn === "loops" ? "stitches drawn as loops" : drawn === "plain" ? "no symbols" : SAID[drawn];
    key.ariaLabel = `Key: ${symbol}${chart.shaped ? "; outside the outline there is no stitch" : ""}`;
  };
  editing.look.watch(showKey);
  editing.symbols.listen(showKey);
  let shaped = chart.shaped;
  chart.onSettle(() => {
    if (shaped !== chart.shaped) showKey();
    shaped = chart.shaped;
  });

  const look = h(
    "select",
    {
      class: "strip-select raised shrinks-x rounded",
      id: "look",
      title: withKey("How stitches are drawn, also in print", "V"),
      "aria-label": "How stitches are drawn",
      onchange: () => {
        const [chosen, symbols] = look.value.split(" ");
        if (symbols) editing.symbols.value = /** @type {Symbols} */ (symbols);
        editing.look.value = /** @type {Look} */ (chosen);
      },
    },
    ...Object.entries(LOOKS).flatMap(([ground, drawn]) =>
      Object.entries(SYMBOLS).map(([symbols, words]) =>
        h("option", { value: `${drawn} ${symbols}` }, `${words} ${ground}`),
      ),
    ),
    h("option", { value: "colours" }, "No symbols"),
    h("option", { value: "loops" }, "Loops"),
  );
  const showLook = () => {
    const { look: chosen, symbols } = editing;
    look.value = ["both", "symbols"].includes(chosen.value) ? `${chosen.value} ${symbols.value}` : chosen.value;
  };
  editing.look.watch(showLook);
  editing.symbols.listen(showLook);
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
      fullButton("chart", "strip-button bare centred rounded"),
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
