/**
 * All actions, and the keys that start them and the tools.
 *
 * @import {Action, ActionContext} from "./action.js"
 */

import { TOOLS } from "../tools/tools.js";
import { redo, undo } from "./history.js";
import { DESIGNS, INVERSE } from "./designs.js";
import { LOOK, STRETCH } from "./look.js";
import { SELECTION } from "./selection.js";
import { TRANSFORM } from "./transform.js";

/** @type {Action[]} */
const CHOOSE = TOOLS.map((tool) => ({
  id: `tool-${tool.id}`,
  label: tool.label,
  group: "Tools",
  icon: tool.icon,
  keys: [tool.key],
  perform: ({ studio }) => (studio.tool.value = tool),
}));

/** @type {Action[]} */
export const ACTIONS = [...CHOOSE, undo, redo, ...SELECTION, ...TRANSFORM, ...DESIGNS, ...INVERSE, ...LOOK, ...STRETCH];

/** @param {string} id */
export function action(id) {
  const match = ACTIONS.find((candidate) => candidate.id === id);
  if (!match) throw new Error(`There is no action ${id}.`);
  return match;
}

/**
 * Whether a key press is this shortcut.
 *
 * @param {string} shortcut
 * @param {{key: string, ctrlKey: boolean, metaKey: boolean, shiftKey: boolean, altKey: boolean}} event
 */
export function matches(shortcut, event) {
  const parts = shortcut.split("+").filter(Boolean);
  const key = shortcut === "+" ? "+" : parts[parts.length - 1];
  const named = /^([A-Z]|\w{2,})$/.test(key);
  return (
    event.key.toLowerCase() === key.toLowerCase() &&
    (event.ctrlKey || event.metaKey) === parts.includes("Mod") &&
    // ? and + need Shift on some keyboards; only letters and names tell it apart.
    (!named || event.shiftKey === parts.includes("Shift")) &&
    !event.altKey
  );
}

/** @param {ActionContext} context @param {() => boolean} isTyping */
export function listenToKeys(context, isTyping) {
  window.addEventListener("keydown", (event) => {
    if (isTyping() || document.querySelector("dialog[open]") || event.defaultPrevented) return;
    const match = ACTIONS.find(({ keys }) => keys.some((key) => matches(key, event)));
    if (!match || match.native) return;
    event.preventDefault();
    if (match.enabled?.(context.studio) !== false) match.perform(context);
  });
}
