/**
 * The panels that most visits do not open: each is loaded when it is opened for the first time. A module
 * exports `create`, which makes the panel once and returns the function that shows it.
 *
 * @import {ActionContext} from "../actions/action.js"
 * @import {Studio} from "../studio.js"
 *
 * @typedef {{create: (studio: Studio, context: ActionContext) => () => void}} PanelModule
 * @typedef {keyof typeof PANELS} PanelName
 */

const PANELS = {
  /** @returns {Promise<PanelModule>} */
  account: () => import("./dialogs/account.js"),
  /** @returns {Promise<PanelModule>} */
  atlas: async () => ({ create: (await import("./inverse/inverse.js")).opening("atlas") }),
  /** @returns {Promise<PanelModule>} */
  fill: async () => ({ create: (await import("./inverse/inverse.js")).opening("fill") }),
  /** @returns {Promise<PanelModule>} */
  find: async () => ({ create: (await import("./inverse/inverse.js")).opening("find") }),
  /** @returns {Promise<PanelModule>} */
  compare: () => import("./compare/compare.js"),
  /** @returns {Promise<PanelModule>} */
  conflict: () => import("./designs/conflict.js"),
  /** @returns {Promise<PanelModule>} */
  designs: () => import("./designs/list.js"),
  /** @returns {Promise<PanelModule>} */
  exports: () => import("./exports/exports.js"),
  /** @returns {Promise<PanelModule>} */
  gallery: () => import("./gallery/gallery.js"),
  /** @returns {Promise<PanelModule>} */
  garments: () => import("./garments/planner.js"),
  /** @returns {Promise<PanelModule>} */
  help: () => import("./dialogs/help.js"),
  /** @returns {Promise<PanelModule>} */
  import: () => import("./dialogs/import.js"),
  /** @returns {Promise<PanelModule>} */
  palette: () => import("./dialogs/palette.js"),
  /** @returns {Promise<PanelModule>} */
  regions: () => import("./regions.js"),
  /** @returns {Promise<PanelModule>} */
  repeats: () => import("./repeats.js"),
  /** @returns {Promise<PanelModule>} */
  resize: () => import("./dialogs/resize.js"),
  /** @returns {Promise<PanelModule>} */
  share: () => import("./designs/share.js"),
  /** @returns {Promise<PanelModule>} */
  tour: () => import("./tour.js"),
  /** @returns {Promise<PanelModule>} */
  versions: () => import("./designs/versions.js"),
  /** @returns {Promise<PanelModule>} */
  yarns: () => import("./dialogs/yarns.js"),
};

/**
 * @param {Studio} studio
 * @returns {(name: PanelName, context: ActionContext) => Promise<void>} opens a panel
 */
export function panelOpener(studio) {
  /** @type {Map<PanelName, () => void>} */
  const made = new Map();
  return async (name, context) => {
    let show = made.get(name);
    if (!show) {
      try {
        show = (await PANELS[name]()).create(studio, context);
      } catch (error) {
        if (!(error instanceof TypeError)) throw error; // import() throws it when a module cannot be loaded
        studio.tellProblem({
          type: "offline",
          status: 0,
          title: "This panel could not be loaded",
          detail: "The service cannot be reached, or it has been updated since the page was opened.",
          remedy: "Your design is safe. Try again in a moment, or reload the page.",
        });
        return;
      }
      made.set(name, show);
    }
    show();
  };
}
