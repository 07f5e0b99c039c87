/**
 * Buttons with a sign, with words or in place of them.
 *
 * @import {Action, ActionContext} from "../actions/action.js"
 * @import {Child} from "../elements/dom.js"
 * @import {IconName} from "../elements/icons.js"
 */

import { shown } from "../core/pointing.js";
import { h } from "../elements/dom.js";
import { icon } from "../elements/icons.js";

/**
 * A button that shows only a sign; its label is for screen readers and, as a title, for the pointer.
 *
 * @param {IconName} sign
 * @param {string} label
 * @param {() => void} perform
 * @param {Record<string, unknown>} [more] properties
 */
export function iconButton(sign, label, perform, more = {}) {
  return h("button", { class: "button quiet icon-only", "aria-label": label, onclick: perform, ...more }, icon(sign));
}

/**
 * A button with words and perhaps a sign before them.
 *
 * @param {IconName | null} sign
 * @param {string | Node} label
 * @param {() => unknown} perform
 * @param {Record<string, unknown>} [more] properties
 */
export function textButton(sign, label, perform, more = {}) {
  return h("button", { class: "button", onclick: perform, ...more }, sign && icon(sign), label);
}

/**
 * A verb within a sentence, which breaks with its line: what a browser takes for a button stands in a box of its own.
 *
 * @param {string} words
 * @param {() => unknown} perform
 * @param {Record<string, unknown>} [more] properties
 */
export function verb(words, perform, more = {}) {
  const onkeydown = (/** @type {KeyboardEvent} */ event) => {
    if (event.key !== "Enter" && event.key !== " ") return;
    event.preventDefault();
    perform();
  };
  return h("span", { class: "link", role: "button", tabIndex: 0, onclick: perform, onkeydown, ...more }, words);
}

/**
 * A button for an action, with its key in its title.
 *
 * @param {Action} action
 * @param {ActionContext} context
 * @param {string} look its CSS class
 * @param {Record<string, unknown>} [more] properties
 * @param {...Child} content beside its sign
 */
export function actionButton({ id, label, icon: picture, keys, perform }, context, look, more = {}, ...content) {
  const title = keys[0] ? `${label} (${shown(keys[0])})` : label;
  const onclick = () => perform(context);
  const properties = { class: look, id: `action-${id}`, title, "aria-label": label, onclick, ...more };
  return h("button", properties, picture && icon(picture), ...content);
}
