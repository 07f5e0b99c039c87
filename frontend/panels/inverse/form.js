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

/**
 * The button that fills the chart, how far that is, and why it cannot where the chart is too large.
 *
 * @param {import("../../state/studio.js").Studio} studio
 * @param {string} id of the button
 * @param {string} operation
 * @param {string} what it is for a knitter
 * @param {import("../../widgets/jobrun.js").Run} run
 */
export function fillButton(studio, id, operation, what, run) {
  const button = h("button", { class: "button primary", type: "submit", id }, "Fill");
  const note = h("p", { class: "muted small" });
  const show = () => {
    note.textContent = studio.tooLarge(operation, what);
    button.disabled = note.textContent !== "";
    note.hidden = !button.disabled;
  };
  studio.document.onChange(({ resized }) => resized && show());
  studio.largest.watch(show);
  return h("div", { class: "inverse-bar inverse-start" }, button, note, run.element);
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
