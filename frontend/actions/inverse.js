/**
 * From a target to a fabric: the atlas, the search, and filling.
 *
 * @import {Action} from "./action.js"
 * @import {IconName} from "../elements/icons.js"
 */

/**
 * @param {"atlas" | "find" | "fill"} panel
 * @param {string} label
 * @param {string} key
 * @param {IconName} icon
 * @returns {Action}
 */
const action = (panel, label, key, icon) => ({
  id: `open-${panel}`,
  label,
  group: "From a target to a fabric",
  icon,
  keys: [key],
  perform: ({ open }) => open(panel),
});

/** @type {Action[]} */
export const INVERSE = [
  action("atlas", "Atlas of all repeats", "A", "scatter"),
  action("find", "Find a fabric by its numbers", "Shift+F", "search"),
  action("fill", "Fill the chart from a target", "Shift+W", "target"),
];
