/** What went wrong, why, and what to do. */

import { h } from "../elements/dom.js";

/**
 * @param {{title: string, detail?: string, remedy?: string | null}} problem
 * @param {...import("../elements/dom.js").Child} more
 */
export function problemText({ title, detail, remedy }, ...more) {
  return h(
    "div",
    {},
    h("strong", {}, title),
    detail && detail !== title && h("p", {}, detail),
    remedy && h("p", {}, remedy),
    ...more,
  );
}
