/**
 * Charts from outside: pasted or dropped text, text files, pictures. The service reads the text, so
 * that the page and the command line accept the same; what cannot be read changes nothing.
 *
 * @import {Studio} from "../studio.js"
 * @import {Problem} from "../types.js"
 */

import { ApiError, api } from "../api.js";
import { Grid, MAX_SIDE, isChartText } from "../core/grid.js";

const MAX_FILE_BYTES = 4_000_000;

/**
 * @param {string} detail
 * @param {string} remedy
 * @returns {Problem}
 */
const refusal = (detail, remedy) => ({
  type: "input",
  title: "This chart cannot be imported",
  status: 422,
  detail,
  remedy,
});

/**
 * @param {Studio} studio
 * @param {string} text
 * @returns {Promise<Problem | null>} what is wrong, or null if the chart is now this one
 */
export async function importText(studio, text) {
  try {
    const { rows, columns, text: chart } = await api.parse(text);
    if (!isChartText(chart)) {
      return refusal(
        `${columns} stitches × ${rows} rows is more than this page paints.`,
        `Use at most ${MAX_SIDE} × ${MAX_SIDE}; the command line takes more.`,
      );
    }
    studio.document.replace(Grid.fromText(chart), "Import");
    studio.tell(`Imported ${columns} stitches × ${rows} rows. Undo brings the old chart back.`);
    return null;
  } catch (error) {
    if (!(error instanceof ApiError)) throw error;
    return { ...error.problem, title: "This chart cannot be imported" };
  }
}

/**
 * @param {Studio} studio
 * @param {File} file
 * @returns {Promise<Problem | null>}
 */
export async function importFile(studio, file) {
  if (file.size > MAX_FILE_BYTES) {
    return refusal(`${file.name} has ${file.size} bytes.`, "Charts have at most 4 MB.");
  }
  if (file.type.startsWith("image/")) return importPicture(studio, file);
  return importText(studio, await file.text());
}

/**
 * @param {Studio} studio
 * @param {File} file one pixel a stitch
 * @returns {Promise<Problem | null>}
 */
async function importPicture(studio, file) {
  /** @type {ImageBitmap} */
  let bitmap;
  try {
    bitmap = await createImageBitmap(file);
  } catch {
    return refusal(`${file.name} is not a picture that this browser can read.`, "Use a PNG file.");
  }
  const { width, height } = bitmap;
  if (Math.max(width, height) > MAX_SIDE) {
    return refusal(
      `The picture has ${width} × ${height} pixels, and every pixel is a stitch.`,
      `Scale it down to at most ${MAX_SIDE} × ${MAX_SIDE} pixels.`,
    );
  }
  const canvas = new OffscreenCanvas(width, height);
  const context = /** @type {OffscreenCanvasRenderingContext2D} */ (canvas.getContext("2d"));
  context.fillStyle = "white"; // see-through pixels are knits
  context.fillRect(0, 0, width, height);
  context.drawImage(bitmap, 0, 0);
  const { data } = context.getImageData(0, 0, width, height);
  const grid = Grid.build(height, width, (row, column) => {
    const k = 4 * ((height - 1 - row) * width + column);
    return 0.299 * data[k] + 0.587 * data[k + 1] + 0.114 * data[k + 2] < 128;
  });
  studio.document.replace(grid, "Import");
  studio.tell(`Imported ${width} stitches × ${height} rows from ${file.name}.`);
  return null;
}

/**
 * Take what is dropped on the page or pasted into it.
 *
 * @param {Studio} studio
 * @param {() => boolean} isTyping
 */
export function listenToImports(studio, isTyping) {
  /** @param {Promise<Problem | null>} outcome */
  const report = async (outcome) => {
    const problem = await outcome;
    if (problem) studio.tellProblem(problem);
  };
  window.addEventListener("paste", (event) => {
    const text = event.clipboardData?.getData("text/plain") ?? "";
    if (isTyping() || document.querySelector("dialog[open]") || !text.trim()) return;
    event.preventDefault();
    void report(importText(studio, text));
  });
  const root = document.documentElement;
  window.addEventListener("dragover", (event) => {
    event.preventDefault();
    root.dataset.dropping = "";
  });
  window.addEventListener("dragleave", (event) => {
    if (!event.relatedTarget) delete root.dataset.dropping;
  });
  window.addEventListener("drop", (event) => {
    event.preventDefault();
    delete root.dataset.dropping;
    const file = event.dataTransfer?.files[0];
    const text = event.dataTransfer?.getData("text/plain");
    if (file) void report(importFile(studio, file));
    else if (text) void report(importText(studio, text));
  });
}
