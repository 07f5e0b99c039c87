/**
 * The chart or the cloth over the whole screen, for phones and tablets and for whoever wants to see it large.
 */

import { iconButton } from "./buttons.js";
import { icon } from "../elements/icons.js";

/**
 * The button that does so, and takes it back; so does Escape.
 *
 * @param {"chart" | "cloth"} part
 * @param {string} look its CSS classes
 */
export function fullButton(part, look) {
  const { dataset } = document.documentElement;
  const button = iconButton("fit", "", () => show(dataset.full === part ? "" : part), {
    class: look,
    id: `full-${part}`,
  });
  const show = (/** @type {string} */ full) => {
    if (full) dataset.full = full;
    else delete dataset.full;
  };
  const name = () => {
    const full = dataset.full === part;
    button.ariaLabel = button.title = full ? "Back to the whole page (Esc)" : `The ${part} on the whole screen`;
    button.ariaPressed = String(full);
    button.replaceChildren(icon(full ? "close" : "full"));
  };
  name();
  new MutationObserver(name).observe(document.documentElement, { attributeFilter: ["data-full"] });
  addEventListener("keydown", ({ key, defaultPrevented }) => {
    if (key === "Escape" && !defaultPrevented && dataset.full === part) show("");
  });
  return button;
}
