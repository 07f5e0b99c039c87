/**
 * How the chart is seen and painted.
 *
 * @import {Symmetry} from "../design/ink.js"
 */

import { actionsOf } from "./action.js";

/** @type {Symmetry[]} */
const SYMMETRIES = ["none", "across", "up", "both"];
export const SIZES = [1, 2, 3, 5, 8];
/** @type {import("../state/editing.js").Look[]} */
const LOOKS = ["both", "colours", "symbols", "loops"];

const action = actionsOf("View");

export const LOOK = [
  action("fit", "Show the whole chart", ["0"], { icon: "fit" }, ({ view }) => view.fit()),
  action("zoom-in", "Zoom in", ["+", "="], { icon: "plus" }, ({ view }) => view.zoom(1.25)),
  action("zoom-out", "Zoom out", ["-"], { icon: "minus" }, ({ view }) => view.zoom(0.8)),
  action("symmetry", "Symmetry: off, left–right, top–bottom, both", ["Y"], { icon: "mirror" }, ({ studio }) => {
    studio.symmetry.value = SYMMETRIES[(SYMMETRIES.indexOf(studio.symmetry.value) + 1) % SYMMETRIES.length];
  }),
  action("size-down", "Smaller brush", ["["], {}, ({ studio }) => {
    studio.size.value = SIZES[Math.max(0, SIZES.indexOf(studio.size.value) - 1)];
  }),
  action("size-up", "Larger brush", ["]"], {}, ({ studio }) => {
    studio.size.value = SIZES[Math.min(SIZES.length - 1, SIZES.indexOf(studio.size.value) + 1)];
  }),
  action(
    "symbols",
    "Look: colours and symbols, colours, symbols, loops",
    ["V"],
    { icon: "symbols" },
    ({ studio: { editing } }) => {
      editing.look.value = LOOKS[(LOOKS.indexOf(editing.look.value) + 1) % LOOKS.length];
    },
  ),
  action("rectangles", "Extensibility rectangles", ["E"], {}, ({ studio }) => {
    studio.rectangles.value = !studio.rectangles.value;
  }),
  action("face", "Face or back of the cloth", ["K"], { icon: "turn" }, ({ studio: { editing } }) => {
    editing.back.value = !editing.back.value;
  }),
  action("round", "Knitted flat or in the round", ["Shift+R"], {}, ({ studio: { editing } }) => {
    editing.round.value = !editing.round.value;
  }),
  ...[
    { id: /** @type {const} */ ("regions"), label: "Regions", key: "Shift+A" },
    { id: /** @type {const} */ ("repeats"), label: "Linked repeats", key: "Shift+L" },
  ].map(({ id, label, key }) =>
    action(id, label, [key], {}, ({ studio: { editing }, open }) => {
      if (editing.panel.value === id) editing.panel.value = null;
      else open(id);
    }),
  ),
  action("theme", "Light or dark", ["D"], { icon: "theme" }, ({ toggleTheme }) => toggleTheme()),
  action("resize", "Size and new chart …", ["N"], { group: "Edit", icon: "resize" }, ({ open }) => open("resize")),
  action("import", "Import a chart …", ["I"], { group: "Edit", icon: "import" }, ({ open }) => open("import")),
  action("palette", "Find a command …", ["Mod+K", "/"], {}, ({ open }) => open("palette")),
  action("help", "Keys and tools", ["?"], { icon: "help" }, ({ open }) => open("help")),
];
