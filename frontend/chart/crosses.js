/**
 * Strain crosses: how far the cloth is stretched along its rows and its columns at the step on show, in
 * each block of stitches. Arms are as long as the strain; those of cloth that narrows are drawn in red.
 *
 * @import {Box} from "../grid/grid.js"
 * @import {Studio} from "../state/studio.js"
 * @import {Viewport} from "./viewport.js"
 */

/** Smaller blocks cannot be read. */
const MIN_PX = 36;
/** A cross of the largest strain of a test, over its block. */
const ROOM = 0.92;
const STRETCHED = "rgb(24 18 14 / 0.9)";
const NARROWED = "rgb(196 30 20 / 0.95)";

/**
 * @param {CanvasRenderingContext2D} context
 * @param {Viewport} viewport
 * @param {Studio} studio
 * @param {Box} box stitches to draw
 */
export function drawCrosses(context, viewport, studio, box) {
  const fields = studio.currentStretch()?.stitch_fields;
  const strains = studio.strains();
  if (!fields || !strains) return;
  const { course, wale } = strains;
  const { grid, shaped, outline } = studio.document;
  const { cellWidth: w, cellHeight: h } = viewport;
  const size = sideOfCrossed(viewport);
  const longest = largestStrain(fields);
  const paths = { [STRETCHED]: new Path2D(), [NARROWED]: new Path2D() };
  for (let row0 = box.row0 - (box.row0 % size); row0 < box.row1; row0 += size) {
    for (let column0 = box.column0 - (box.column0 % size); column0 < box.column1; column0 += size) {
      const row1 = Math.min(row0 + size, grid.rows);
      const column1 = Math.min(column0 + size, grid.columns);
      let [count, along, across] = [0, 0, 0];
      for (let row = row0; row < row1; row++) {
        for (let column = column0; column < column1; column++) {
          const i = grid.index(row, column);
          if (shaped && !outline[i]) continue;
          count++;
          across += course[i];
          along += wale[i];
        }
      }
      if (!count) continue;
      const cx = viewport.x + (w * (column0 + column1)) / 2;
      const cy = viewport.y + h * (grid.rows - (row0 + row1) / 2);
      const arm = (ROOM * size * Math.min(w, h)) / 2 / longest / count;
      const wide = paths[across < 0 ? NARROWED : STRETCHED];
      wide.moveTo(cx - Math.abs(across) * arm, cy);
      wide.lineTo(cx + Math.abs(across) * arm, cy);
      const high = paths[along < 0 ? NARROWED : STRETCHED];
      high.moveTo(cx, cy - Math.abs(along) * arm);
      high.lineTo(cx, cy + Math.abs(along) * arm);
    }
  }
  context.lineCap = "round";
  for (const [colour, path] of Object.entries(paths)) {
    context.strokeStyle = "rgb(255 252 246 / 0.85)";
    context.lineWidth = 4.5;
    context.stroke(path);
    context.strokeStyle = colour;
    context.lineWidth = 2;
    context.stroke(path);
  }
}

/** Stitches on a side of the block of a cross. @param {Viewport} viewport */
export const sideOfCrossed = ({ cellWidth, cellHeight }) =>
  Math.max(1, Math.ceil(MIN_PX / Math.min(cellWidth, cellHeight)));

/** What a cross that fills its block stands for: the largest strain of a stitch in the test. @param {{strain_course: number[][], strain_wale: number[][]}} fields */
export function largestStrain({ strain_course, strain_wale }) {
  let most = 1e-6;
  for (const steps of [strain_course, strain_wale])
    for (const step of steps) for (const value of step) most = Math.max(most, Math.abs(value));
  return most;
}
