/**
 * What can be done with the selection; while there is one, it takes the place of the strip's choices.
 *
 * @import {ActionContext} from "../../actions/action.js"
 */

import { thousands } from "../../core/format.js";
import { action } from "../../actions/registry.js";
import { selectedCells } from "../../design/selection.js";
import { h } from "../../elements/dom.js";
import { actionButton } from "../../widgets/buttons.js";

const GROUPS = [
  ["copy", "cut", "paste", "clear"],
  ["mirror", "flip", "rotate", "turn-over", "swap"],
  ["insert-row-above", "delete-rows", "insert-column-right", "delete-columns"],
];
const NAMED = [
  ["keep-pattern", "Pattern"],
  ["make-repeat", "Repeat"],
  ["make-region", "Region"],
];

/** @param {HTMLElement} host @param {ActionContext} context */
export function selectionbar(host, context) {
  const { studio } = context;
  /** @param {string} id @param {string} [text] */
  const button = (id, text) => {
    const look = `bar-button bare inline small gap-4 ${text ? "named" : ""}`;
    return actionButton(action(id), context, look, { id: `selection-${id}` }, text && h("span", {}, text));
  };
  const count = h("span", { class: "bar-count figures" });
  const bar = h(
    "div",
    { class: "selection-bar raised", role: "toolbar", "aria-label": "Selection", id: "selection-bar", hidden: true },
    count,
    ...GROUPS.map((group) => h("span", { class: "bar-group flex" }, ...group.map((id) => button(id)))),
    h("span", { class: "bar-group flex" }, ...NAMED.map(([id, text]) => button(id, text))),
    button("deselect"),
  );
  const strip = host.querySelector(".chart-strip");
  strip?.append(bar);
  studio.selection.watch((selection) => {
    bar.hidden = !selection;
    strip?.toggleAttribute("data-selecting", selection !== null);
    if (!selection) return;
    const wide = selection.column1 - selection.column0;
    const high = selection.row1 - selection.row0;
    count.textContent = selection.mask
      ? `${thousands(selectedCells(selection, studio.document.grid).length)} sts`
      : `${wide} × ${high}`;
  });
}
