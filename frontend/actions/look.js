/**
 * How the chart is seen and painted.
 *
 * @import {Action} from "./action.js"
 * @import {Symmetry} from "../design/ink.js"
 */

/** @type {Symmetry[]} */
const SYMMETRIES = ["none", "across", "up", "both"];
export const SIZES = [1, 2, 3, 5, 8];
/** @type {import("../state/editing.js").Look[]} */
const LOOKS = ["both", "colours", "symbols", "loops"];

/**
 * @param {string} id
 * @param {string} label
 * @param {string[]} keys
 * @param {Action["perform"]} perform
 * @param {Partial<Action>} [more]
 * @returns {Action}
 */
const action = (id, label, keys, perform, more = {}) => ({
  id,
  label,
  group: "View",
  keys,
  perform,
  ...more,
});

/** @type {Action[]} */
export const LOOK = [
  action("fit", "Show the whole chart", ["0"], ({ view }) => view.fit(), { icon: "fit" }),
  action("zoom-in", "Zoom in", ["+", "="], ({ view }) => view.zoom(1.25), { icon: "plus" }),
  action("zoom-out", "Zoom out", ["-"], ({ view }) => view.zoom(0.8), { icon: "minus" }),
  action(
    "symmetry",
    "Symmetry: off, left–right, top–bottom, both",
    ["Y"],
    ({ studio }) => {
      const next = (SYMMETRIES.indexOf(studio.symmetry.value) + 1) % SYMMETRIES.length;
      studio.symmetry.value = SYMMETRIES[next];
    },
    { icon: "mirror" },
  ),
  action("size-down", "Smaller brush", ["["], ({ studio }) => {
    studio.size.value = SIZES[Math.max(0, SIZES.indexOf(studio.size.value) - 1)];
  }),
  action("size-up", "Larger brush", ["]"], ({ studio }) => {
    studio.size.value = SIZES[Math.min(SIZES.length - 1, SIZES.indexOf(studio.size.value) + 1)];
  }),
  action(
    "symbols",
    "Look: colours and symbols, colours, symbols, loops",
    ["V"],
    ({ studio: { editing } }) => {
      editing.look.value = LOOKS[(LOOKS.indexOf(editing.look.value) + 1) % LOOKS.length];
    },
    { icon: "symbols" },
  ),
  action("rectangles", "Extensibility rectangles", ["E"], ({ studio }) => {
    studio.rectangles.value = !studio.rectangles.value;
  }),
  action(
    "face",
    "Face or back of the cloth",
    ["K"],
    ({ studio: { editing } }) => {
      editing.back.value = !editing.back.value;
    },
    { icon: "turn" },
  ),
  action("round", "Knitted flat or in the round", ["Shift+R"], ({ studio: { editing } }) => {
    editing.round.value = !editing.round.value;
  }),
  ...[
    { id: /** @type {const} */ ("regions"), label: "Regions", key: "Shift+A" },
    { id: /** @type {const} */ ("repeats"), label: "Linked repeats", key: "Shift+L" },
  ].map(({ id, label, key }) =>
    action(id, label, [key], ({ studio: { editing }, open }) => {
      if (editing.panel.value === id) editing.panel.value = null;
      else open(id);
    }),
  ),
  action("theme", "Light or dark", ["D"], ({ toggleTheme }) => toggleTheme(), { icon: "theme" }),
  action("resize", "Size and new chart …", ["N"], ({ open }) => open("resize"), {
    group: "Edit",
    icon: "resize",
  }),
  action("import", "Import a chart …", ["I"], ({ open }) => open("import"), {
    group: "Edit",
    icon: "import",
  }),
  action("palette", "Find a command …", ["Mod+K", "/"], ({ open }) => open("palette")),
  action("help", "Keys and tools", ["?"], ({ open }) => open("help"), { icon: "help" }),
];
