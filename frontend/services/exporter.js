/**
 * The design as a file: the project file from the page itself, everything else from the service.
 *
 * @import {Studio} from "../studio.js"
 */

import { ApiError, call } from "../api.js";
import { h } from "../dom.js";

/** @typedef {"knitout" | "svg" | "pdf" | "report" | "written" | "glb" | "stl" | "vtu" | "csv"} Kind */

/** @param {Studio} studio */
export function exportProject(studio) {
  const text = `${JSON.stringify(studio.toDocument(), null, 1)}\n`;
  download(`${fileName(studio)}.json`, new Blob([text], { type: "application/json" }));
}

/** @param {Studio} studio */
export function exportText(studio) {
  const blob = new Blob([`${studio.document.grid.text}\n`], { type: "text/plain" });
  download(`${fileName(studio)}.txt`, blob);
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

/**
 * @param {Studio} studio
 * @param {Kind} to
 */
export async function exportAs(studio, to) {
  const { name, chart, material, outline } = studio.toDocument();
  try {
    /** @type {{name: string, media_type: string, content: string, notes: string[]}} */
    const file = await call("/export", { method: "POST", body: { name, chart, material, outline, to } });
    const bytes = Uint8Array.from(atob(file.content), (c) => c.charCodeAt(0));
    download(file.name, new Blob([bytes], { type: file.media_type }));
    if (file.notes.length) studio.tell(`${file.name}: ${file.notes.join(" ")}`);
  } catch (error) {
    if (!(error instanceof ApiError)) throw error;
    if (error.offline) studio.online.value = false;
    studio.tellProblem({ ...error.problem, title: "This file cannot be made" });
  }
}

/** @param {Studio} studio */
export const fileName = ({ name }) =>
  name.value.replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-|-$/g, "").toLowerCase() || "chart";

/**
 * @param {string} name
 * @param {Blob} blob
 */
export function download(name, blob) {
  const link = h("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
