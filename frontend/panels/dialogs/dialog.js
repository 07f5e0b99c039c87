/** The frame that all dialogs share: a heading, a way to close it, and a click beside it closes it, too. */

import { h } from "../../dom.js";
import { icon } from "../../icons.js";

/**
 * @param {string} id
 * @param {string} title
 * @param {...Node} content
 */
export function dialog(id, title, ...content) {
  const element = h(
    "dialog",
    { id, class: "dialog", "aria-labelledby": `${id}-title` },
    h("header", {},
      h("h2", { id: `${id}-title` }, title),
      h("button", { class: "button quiet icon-only", type: "button", "aria-label": "Close", onclick: () => element.close() }, icon("close"))),
    ...content,
  );
  element.addEventListener("click", (event) => {
    if (event.target === element) element.close();
  });
  document.body.append(element);
  return element;
}
