/**
 * How the chart is seen, painted and pulled.
 *
 * @import {Symmetry} from "../design/ink.js"
 * @import {Studio} from "../state/studio.js"
 */

import { byId } from "../elements/dom.js";
import { REST } from "../state/studio.js";
import { actionsOf } from "./action.js";

/** @type {Symmetry[]} */
const SYMMETRIES = ["none", "across", "up", "both"];
export const SIZES = [1, 2, 3, 5, 8];
/** @type {import("../state/editing.js").Look[]} */
const LOOKS = ["both", "colours", "symbols", "loops"];

const action = actionsOf("View");
const test = actionsOf("Stretch test");
const enabled = (/** @type {Studio} */ studio) => studio.currentStretch() !== null;

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
    "Draw the stitches in another way: symbols, colours, loops",
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
    { id: /** @type {const} */ ("stitches"), label: "Stitches: lace, cables, slips, tucks", key: "C" },
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

export const STRETCH = [
  test("stretch", "Stretch the chart, or cancel", ["J"], { icon: "wale" }, () => byId("stretch-run").click()),
  test("play", "Play or pause the stretch", ["Shift+J"], { icon: "play", enabled }, () => byId("stretch-play").click()),
  test("save-stretch", "Save the stretch test as a table (CSV)", [], { icon: "export", enabled }, () =>
    byId("stretch-save").click(),
  ),
  test("step-back", "One step of the stretch back", [","], { enabled }, ({ studio }) => {
    studio.step.value = Math.max(REST, studio.step.value - 1);
  }),
  test("step-on", "One step of the stretch on", ["."], { enabled }, ({ studio }) => {
    const last = (studio.currentStretch()?.strain.length ?? 1) - 1;
    studio.step.value = Math.min(last, studio.step.value + 1);
  }),
];
