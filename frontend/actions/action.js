/**
 * What an action is. Shortcuts, the command palette and help read the registry.
 *
 * @import {ChartView} from "../chart/view.js"
 * @import {Keeper} from "../sync/keeper.js"
 * @import {Studio} from "../state/studio.js"
 * @import {IconName} from "../elements/icons.js"
 *
 * @typedef {"account" | "along" | "atlas" | "compare" | "conflict" | "designs" | "exports" | "fill" | "find" | "gallery"
 *   | "garments" | "help" | "import" | "palette" | "regions" | "repeats" | "resize" | "share" | "stitches" | "tour"
 *   | "versions" | "yarns"} PanelName that are loaded when they are opened
 * @typedef {{studio: Studio, view: ChartView, keeper: Keeper, open: (panel: PanelName) => void,
 *   toggleTheme: () => void}} ActionContext
 *
 * @typedef {object} Action
 * @property {string} id
 * @property {string} label
 * @property {string} group heading in help
 * @property {IconName} [icon]
 * @property {string[]} keys none, or such as "Mod+Z"; Mod is Ctrl, or ⌘ on a Mac
 * @property {boolean} [native] the browser hears its keys itself
 * @property {(studio: Studio) => boolean} [enabled]
 * @property {(context: ActionContext) => void} perform
 */

/**
 * What makes the actions of a group.
 *
 * @param {string} group
 * @returns {(id: string, label: string, keys: string[], more: Partial<Action>, perform: Action["perform"]) => Action}
 */
export const actionsOf = (group) => (id, label, keys, more, perform) => ({ id, label, group, keys, perform, ...more });
