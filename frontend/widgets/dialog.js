/** The frame that all dialogs share: a heading, a way to close it, and a click beside it closes it, too. */

import { h } from "../elements/dom.js";
import { iconButton } from "./buttons.js";

/** Inputs that Enter itself works on. */
const PRESSED = ["button", "checkbox", "file", "radio"];

/** @param {string} id @param {string} title @param {...import("../elements/dom.js").Child} content */
export function dialog(id, title, ...content) {
  const element = h(
    "dialog",
    { id, class: "dialog panelled shadowed", "aria-labelledby": `${id}-title` },
    h(
      "header",
      {},
      h("h2", { id: `${id}-title`, tabIndex: -1, autofocus: true }, title),
      iconButton("close", "Close", () => element.close()),
    ),
    ...content,
  );
  element.addEventListener("click", (event) => {
    if (event.target === element) element.close();
  });
  // As in a form, Enter in a field does what the main button says.
  element.addEventListener("keydown", (event) => {
    const { target, key, defaultPrevented } = event;
    const field = target instanceof HTMLInputElement && !target.form && !PRESSED.includes(target.type);
    if (key !== "Enter" || defaultPrevented || !field) return;
    const main = element.querySelector(".dialog-buttons .primary");
    if (!(main instanceof HTMLButtonElement)) return;
    event.preventDefault();
    main.click();
  });
  document.body.append(element);
  return element;
}
