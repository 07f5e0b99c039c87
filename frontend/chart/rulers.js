/**
 * Row numbers at the side where the row is begun, with the reading direction, and stitch numbers
 * counted from the right, as a knitter reads a right-side row.
 *
 * @import {Grid} from "../grid/grid.js"
 * @import {Viewport} from "./viewport.js"
 * @import {Palette} from "../state/palette.js"
 */

import { MARGIN } from "./viewport.js";

const FONT = "13px system-ui, sans-serif";

/**
 * @param {CanvasRenderingContext2D} context
 * @param {Viewport} view
 * @param {Grid} grid
 * @param {Palette} palette
 * @param {boolean} round knitted in the round: every row is a right-side row
 * @param {import("../design/balance.js").Imbalance[]} [unbalanced] rows whose number is marked
 */
export function drawRulers(context, view, grid, palette, round, unbalanced = []) {
  context.font = FONT;
  context.fillStyle = palette.muted;
  context.textBaseline = "middle";
  const top = MARGIN.top - 2;
  const bottom = view.height - MARGIN.bottom + 2;
  const left = Math.max(MARGIN.left, view.x) - 8;
  const right = Math.min(view.width - MARGIN.right, view.x + grid.columns * view.cellWidth) + 8;

  const over = new Map(unbalanced.map((each) => [each.row + 1, each.over]));
  const every = [1, 5, 10, 25, 50].find((n) => n * 2 * view.cellHeight >= 17) ?? 100; // of the rows of a side
  /** Whether a mark is in a number's place. @param {number} number @param {boolean} wrong */
  const hidden = (number, wrong) =>
    unbalanced.some(
      ({ row }) => (!round && row % 2 === 1) !== wrong && Math.abs(row + 1 - number) * view.cellHeight < 16,
    );
  for (let number = 1; number <= grid.rows; number++) {
    const wrong = !round && number % 2 === 0;
    if (every > 1 && !over.has(number)) {
      if (round ? number !== 1 && number % every !== 0 : (number - (wrong ? 0 : 1)) % (2 * every) !== 0) continue;
    }
    const y = view.y + (grid.rows - number + 0.5) * view.cellHeight;
    if (y < top || y > bottom || (!over.has(number) && hidden(number, wrong))) continue;
    // From the back, the side where a row begins is the other one.
    const atLeft = wrong !== view.mirrored;
    context.textAlign = atLeft ? "right" : "left";
    const many = over.get(number);
    if (many) drawMark(context, palette, `${many > 0 ? "+" : "−"}${Math.abs(many)}`, atLeft ? right : left, y, !atLeft);
    context.fillStyle = many ? palette.danger : palette.muted;
    context.fillText(atLeft ? `${number} →` : `← ${number}`, atLeft ? left : right, y);
  }

  context.fillStyle = palette.muted;
  const base = Math.min(view.height - MARGIN.bottom, view.y + grid.rows * view.cellHeight) + 15;
  const step = columnStep(view.cellWidth);
  context.textAlign = "center";
  for (let number = 1; number <= grid.columns; number++) {
    if (number !== 1 && number % step !== 0) continue;
    const at = view.mirrored ? number - 0.5 : grid.columns - number + 0.5;
    const x = view.x + at * view.cellWidth;
    if (x < MARGIN.left - 4 || x > view.width - MARGIN.right + 4) continue;
    const half = context.measureText(String(number)).width / 2;
    if (x - half < left + 2 || x + half > right - 2) continue; // the names of the sides are there
    context.fillText(String(number), x, base);
  }
  const [start, end] = view.mirrored ? ["RS", "WS"] : ["WS", "RS"];
  context.textAlign = "right";
  if (!round || start === "RS") context.fillText(start, left, base);
  context.textAlign = "left";
  if (!round || end === "RS") context.fillText(end, right, base);
}

/** @param {number} width */
function columnStep(width) {
  if (width >= 22) return 1;
  return [5, 10, 20, 50].find((n) => n * width >= 36) ?? 100;
}

/**
 * By how many stitches a row does not balance, on the side where its number is not.
 *
 * @param {CanvasRenderingContext2D} context
 * @param {Palette} palette
 * @param {string} text
 * @param {number} x its end nearer to the chart
 * @param {number} y
 * @param {boolean} atLeft
 */
function drawMark(context, palette, text, x, y, atLeft) {
  const { textAlign } = context;
  const wide = context.measureText(text).width + 10;
  const from = atLeft ? x - wide : x;
  context.fillStyle = palette.danger;
  context.beginPath();
  context.roundRect(from, y - 8, wide, 16, 8);
  context.fill();
  context.textAlign = "center";
  context.fillStyle = palette.pane;
  context.fillText(text, from + wide / 2, y + 0.5);
  context.textAlign = textAlign;
}
