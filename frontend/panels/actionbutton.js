/**
 * A small button for an action: its icon, with the name and the key to hear and to hover.
 *
 * @import {Action, ActionContext} from "../actions/action.js"
 */

import { shown } from "../actions/registry.js";
import { h } from "../dom.js";
import { icon } from "../icons.js";

/**
 * @param {Action} action
 * @param {ActionContext} context
 * @param {string} look its CSS class
 */
export function actionButton({ id, label, icon: picture, keys, perform }, context, look) {
  return h(
    "button",
    {
      class: look,
      type: "button",
      id: `action-${id}`,
      title: `${label} (${shown(keys[0])})`,
      "aria-label": label,
      onclick: () => perform(context),
    },
    picture && icon(picture),
  );
}
