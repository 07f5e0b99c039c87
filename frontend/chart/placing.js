/**
 * Boxes of the chart that belong together: where a dragged repeat comes to lie, and what is under the
 * pointer.
 *
 * @import {ChartDocument} from "../design/document.js"
 * @import {Box, Grid} from "../grid/grid.js"
 * @import {Cell} from "../grid/raster.js"
 * @import {Repeat} from "../design/repeats.js"
 * @import {Selection} from "../design/selection.js"
 * @import {Gesture} from "../tools/tool.js"
 *
 * @typedef {{repeat: Repeat, at: number, box: Box}} Placed a copy of a repeat: its number and place
 */

import { selectionOf } from "../design/selection.js";

/**
 * The box of whole motifs nearest to the one dragged out.
 *
 * @param {Repeat | null} repeat
 * @param {Grid} grid
 * @param {Cell} start
 * @param {Cell} current
 * @returns {Box | null} null if not even one motif fits
 */
export function placedBox(repeat, grid, start, current) {
  if (!repeat) return null;
  const { motif, edgeRows, edgeColumns } = repeat;
  const snapped = repeat.snapped(Math.abs(current[0] - start[0]) + 1, Math.abs(current[1] - start[1]) + 1);
  /** @param {number} from @param {number} to @param {number} size @param {number} n @param {number} m @param {number} limit */
  const along = (from, to, size, n, m, limit) => {
    const most = to >= from ? limit - from : from + 1;
    const fits = size <= most ? size : Math.floor((most - m) / n) * n + m;
    if (fits < n + m) return null;
    return to >= from ? [from, from + fits] : [from + 1 - fits, from + 1];
  };
  const rows = along(start[0], current[0], snapped.rows, motif.rows, edgeRows, grid.rows);
  const columns = along(start[1], current[1], snapped.columns, motif.columns, edgeColumns, grid.columns);
  if (!rows || !columns) return null;
  return { row0: rows[0], row1: rows[1], column0: columns[0], column1: columns[1] };
}

/**
 * The largest box of whole motifs within another, at its lower left.
 *
 * @param {Repeat} repeat
 * @param {Box} box
 * @returns {Box | null}
 */
export function filledBox({ motif, edgeRows, edgeColumns }, { row0, column0, row1, column1 }) {
  const rows = Math.floor((row1 - row0 - edgeRows) / motif.rows) * motif.rows + edgeRows;
  const columns = Math.floor((column1 - column0 - edgeColumns) / motif.columns) * motif.columns + edgeColumns;
  if (rows < motif.rows + edgeRows || columns < motif.columns + edgeColumns) return null;
  return { row0, column0, row1: row0 + rows, column1: column0 + columns };
}

/** @param {import("../design/design.js").PlacementItem} place @returns {Box} */
export function boxOf({ row, column, rows, columns }) {
  return { row0: row, column0: column, row1: row + rows, column1: column + columns };
}

/**
 * The uppermost copy of a repeat that a test holds for.
 *
 * @param {ChartDocument} chart
 * @param {(box: Box) => boolean} test
 * @returns {Placed | null}
 */
function findPlaced(chart, test) {
  for (const repeat of chart.repeats.toReversed()) {
    const at = repeat.placements.findLastIndex((place) => test(boxOf(place)));
    if (at >= 0) return { repeat, at, box: boxOf(repeat.placements[at]) };
  }
  return null;
}

/** The copy of a repeat that is just what is selected. @param {ChartDocument} chart @param {Selection} selection */
export function placedAt(chart, { row0, column0, row1, column1, mask }) {
  if (mask) return null;
  return findPlaced(
    chart,
    (box) => box.row0 === row0 && box.column0 === column0 && box.row1 === row1 && box.column1 === column1,
  );
}

/**
 * The copy of a repeat or the region that a stitch belongs to.
 *
 * @param {ChartDocument} chart
 * @param {Cell} cell
 * @returns {Selection | null}
 */
export function boxAt(chart, [row, column]) {
  const placed = findPlaced(
    chart,
    ({ row0, column0, row1, column1 }) => row >= row0 && row < row1 && column >= column0 && column < column1,
  );
  if (placed) return placed.box;
  if (!chart.grid.has(row, column)) return null;
  const region = chart.regionAt(chart.grid.index(row, column));
  return region && selectionOf(region.cells, chart.grid);
}

/**
 * A box as far as it was dragged, kept within the chart.
 *
 * @param {Box} box
 * @param {Gesture} gesture
 * @param {Grid} grid
 * @returns {Box}
 */
export function shifted({ row0, column0, row1, column1 }, { start, current }, grid) {
  const up = Math.min(grid.rows - row1, Math.max(-row0, current[0] - start[0]));
  const across = Math.min(grid.columns - column1, Math.max(-column0, current[1] - start[1]));
  return { row0: row0 + up, row1: row1 + up, column0: column0 + across, column1: column1 + across };
}
