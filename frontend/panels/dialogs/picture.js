/**
 * A picture becomes a chart: how its cells lie, what is dark, and how that looks, before it is taken.
 *
 * @import {Problem} from "../../types.js"
 * @import {ActionContext} from "../../actions/action.js"
 */

import { pixel, readPalette } from "../../state/palette.js";
import { plainDesign } from "../../design/design.js";
import { Grid, MAX_SIDE, isChartText } from "../../grid/grid.js";
import { bestThreshold, detectedGrid, greys, stitchesOf } from "../../grid/picture.js";
import { h, remark } from "../../elements/dom.js";
import { ApiError, api, refusal } from "../../api.js";
import { uploaded } from "../../services/yarns.js";
import { dialog } from "../../widgets/dialog.js";
import { sizeFields } from "../../widgets/fields.js";
import { textButton } from "../../widgets/buttons.js";

/** Larger pictures are made smaller before they are looked at. */
const MAX_PIXELS = 1600;

/**
 * @param {ActionContext} context
 * @param {File} file
 * @returns {Promise<Problem | null>} when the dialog is open, or what is wrong
 */
export async function importPicture(context, file) {
  /** @type {ImageBitmap} */
  let bitmap;
  try {
    bitmap = await createImageBitmap(file);
  } catch {
    return refusal(`${file.name} is not a picture that this browser can read.`, "Use a PNG file.");
  }
  const scale = Math.min(1, MAX_PIXELS / Math.max(bitmap.width, bitmap.height));
  const width = Math.max(1, Math.round(bitmap.width * scale));
  const height = Math.max(1, Math.round(bitmap.height * scale));
  const canvas = new OffscreenCanvas(width, height);
  const drawing = /** @type {OffscreenCanvasRenderingContext2D} */ (canvas.getContext("2d"));
  drawing.drawImage(bitmap, 0, 0, width, height);
  pictureDialog(context, file.name, bitmap, {
    values: greys(drawing.getImageData(0, 0, width, height)),
    width,
    height,
    aspect: context.studio.material.value?.fabrics.stockinette ?? null,
    ...(await readByService(file)),
  });
  return null;
}

/**
 * The chart that the service's reader sees in a picture, as the command line does, and what it says of it. Without
 * it, as offline, cells are looked for here.
 *
 * @param {File} file
 * @returns {Promise<{seen: Grid | null, notes: readonly string[]}>}
 */
async function readByService(file) {
  try {
    const { chart, notes } = await api.run("import", { file: await uploaded(file) });
    return { seen: isChartText(chart) ? Grid.fromText(chart) : null, notes };
  } catch (error) {
    if (!(error instanceof ApiError)) throw error;
    return { seen: null, notes: error.offline ? [] : [error.problem.detail ?? error.problem.title] };
  }
}

/**
 * @param {ActionContext} context
 * @param {string} name
 * @param {ImageBitmap} bitmap
 * @param {{values: Uint8Array, width: number, height: number,
 *   aspect: {stitch_course_mm: number | null, stitch_wale_mm: number | null} | null,
 *   seen: Grid | null, notes: readonly string[]}} picture
 */
