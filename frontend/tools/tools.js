/**
 * The tools; toolbar, shortcuts, palette and help read `TOOLS` too.
 *
 * @import {Cell} from "../grid/raster.js"
 * @import {Tool, ToolContext} from "./tool.js"
 */

import { besides, byHand } from "../core/pointing.js";
import { ellipse, enclosed, flood, line, rectangle, thick } from "../grid/raster.js";

/** @type {Tool} */
export const pencil = {
  id: "pencil",
  label: "Pencil",
  icon: "pencil",
  key: "B",
  hint: "Draw freely; [ and ] change its size",
  mode: "stroke",
  sized: true,
  spans: ({ previous, current }, { size }) => thick(line(previous, current), size),
};

/** @type {Tool} */
export const stamp = {
  id: "stamp",
  label: "Stamp",
  icon: "stamp",
  key: "S",
  hint: "Put down one repeat of the pattern, its lower left corner here",
  mode: "shape",
  spans: ({ current: [row, column] }, { ink }) => {
    const { rows, columns } = ink.repeat ?? { rows: 1, columns: 1 };
    return rectangle([row, column], [row + rows - 1, column + columns - 1]);
  },
  origin: ({ current }) => current,
};

/** @type {Tool} */
export const placeRepeat = {
  id: "repeat",
  label: "Place a repeat",
  icon: "repeat",
  key: "P",
  hint: "Drag out copies of a linked repeat, in whole motifs; edit one copy and all follow",
  mode: "place",
  spans: () => [],
};

/** @type {Tool} */
export const move = {
  id: "move",
  label: "Move",
  icon: "move",
  key: "Shift+M",
  hint: byHand(
    "Drag the selected stitches elsewhere, or push them with the arrow keys; Alt leaves a copy behind",
    "Drag the selected stitches elsewhere",
  ),
  mode: "move",
  spans: () => [],
};

/**
 * All tools, in the order of the toolbar.
 *
 * @type {Tool[]}
 */
export const TOOLS = [
  pencil,
  {
    id: "line",
    label: "Line",
    icon: "line",
    key: "L",
    hint: besides("Drag a straight line", "Shift keeps it level, upright or diagonal"),
    mode: "shape",
    sized: true,
    spans: ({ start, current, constrain }, { size }) =>
      thick(line(start, constrain ? constrained(start, current) : current), size),
  },
  {
    id: "rectangle",
    label: "Rectangle",
    icon: "rectangle",
    key: "R",
    hint: "Drag a filled rectangle; paint a panel with a pattern",
    mode: "shape",
    spans: ({ start, current }) => rectangle(start, current),
  },
  {
    id: "ellipse",
    label: "Ellipse",
    icon: "ellipse",
    key: "O",
    hint: "Drag a filled ellipse",
    mode: "shape",
    spans: ({ start, current }) => ellipse(start, current),
  },
  {
    id: "fill",
    label: "Fill",
    icon: "fill",
    key: "G",
    hint: besides("Fill connected like stitches", "with Shift, a connected area of one fabric"),
    mode: "once",
    spans: ({ start, constrain }, context) => flood(context.grid, looks(context, constrain), start),
  },
  stamp,
  placeRepeat,
  {
    id: "select",
    label: "Select",
    icon: "select",
    key: "M",
    hint: besides("Drag a box around stitches to see their numbers or change them", "Shift adds, Alt takes away"),
    mode: "select",
    // A click alone selects nothing.
    spans: ({ start, current, path }) => (path.length > 1 ? rectangle(start, current) : []),
  },
  {
    id: "lasso",
    label: "Lasso",
    icon: "lasso",
    key: "Q",
    hint: besides("Draw around stitches to select them", "Shift adds, Alt takes away, both intersect"),
    mode: "select",
    spans: ({ path }) => (path.length > 2 ? enclosed(path) : []),
  },
  {
    id: "wand",
    label: "Wand",
    icon: "wand",
    key: "W",
    hint: besides("Select a connected area of one fabric", "Shift adds, Alt takes away, both intersect"),
    mode: "select",
    spans: ({ current: [row, column] }, context) =>
      context.grid.has(row, column) ? flood(context.grid, looks(context, true), [row, column]) : [],
  },
  move,
  {
    id: "pan",
    label: "Move view",
    icon: "hand",
    key: "H",
    hint: besides("Drag the chart about", "Space does it with any tool, the wheel zooms"),
    mode: "pan",
    spans: () => [],
  },
];

/**
 * @param {Cell} start
 * @param {Cell} current
 * @returns {Cell} the nearest one level with the start, above or below it, or on a diagonal
 */
function constrained(start, current) {
  const up = current[0] - start[0];
  const across = current[1] - start[1];
  if (Math.abs(up) > 2 * Math.abs(across)) return [current[0], start[1]];
  if (Math.abs(across) > 2 * Math.abs(up)) return [start[0], current[1]];
  const length = Math.max(Math.abs(up), Math.abs(across));
  return [start[0] + Math.sign(up) * length, start[1] + Math.sign(across) * length];
}

/** What stitches look like that are neither knit nor purl. */
const OTHER = 254;

/**
 * What distinguishes stitches: knit or purl or, by fabric, their surroundings; or that there is none.
 *
 * @param {ToolContext} context
 * @param {boolean} byFabric
 */
function looks({ grid, codes, outline, others }, byFabric) {
  let values = byFabric ? codes : grid.purl;
  if (others?.size) values = values.map((value, i) => (others.start(i) === undefined ? value : OTHER));
  return outline.includes(0) ? values.map((value, i) => (outline[i] ? value : 255)) : values;
}
