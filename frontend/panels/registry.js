/**
 * The panels that most visits do not open: each is loaded when it is opened for the first time. A module
 * exports `create`, which makes the panel once and returns the function that shows it.
 *
 * @import {ActionContext, PanelName} from "../actions/action.js"
 * @import {Studio} from "../state/studio.js"
 *
 * @typedef {{create: (studio: Studio, context: ActionContext) => () => void}} PanelModule
 */

/** @type {Record<PanelName, () => Promise<PanelModule>>} */
const PANELS = {
  account: () => import("./dialogs/account.js"),
  along: () => import("./along/along.js"),
  atlas: async () => ({ create: (await import("./inverse/inverse.js")).opening("atlas") }),
  fill: () => import("./inverse/filling.js"),
  find: async () => ({ create: (await import("./inverse/inverse.js")).opening("find") }),
  compare: () => import("./compare/compare.js"),
  conflict: () => import("./designs/conflict.js"),
  designs: () => import("./designs/list.js"),
  exports: () => import("./exports/exports.js"),
  gallery: () => import("./gallery/gallery.js"),
  garments: () => import("./garments/planner.js"),
  help: () => import("./dialogs/help.js"),
  import: () => import("./dialogs/import.js"),
  palette: () => import("./dialogs/palette.js"),
  regions: () => import("./parts/regions.js"),
  repeats: () => import("./parts/repeats.js"),
  resize: () => import("./dialogs/resize.js"),
  share: () => import("./designs/share.js"),
  stitches: () => import("./stitches/stitches.js"),
  tour: () => import("./tour.js"),
  versions: () => import("./designs/versions.js"),
  yarns: () => import("./dialogs/yarns.js"),
};

/** @param {Studio} studio @returns {(name: PanelName, context: ActionContext) => Promise<void>} opens a panel */
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