function pictureDialog({ studio, keeper }, name, bitmap, { values, width, height, aspect, seen, notes }) {
  document.getElementById("picture-dialog")?.remove();
  const stitch = (aspect?.stitch_wale_mm ?? 0.8) / (aspect?.stitch_course_mm ?? 1);
  const each = Math.max(bitmap.width, bitmap.height) <= MAX_SIDE;
  const isPixels = seen?.columns === bitmap.width && seen.rows === bitmap.height;
  const detected = isPixels ? null : (seen ?? detectedGrid(values, width, height));
  const guess = Math.min(60, width);
  const cells =
    detected ??
    (each
      ? { columns: bitmap.width, rows: bitmap.height }
      : { columns: guess, rows: Math.min(MAX_SIDE, Math.max(1, Math.round((guess * height) / width / stitch))) });

  /** Rows of a column that keep the picture's proportions: of squares, or of stitches as they are knitted. */
  const proportion = () => height / width / (knitted.checked ? stitch : 1);
  /** The other side follows the one that was typed. @param {"columns" | "rows"} typed */
  const follow = (typed) => {
    const { columns, rows } = size;
    const [from, to] = typed === "columns" ? [columns, rows] : [rows, columns];
    const ratio = typed === "columns" ? proportion() : 1 / proportion();
    const other = Math.round(from.valueAsNumber * ratio);
    if (locked.checked && from.valueAsNumber >= 1) to.value = String(Math.min(MAX_SIDE, Math.max(1, other)));
    show();
  };
  const locked = h("input", {
    type: "checkbox",
    id: "picture-locked",
    checked: true,
    onchange: () => follow("columns"),
  });
  const knitted = h("input", {
    type: "checkbox",
    id: "picture-knitted",
    checked: !detected && !each,
    onchange: () => follow("columns"),
  });
  const size = sizeFields("picture", MAX_SIDE, () => show());
  for (const side of /** @type {const} */ (["columns", "rows"])) {
    size[side].addEventListener("input", () => follow(side));
  }
  size.show(cells);
  const best = bestThreshold(values);
  const threshold = h("input", {
    type: "range",
    class: "slider grows",
    id: "picture-threshold",
    min: 1,
    max: 255,
    value: best,
    oninput: () => show(),
  });
  const share = h("output", { class: "figures muted", for: "picture-threshold" });
  const inverted = h("input", { type: "checkbox", id: "picture-inverted", onchange: () => show() });
  const preview = h("canvas", { class: "picture-preview", id: "picture-preview", role: "img" });
  const asKnitted = h("canvas", { class: "picture-preview", id: "picture-as-knitted", role: "img" });
  /** The chart in squares, and as it is knitted in this yarn. */
  const views = [
    { canvas: preview, high: 1, words: "The chart in squares" },
    { canvas: asKnitted, high: stitch, words: "As it is knitted" },
  ];
  const source = h("canvas", { class: "picture-preview", role: "img", "aria-label": `The picture ${name}` });
  /** @param {(grid: Grid) => string} use says where the old chart is */
  const take = (use) => {
    const grid = read();
    if (!grid) return;
    element.close();
    const before = use(grid);
    studio.tell(`Imported ${grid.columns} stitches × ${grid.rows} rows from ${name}. ${before}`);
  };
  const apply = textButton(
    null,
    "New design",
    () =>
      take((grid) => {
        keeper.openNew(plainDesign(name.replace(/\.[^.]*$/, "") || "Picture", grid.text, studio.materialId.value));
        return "The design before it is still among your designs.";
      }),
    { class: "button primary", id: "picture-apply" },
  );
  const replace = textButton(
    null,
    "Replace this chart",
    () =>
      take((grid) => {
        studio.document.replace(grid, "Import");
        return "Undo brings the old chart back.";
      }),
    { id: "picture-replace" },
  );

  /** @param {string} id @param {string} label @param {{columns: number, rows: number}} cells */
  const sizeButton = (id, label, cells) =>
    textButton(
      null,
      label,
      () => {
        size.show(cells);
        show();
      },
      { id },
    );

  const read = () => {
    const cells = size.read();
    apply.disabled = replace.disabled = !cells;
    if (!cells) return null;
    const { columns, rows } = cells;
    const tones = { threshold: threshold.valueAsNumber, inverted: inverted.checked };
    const isAsSeen = seen?.columns === columns && seen.rows === rows && tones.threshold === best;
    if (!seen || !isAsSeen) return stitchesOf(values, width, height, { ...cells, ...tones });
    return Grid.build(rows, columns, (row, column) => Boolean(seen.purl[row * columns + column]) !== tones.inverted);
  };
  const show = () => {
    const grid = read();
    if (!grid) return;
    const purls = grid.purl.reduce((sum, p) => sum + p, 0);
    share.textContent = `${Math.round((100 * purls) / grid.purl.length)} % purl`;
    for (const { canvas, words } of views) {
      canvas.ariaLabel = `${words}: ${grid.columns} stitches × ${grid.rows} rows, ${share.textContent}`;
    }
    const palette = readPalette();
    const [knit, purl] = [pixel(palette.knit), pixel(palette.dark ? [216, 206, 194] : [92, 80, 68])];
    const image = new ImageData(grid.columns, grid.rows);
    const pixels = new Uint32Array(image.data.buffer);
    for (let row = 0, i = 0; row < grid.rows; row++) {
      const line = (grid.rows - 1 - row) * grid.columns;
      for (let column = 0; column < grid.columns; column++, i++) pixels[line + column] = grid.purl[i] ? purl : knit;
    }
    const small = new OffscreenCanvas(grid.columns, grid.rows);
    /** @type {OffscreenCanvasRenderingContext2D} */ (small.getContext("2d")).putImageData(image, 0, 0);
    for (const { canvas, high: tall } of views) {
      fit(canvas, grid.columns, grid.rows * tall, (context, wide, high) => {
        context.imageSmoothingEnabled = wide < grid.columns;
        context.drawImage(small, 0, 0, wide, high);
        const [cellWide, cellHigh] = [wide / grid.columns, high / grid.rows];
        if (cellWide < 6) return;
        context.fillStyle = palette.dark ? "rgb(0 0 0 / 0.4)" : "rgb(60 45 30 / 0.2)";
        for (let c = 1; c < grid.columns; c++) context.fillRect(Math.round(c * cellWide), 0, 1, high);
        for (let r = 1; r < grid.rows; r++) context.fillRect(0, Math.round(r * cellHigh), wide, 1);
      });
    }
  };

  const element = dialog(
    "picture-dialog",
    "Import a picture",
    h(
      "div",
      { class: "picture-pair stack" },
      h(
        "figure",
        {},
        source,
        h("figcaption", { class: "muted ellipsis small" }, `${name}, ${bitmap.width} × ${bitmap.height} pixels`),
      ),
      h("figure", {}, preview, h("figcaption", { class: "muted small" }, "The chart in squares, from the face")),
      h(
        "figure",
        {},
        asKnitted,
        h("figcaption", { class: "muted small" }, `As knitted: a stitch is ${stitch.toFixed(2)} times as high as wide`),
      ),
    ),
    h(
      "div",
      { class: "fields" },
      ...size.elements,
      h(
        "div",
        { class: "picture-sizes flex wrap gap-8" },
        each && sizeButton("picture-each", "A pixel a stitch", { columns: bitmap.width, rows: bitmap.height }),
        detected && sizeButton("picture-found", `Grid found: ${detected.columns} × ${detected.rows}`, detected),
      ),
    ),
    h(
      "div",
      { class: "picture-tone line wrap gap-12" },
      h("label", { class: "check" }, locked, "Keep the proportions"),
      h("label", { class: "check" }, knitted, "as it is knitted in this yarn"),
    ),
    size.problem,
    notes.length > 0 && remark(notes.join(" ")),
    h(
      "div",
      { class: "picture-tone line wrap gap-12" },
      h("label", { for: "picture-threshold" }, "Purl if darker than"),
      threshold,
      share,
      h("label", { class: "check" }, inverted, "Light is purl"),
    ),
    h(
      "div",
      { class: "dialog-buttons" },
      h("button", { class: "button", onclick: () => element.close() }, "Cancel"),
      replace,
      apply,
    ),
  );
  element.addEventListener("close", () => element.remove());
  element.showModal();
  fit(source, bitmap.width, bitmap.height, (context, wide, high) => {
    context.imageSmoothingEnabled = wide < bitmap.width;
    context.drawImage(bitmap, 0, 0, wide, high);
  });
  show();
  size.columns.focus();
}

/**
 * Draw something into a canvas, as large as its place allows.
 *
 * @param {HTMLCanvasElement} canvas
 * @param {number} width
 * @param {number} height
 * @param {(context: CanvasRenderingContext2D, width: number, height: number) => void} draw
 */
function fit(canvas, width, height, draw) {
  const scale = Math.min(260 / width, 220 / height);
  canvas.style.width = `${Math.max(1, width * scale)}px`;
  canvas.style.height = `${Math.max(1, height * scale)}px`;
  canvas.width = Math.max(1, Math.round(2 * width * scale));
  canvas.height = Math.max(1, Math.round(2 * height * scale));
  draw(/** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d")), canvas.width, canvas.height);
}
