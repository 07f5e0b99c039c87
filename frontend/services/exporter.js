/**
 * The design as a file that the page makes by itself.
 *
 * @import {Studio} from "../state/studio.js"
 */

import { table } from "../core/striptest.js";
import { h } from "../elements/dom.js";

/** @param {Studio} studio */
export function exportProject(studio) {
  const text = `${JSON.stringify(studio.toDocument(), null, 1)}\n`;
  download(`${fileName(studio)}.json`, new Blob([text], { type: "application/json" }));
}

/** @param {Studio} studio */
export function exportText(studio) {
  const blob = new Blob([`${studio.document.text}\n`], { type: "text/plain" });
  download(`${fileName(studio)}.txt`, blob);
}

/** The steps of the stretch test on show. @param {Studio} studio */
export function exportStretch(studio) {
  const test = studio.currentStretch();
  if (test) download(`${fileName(studio)}-stretch.csv`, new Blob([table(test)], { type: "text/csv" }));
}

/** Knits white, purls black, one pixel a stitch. @param {Studio} studio */
export async function exportPixels(studio) {
  const { rows, columns, purl } = studio.document.grid;
  const canvas = new OffscreenCanvas(columns, rows);
  const context = /** @type {OffscreenCanvasRenderingContext2D} */ (canvas.getContext("2d"));
  const image = new ImageData(columns, rows);
  const pixels = new Uint32Array(image.data.buffer);
  purl.forEach((p, i) => {
    const row = Math.floor(i / columns);
    pixels[(rows - 1 - row) * columns + (i % columns)] = p ? 0xff000000 : 0xffffffff;
  });
  context.putImageData(image, 0, 0);
  download(`${fileName(studio)}.png`, await canvas.convertToBlob({ type: "image/png" }));
}

/** @param {Studio} studio */
export const fileName = ({ name }) =>
  name.value
    .replace(/[^\p{L}\p{N}]+/gu, "-")
    .replace(/^-|-$/g, "")
    .toLowerCase() || "chart";

/** @param {string} name @param {Blob} blob */
export function download(name, blob) {
  const link = h("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
