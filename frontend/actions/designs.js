/** Designs: beginning, opening, keeping and sharing them; and from a target to a fabric. */

import { DESIGN_NAME, shortName } from "../core/names.js";
import { actionsOf } from "./action.js";

const action = actionsOf("Designs");
const target = actionsOf("From a target to a fabric");

export const DESIGNS = [
  action("designs", "My designs …", ["Mod+O"], { icon: "folder" }, ({ open }) => open("designs")),
  action("gallery", "New design, examples …", ["Shift+N"], { icon: "gallery" }, ({ open }) => open("gallery")),
  action("garments", "Plan a garment …", ["Mod+Shift+G"], { icon: "yarn" }, ({ open }) => open("garments")),
  action("versions", "Versions …", ["Mod+S"], { icon: "pin" }, ({ open }) => open("versions")),
  action("compare", "Compare two pieces …", ["Shift+C"], { icon: "compare" }, ({ open }) => open("compare")),
  action("share", "Share …", ["Mod+Shift+S"], { icon: "share" }, ({ open }) => open("share")),
  action("duplicate", "Duplicate this design", ["Mod+Shift+D"], { icon: "copy" }, ({ studio, keeper }) => {
    const design = studio.toDocument();
    keeper.openNew({ ...design, name: shortName(design.name, DESIGN_NAME, " (copy)") });
    studio.tell("This is the copy; the original is among your designs.");
  }),
  action("yarns", "Own yarns …", ["Shift+Y"], { icon: "yarn" }, ({ open }) => open("yarns")),
  action("exports", "Export, all formats …", ["Mod+E"], { icon: "export" }, ({ open }) => open("exports")),
  action("knit-along", "Knit along, row by row …", ["Shift+K"], { icon: "rows" }, ({ open }) => open("along")),
  action(
    "project-file",
    "Save as a project file",
    ["Mod+Shift+E"],
    { icon: "export" },
    ({ studio }) => void import("../services/exporter.js").then(({ exportProject }) => exportProject(studio)),
  ),
  action("account", "Your account …", [], { icon: "person", enabled: ({ user }) => user.value !== null }, ({ open }) =>
    open("account"),
  ),
  action("tour", "Tour of the page", [], { icon: "tour" }, ({ open }) => open("tour")),
];

export const INVERSE = [
  target("open-atlas", "Atlas of all repeats", ["A"], { icon: "scatter" }, ({ open }) => open("atlas")),
  target("open-find", "Find a fabric by its numbers", ["Shift+F"], { icon: "search" }, ({ open }) => open("find")),
  target("open-fill", "Fill the chart from a target", ["Shift+W"], { icon: "target" }, ({ open }) => open("fill")),
];
