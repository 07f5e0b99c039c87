/**
 * A chart as a small picture: every quarter of a stitch in the colour of its fabric, purls darker.
 *
 * @import {Palette} from "../state/palette.js"
 */

import { pixel, readPalette } from "../state/palette.js";
import { Grid } from "../grid/grid.js";
import { QUARTERS, surroundings } from "../grid/segments.js";
import { h } from "../elements/dom.js";

const PURL_SHADE = 0.78;
/** Stitches are wider than high. */
const ASPECT = 0.8;

/**
 * @param {{chart: string, outline?: string | null}} design
 * @param {{side?: number, label?: string}} [options] longest side in CSS pixels
 */
export function thumbnail({ chart, outline }, { side = 132, label = "" } = {}) {
  const grid = Grid.fromText(chart);
  const width = grid.columns;
  const height = grid.rows * ASPECT;
  const scale = side / Math.max(width, height);
  const canvas = h("canvas", {
    class: "thumb",
    width: Math.max(1, Math.round(2 * width * scale)),
    height: Math.max(1, Math.round(2 * height * scale)),
    role: label ? "img" : "presentation",
    "aria-label": label || undefined,
  });
  canvas.style.aspectRatio = `${width} / ${height}`;
  const draw = () => paint(canvas, grid, outline ?? null, readPalette());
  draw();
  return canvas;
}

/**
 * @param {HTMLCanvasElement} canvas
 * @param {Grid} grid
 * @param {string | null} outline
 * @param {Palette} palette
 */
function paint(canvas, grid, outline, palette) {
  const { rows, columns, purl } = grid;
  const codes = surroundings(grid);
  const colours = palette.fabrics.map((rgb) => [pixel(rgb), pixel(rgb, PURL_SHADE)]);
  const absent = outline?.split("\n");
  const image = new ImageData(2 * columns, 2 * rows);
  const pixels = new Uint32Array(image.data.buffer);
  for (let row = 0; row < rows; row++) {
    for (let column = 0; column < columns; column++) {
      if (absent?.[rows - 1 - row]?.[column] === ".") continue;
      const i = grid.index(row, column);
      QUARTERS[codes[i]].forEach((phase, quarter) => {
        const y = 2 * (rows - 1 - row) + (quarter < 2 ? 1 : 0);
        pixels[2 * columns * y + 2 * column + (quarter & 1)] = colours[phase][purl[i] ? 1 : 0];
      });
    }
  }
  const small = new OffscreenCanvas(2 * columns, 2 * rows);
  /** @type {OffscreenCanvasRenderingContext2D} */ (small.getContext("2d")).putImageData(image, 0, 0);
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  context.imageSmoothingEnabled = canvas.width < small.width; // smaller: mixed; larger: crisp
  context.drawImage(small, 0, 0, canvas.width, canvas.height);
}
