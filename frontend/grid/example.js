/** The chart that a first visit opens with: a rib cuff, a stockinette body, a garter edge, a seed panel. */

import { Grid } from "./grid.js";

const COLUMNS = 30;
const ROWS = 24;

export function exampleGrid() {
  return Grid.build(ROWS, COLUMNS, (row, column) => {
    if (row < 6) return column % 2; // 1×1 rib
    if (row >= ROWS - 4) return row % 2; // garter
    const panel = column >= 9 && column < 21 && row >= 8 && row < 18;
    return panel ? (row + column) % 2 : 0; // seed in stockinette
  });
}
