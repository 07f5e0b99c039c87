/** What the forms for a target share. */

import { h } from "../../elements/dom.js";
import { icon } from "../../elements/icons.js";
import { numberField } from "../../widgets/fields.js";

/** @param {() => unknown} submit @param {...import("../../elements/dom.js").Child} content */
export function form(submit, ...content) {
  const onsubmit = (/** @type {Event} */ event) => {
    event.preventDefault();
    void submit();
  };
  return h("form", { class: "inverse-form", onsubmit }, ...content);
}

/** How near an answer comes. @param {boolean} good @param {string} words */
export const verdict = (good, words) =>
  h(
    "p",
    { class: good ? "inverse-verdict good flex gap-8 rounded sunken" : "inverse-verdict flex gap-8 rounded sunken" },
    icon(good ? "check" : "info"),
    h("span", {}, words),
  );

/** @param {string} label @param {number} value @param {Record<string, unknown>} more */
export const field = (label, value, more = {}) =>
  numberField({ "aria-label": label, value: String(value), required: true, ...more });
