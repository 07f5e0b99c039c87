/**
 * Fill from a target, beside the chart: fabric and numbers stay in sight while stitches change.
 *
 * @import {Studio} from "../../state/studio.js"
 */

import { byId, h } from "../../elements/dom.js";
import { docked } from "../../widgets/dock.js";
import { fromStiffness } from "./fill.js";
import { fromOutline } from "./outline.js";

/** @param {Studio} studio */
export function create(studio) {
  const stiffness = fromStiffness(studio);
  const ways = [
    { id: "stiffness", label: "Stiffness", ...stiffness },
    { id: "outline", label: "Outline under a stretch", ...fromOutline(studio) },
  ];
  const choice = h(
    "div",
    { class: "segmented", role: "radiogroup", "aria-label": "What is asked for" },
    ...ways.map(({ id, label }) =>
      h("button", { class: "segment", role: "radio", id: `fill-${id}`, onclick: () => show(id) }, label),
    ),
  );
  const show = (/** @type {string} */ chosen) =>
    ways.forEach(({ id, element }, i) => {
      element.hidden = id !== chosen;
      choice.children[i].setAttribute("aria-checked", String(id === chosen));
    });
  show("stiffness");
  const content = h("div", { class: "inverse filling" }, choice, ...ways.map(({ element }) => element));
  const open = docked(studio, "fill", "Fill from a target", content);
  return () => {
    open();
    stiffness.opened();
    byId("panel-fill-title").focus({ preventScroll: true });
  };
}
