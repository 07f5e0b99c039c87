/**
 * Designs: beginning, opening, keeping and sharing them.
 *
 * @import {Action, ActionContext} from "./action.js"
 * @import {IconName} from "../elements/icons.js"
 */

/**
 * @param {string} id
 * @param {string} label
 * @param {string} key
 * @param {IconName} icon
 * @param {(context: ActionContext) => void} perform
 * @returns {Action}
 */
const action = (id, label, key, icon, perform) => ({
  id,
  label,
  group: "Designs",
  keys: key ? [key] : [],
  icon,
  perform,
});

/** @type {Action[]} */
export const DESIGNS = [
  action("designs", "My designs …", "Mod+O", "folder", ({ open }) => open("designs")),
  action("gallery", "New design, examples …", "Shift+N", "gallery", ({ open }) => open("gallery")),
  action("garments", "Plan a garment …", "Mod+Shift+G", "yarn", ({ open }) => open("garments")),
  action("versions", "Versions …", "Mod+S", "pin", ({ open }) => open("versions")),
  action("compare", "Compare two pieces …", "Shift+C", "compare", ({ open }) => open("compare")),
  action("share", "Share …", "Mod+Shift+S", "share", ({ open }) => open("share")),
  action("duplicate", "Duplicate this design", "Mod+Shift+D", "copy", ({ studio, keeper }) => {
    const design = studio.toDocument();
    keeper.openNew({ ...design, name: `${design.name.slice(0, 190)} (copy)` });
    studio.tell("This is the copy; the original is among your designs.");
  }),
  action("yarns", "Own yarns …", "Shift+Y", "yarn", ({ open }) => open("yarns")),
  action("exports", "Export, all formats …", "Mod+E", "export", ({ open }) => open("exports")),
  action(
    "project-file",
    "Save as a project file",
    "Mod+Shift+E",
    "export",
    ({ studio }) => void import("../services/exporter.js").then(({ exportProject }) => exportProject(studio)),
  ),
  {
    ...action("account", "Your account …", "", "person", ({ open }) => open("account")),
    enabled: ({ user }) => user.value !== null,
  },
  action("tour", "Tour of the page", "", "tour", ({ open }) => open("tour")),
];
