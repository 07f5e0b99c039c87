/**
 * A garment's chart in small: its outline, its regions in their colours, purls darker.
 *
 * @import {DesignFile} from "../../types.js"
 */

import { themedReader } from "../../state/palette.js";

const MAX_WIDTH = 520;
const MAX_HEIGHT = 330;

/**
 * @param {HTMLCanvasElement} canvas
 * @param {DesignFile} design
 * @param {number} aspect height over width of a stitch
 */
export function drawGarment(canvas, design, aspect) {
  const lines = design.chart.split("\n");
  const outline = design.outline?.split("\n") ?? null;
  const [rows, columns] = [lines.length, lines[0].length];
  const cell = Math.min(MAX_WIDTH / columns, MAX_HEIGHT / (rows * aspect));
  const ratio = devicePixelRatio;
  const [wide, high] = [cell * columns, cell * rows * aspect];
  canvas.width = Math.round(wide * ratio);
  canvas.height = Math.round(high * ratio);
  canvas.style.width = `${wide}px`;
  canvas.style.height = `${high}px`;
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  context.scale(ratio, ratio);
  const knit = themedReader()("--knit");
  const colours = lines.map((line) => Array.from(line, () => knit));
  for (const { runs, colour } of design.regions) {
    for (const [row, column, length] of runs) {
      colours[rows - 1 - row].fill(colour, column, column + length);
    }
  }
  for (let top = 0; top < rows; top++) {
    const y = top * cell * aspect;
    for (let column = 0; column < columns; column++) {
      if (outline?.[top][column] === ".") continue;
      context.globalAlpha = lines[top][column] === "P" ? 1 : 0.72;
      context.fillStyle = colours[top][column];
      // a little wider than the cell, so that no seam of the page's colour is left between cells
      context.fillRect(column * cell, y, cell + 0.3, cell * aspect + 0.3);
    }
  }
  context.globalAlpha = 1;
}
