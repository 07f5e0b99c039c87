/**
 * Changes of the selection or, if nothing is selected, of the whole chart with all its parts; and its
 * rows and columns.
 *
 * @import {ActionContext} from "./action.js"
 * @import {IconName} from "../elements/icons.js"
 */

import { actionsOf } from "./action.js";
import { changed, changedStitches } from "../design/floating.js";
import { inked } from "../design/ink.js";
import { MAX_SIDE } from "../grid/grid.js";
import { deleted, inserted, turned } from "../design/reshape.js";
import { selectedCells } from "../design/selection.js";

const change = actionsOf("Change (selection or chart)");
const line = actionsOf("Rows and columns");

/**
 * @param {string} id
 * @param {string} label
 * @param {IconName} icon
 * @param {string} key
 * @param {"mirrored" | "flipped" | "rotated" | "turnedOver" | "swapped"} how
 */
const transform = (id, label, icon, key, how) =>
  change(id, label, [key], { icon }, ({ studio: { document, selection } }) => {
    const { grid } = document;
    if (!selection.value) {
      document.reshape(label, turned(grid, how));
      return;
    }
    const shape = how === "turnedOver" ? "mirrored" : how;
    const cells = changed(
      grid,
      selection.value,
      (part) => part[how](),
      (mask) => (shape === "swapped" ? mask : mask[shape]()),
    );
    document.set(cells, label, "stitches", changedStitches(document, selection.value, how));
  });

const fillPart = change(
  "fill-part",
  "Fill with the chosen stitch or pattern",
  ["F"],
  { icon: "fill", enabled: ({ ink }) => ink.value.repeat !== null },
  ({ studio: { document, ink, selection } }) => {
    const { grid } = document;
    const cells = selectedCells(selection.value ?? grid.box, grid);
    const { columns } = grid;
    /** @type {import("../grid/raster.js").Span[]} */
    const spans = cells.map((i) => [Math.floor(i / columns), i % columns, (i % columns) + 1]);
    document.begin(ink.value.target);
    const [brush, put] = inked(grid, spans, ink.value, [0, 0], "none");
    document.paint(brush, false, put);
    document.commit("Fill");
  },
);

/**
 * Rows or columns that are meant: those selected, or the one under the pointer.
 *
 * @param {ActionContext} context
 * @param {"rows" | "columns"} axis
 * @returns {[from: number, to: number]}
 */
function meant({ studio: { document, selection }, view }, axis) {
  const box = selection.value;
  if (box) return axis === "rows" ? [box.row0, box.row1] : [box.column0, box.column1];
  const cell = view.hover.value ?? [document.grid.rows - 1, 0];
  const at = axis === "rows" ? cell[0] : cell[1];
  return [at, at + 1];
}

/**
 * @param {string} id
 * @param {string} label
 * @param {string[]} keys
 * @param {"rows" | "columns"} axis
 * @param {"before" | "after"} side before: below, or at the left
 */
const insertion = (id, label, keys, axis, side) =>
  line(id, label, keys, { icon: axis === "rows" ? "insert-row" : "insert-column" }, (context) => {
    const { document, selection, tell } = context.studio;
    const { grid } = document;
    const [from, to] = meant(context, axis);
    if (grid[axis] + to - from > MAX_SIDE) {
      tell.call(context.studio, `A chart has at most ${MAX_SIDE} ${axis}.`);
      return;
    }
    const box = selection.value;
    document.reshape(
      label,
      inserted(grid, axis, side === "before" ? from : to, to - from, side === "before" ? "after" : "before"),
    );
    if (!box) return;
    // What was selected stays selected.
    const by = side === "before" ? to - from : 0;
    const [rows, columns] = axis === "rows" ? [by, 0] : [0, by];
    selection.value = {
      ...box,
      row0: box.row0 + rows,
      row1: box.row1 + rows,
      column0: box.column0 + columns,
      column1: box.column1 + columns,
    };
  });

/** @param {"rows" | "columns"} axis @param {string[]} keys */
const deletion = (axis, keys) =>
  line(
    `delete-${axis}`,
    `Delete ${axis}`,
    keys,
    { icon: axis === "rows" ? "delete-row" : "delete-column" },
    (context) => {
      const { studio } = context;
      const { grid } = studio.document;
      const [from, to] = meant(context, axis);
      if (to - from >= grid[axis]) studio.tell(`A chart keeps at least one of its ${axis}.`);
      else studio.document.reshape(`Delete ${axis}`, deleted(grid, axis, from, to));
    },
  );

export const TRANSFORM = [
  fillPart,
  transform("mirror", "Mirror left and right", "mirror", "Shift+H", "mirrored"),
  transform("flip", "Mirror top and bottom", "flip", "Shift+V", "flipped"),
  transform("rotate", "Rotate by half a turn", "rotate", "Shift+T", "rotated"),
  transform("swap", "Swap knit and purl", "swap", "X", "swapped"),
  transform("turn-over", "Turn over", "turn", "T", "turnedOver"),
  insertion("insert-row-above", "Insert rows above", ["Shift+I"], "rows", "after"),
  insertion("insert-row-below", "Insert rows below", [], "rows", "before"),
  insertion("insert-column-left", "Insert columns at the left", [], "columns", "before"),
  insertion("insert-column-right", "Insert columns at the right", ["Shift+O"], "columns", "after"),
  deletion("rows", ["Shift+Delete"]),
  deletion("columns", ["Mod+Delete"]),
];
