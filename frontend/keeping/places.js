/**
 * Where people are in a design that several windows show.
 *
 * @import {Box} from "../core/grid.js"
 * @import {ChartView} from "../chart/view.js"
 * @import {Studio} from "../studio.js"
 * @import {Windows} from "./windows.js"
 */

import { paced } from "../core/paced.js";

/** Often enough to follow with the eye. */
const TELL_MS = 60;

/**
 * Tell the other windows of our pointer and selection, and show theirs.
 *
 * @param {ChartView} view
 * @param {Studio} studio
 * @param {Windows} windows
 */
export function sharePlaces(view, studio, windows) {
  const tell = paced(() => {
    const selection = studio.selection.value;
    windows.at({ cell: view.hover.value, box: selection && boxOf(selection) });
  }, TELL_MS);
  view.hover.listen(tell);
  studio.selection.listen(tell);
  windows.places.watch((places) => (view.others.value = places));
}

/** Without the mask, which may be large. @param {Box} box @returns {Box} */
const boxOf = ({ row0, column0, row1, column1 }) => ({ row0, column0, row1, column1 });
