/**
 * Fill from a target, beside the chart: fabric and numbers stay in sight while stitches change.
 *
 * @import {Studio} from "../../state/studio.js"
 */

import { byId, h } from "../../elements/dom.js";
import { docked } from "../../widgets/dock.js";
import { plainNote } from "../../widgets/plainnote.js";
import { segmented } from "../../widgets/fields.js";
import { fromStiffness } from "./fill.js";
import { fromOutline } from "./outline.js";

/** @param {Studio} studio */
export function create(studio) {
  const stiffness = fromStiffness(studio);
  const ways = [
    { id: "stiffness", label: "Stiffness", ...stiffness },
    { id: "outline", label: "Outline under a stretch", ...fromOutline(studio) },
  ];
  const show = (/** @type {string} */ chosen) => ways.forEach(({ id, element }) => (element.hidden = id !== chosen));
  show("stiffness");
  const segments = ways.map(({ id, label }) => /** @type {const} */ ([id, label, { id: `fill-${id}` }]));
  const choice = segmented("What is asked for", segments, "stiffness", show);
  const content = h("div", { class: "inverse filling" }, choice.element, ...ways.map(({ element }) => element));
  const open = docked(studio, "fill", "Fill from a target", plainNote(studio, "The filling"), content);
  return () => {
    open();
    stiffness.opened();
    byId("panel-fill-title").focus({ preventScroll: true });
  };
}
