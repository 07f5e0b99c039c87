/**
 * Changes of the selection, or of the whole chart if nothing is selected.
 *
 * @import {Action} from "./action.js"
 * @import {IconName} from "../icons.js"
 * @import {Studio} from "../studio.js"
 */

import { Grid } from "../core/grid.js";

/**
 * @param {Studio} studio
 * @param {string} label
 * @param {(part: Grid) => Grid} change keeps the size
 */
export function changePart({ document, selection }, label, change) {
  const { grid } = document;
  const box = selection.value ?? grid.box;
  const part = change(grid.region(box));
  const next = Grid.build(grid.rows, grid.columns, (row, column) => {
    const inside =
      row >= box.row0 && row < box.row1 && column >= box.column0 && column < box.column1;
    return inside
      ? part.purl[part.index(row - box.row0, column - box.column0)]
      : grid.purl[grid.index(row, column)];
  });
  document.replace(next, label);
}

/**
 * @param {string} id
 * @param {string} label
 * @param {IconName} icon
 * @param {string} key
 * @param {(part: Grid) => Grid} change
 * @returns {Action}
 */
function transform(id, label, icon, key, change) {
  return {
    id,
    label,
    group: "Change (selection or chart)",
    icon,
    keys: [key],
    perform: ({ studio }) => changePart(studio, label, change),
  };
}

export const mirror = transform("mirror", "Mirror left and right", "mirror", "Shift+H", (part) =>
  part.mirrored(),
);
export const flip = transform("flip", "Mirror top and bottom", "flip", "Shift+V", (part) =>
  part.flipped(),
);
export const swap = transform("swap", "Swap knit and purl", "swap", "X", (part) => part.swapped());
export const turnOver = transform("turn-over", "Turn over (see the back)", "turn", "T", (part) =>
  part.turnedOver(),
);

/** @type {Action} */
export const fillPart = {
  id: "fill-part",
  label: "Fill with the pattern",
  group: "Change (selection or chart)",
  icon: "fill",
  keys: ["F"],
  enabled: ({ ink }) => ink.value.repeat !== null,
  perform: ({ studio }) => {
    const repeat = studio.ink.value.repeat;
    if (!repeat) {
      studio.tell("Choose a pattern, Knit or Purl below the chart first.");
      return;
    }
    changePart(studio, "Fill", ({ rows, columns }) => repeat.tiled(rows, columns));
  },
};
