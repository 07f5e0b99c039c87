/** Repeats as one line of text, the way a design document has them: "KP/PK", the top row first. */

import { Grid } from "./grid.js";

/** @param {string} motif */
export function motifGrid(motif) {
  return Grid.fromText(motif.replaceAll("/", "\n"));
}

/** @param {Grid} grid */
export function motifText(grid) {
  return grid.text.replaceAll("\n", "/");
}
