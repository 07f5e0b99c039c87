/**
 * The chart's colours as a picture of 2 × 2 pixels a stitch (its quarters), kept up to date where
 * the chart changed and drawn enlarged: painting costs the same at any zoom.
 *
 * @import {Box, Grid} from "../grid/grid.js"
 * @import {Colouring} from "../state/overlays.js"
 */

export class ColourLayer {
  #image = new ImageData(1, 1);
  #pixels = new Uint32Array(this.#image.data.buffer);
  canvas = new OffscreenCanvas(1, 1);
  /** @type {OffscreenCanvasRenderingContext2D} */ #context = context(this.canvas);

  /**
   * @param {Grid} grid
   * @param {Uint8Array} codes
   * @param {Colouring} colouring
   * @param {Box} box stitches to colour
   * @param {boolean} back whether knits look like purls and the other way round
   */
  update(grid, codes, colouring, box, back) {
    const width = 2 * grid.columns;
    const height = 2 * grid.rows;
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas = new OffscreenCanvas(width, height);
      this.#context = context(this.canvas);
      this.#image = new ImageData(width, height);
      this.#pixels = new Uint32Array(this.#image.data.buffer);
      box = grid.box;
    }
    const pixels = this.#pixels;
    const table = "table" in colouring ? colouring.table : null;
    const turned = back ? 1 : 0;
    const each = "each" in colouring ? colouring.each : null;
    for (let row = box.row0; row < box.row1; row++) {
      const upper = 2 * (grid.rows - 1 - row) * width;
      const lower = upper + width;
      for (let column = box.column0; column < box.column1; column++) {
        const i = row * grid.columns + column;
        const x = 2 * column;
        if (table) {
          const k = ((grid.purl[i] ^ turned) * 16 + codes[i]) * 4;
          pixels[lower + x] = table[k];
          pixels[lower + x + 1] = table[k + 1];
          pixels[upper + x] = table[k + 2];
          pixels[upper + x + 1] = table[k + 3];
        } else if (each) {
          const colour = each(i);
          pixels[lower + x] = pixels[lower + x + 1] = colour;
          pixels[upper + x] = pixels[upper + x + 1] = colour;
        }
      }
    }
    const top = 2 * (grid.rows - box.row1);
    const left = 2 * box.column0;
    this.#context.putImageData(
      this.#image,
      0,
      0,
      left,
      top,
      2 * (box.column1 - box.column0),
      2 * (box.row1 - box.row0),
    );
  }

  /** Colour of a stitch's lower left quarter. @param {Grid} grid @param {number} row @param {number} column */
  pixelAt(grid, row, column) {
    return this.#pixels[(2 * (grid.rows - 1 - row) + 1) * 2 * grid.columns + 2 * column];
  }
}

/** @param {OffscreenCanvas} canvas */
function context(canvas) {
  return /** @type {OffscreenCanvasRenderingContext2D} */ (canvas.getContext("2d"));
}
