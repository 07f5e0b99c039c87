/** How this device is pointed at and typed on: what is said of mouse and keys, and on a touch screen is not. */

const IS_TOUCHED = globalThis.matchMedia?.("(pointer: coarse)").matches ?? false;
const IS_MAC = /^(Mac|iP)/.test(globalThis.navigator?.platform ?? "");

/** Keys as this computer calls them. @param {string} [keys] empty for what has none */
export function shown(keys = "") {
  const own = keys.replace("Mod+", IS_MAC ? "⌘" : "Ctrl+").replace("Escape", "Esc");
  return IS_MAC ? own.replace(/\bAlt\b/, "Option") : own;
}

/** Words for a mouse and keys, or those for fingers. @param {string} mouse @param {string} fingers */
export const byHand = (mouse, fingers) => (IS_TOUCHED ? fingers : shown(mouse));

/** How to take something back. */
export const UNDO = byHand("Undo with Mod+Z.", "Undo takes it back.");

/** Words, and what mouse and keys do besides. @param {string} words @param {string} besides */
export const besides = (words, besides) => byHand(`${words}; ${besides}`, words);

/** Words with their key behind them. @param {string} words @param {string} key */
export const withKey = (words, key) => byHand(`${words} (${key})`, words);
