/** A row of a list: its picture if it has one, its name over a note, and what can be done with it. */

import { h } from "../elements/dom.js";

/** @import {Child} from "../elements/dom.js" */

/** @param {Child} picture @param {string} name @param {string} note @param {...Child} more */
export const listRow = (picture, name, note, ...more) =>
  h(
    "li",
    { class: "row wrap" },
    picture,
    h(
      "span",
      { class: "row-text stack shrinks-x" },
      h("span", { class: "ellipsis" }, name),
      h("span", { class: "muted" }, note),
    ),
    ...more,
  );
