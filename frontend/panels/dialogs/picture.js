/**
 * A picture becomes a chart: the service reads it, as the command line does, and its chart is shown before it is
 * taken.
 *
 * @import {ImportRequest, ImportResult, Problem} from "../../types.js"
 * @import {ActionContext} from "../../actions/action.js"
 *
 * @typedef {Omit<ImportRequest, "file">} Reading
 * @typedef {{name: string, bitmap: ImageBitmap | null, own: ImportResult | null,
 *   read: (reading: Reading, signal?: AbortSignal) => Promise<ImportResult>}} Picture
 *   bitmap is null where the browser cannot show it, own where it shows no stitches by itself
 */

import { pixel, readPalette } from "../../state/palette.js";
import { plainDesign } from "../../design/design.js";
import { Grid, MAX_SIDE, isChartText } from "../../grid/grid.js";
import { h, remark } from "../../elements/dom.js";
import { ApiError, api, refusal } from "../../api.js";
import { Latest } from "../../services/latest.js";
import { uploaded } from "../../services/yarns.js";
import { dialog } from "../../widgets/dialog.js";
import { sizeFields } from "../../widgets/fields.js";
import { textButton } from "../../widgets/buttons.js";
import { problemBox } from "../../widgets/problem.js";

const TYPING_MS = 150;
/** Stitches across a photo, until another number is typed. */
const PHOTO_COLUMNS = 60;

/**
 * @param {ActionContext} context
 * @param {File} file
 * @returns {Promise<Problem | null>} null when the dialog is open, or what is wrong
 */
export async function importPicture(context, file) {
  const picture = await uploaded(file);
  const material = context.studio.materialId.value;
  /** @type {Picture["read"]} */
  const read = (reading, signal) => api.run("import", { file: picture, material, ...reading }, signal);
  /** @type {ImportResult | null} */
  let own = null;
  try {
    own = await read({});
  } catch (error) {
    if (!(error instanceof ApiError)) throw error;
    if (error.problem.field !== "columns") return refusal(error.problem.detail ?? "", error.problem.remedy);
  }
  const bitmap = await createImageBitmap(file).catch(() => null);
  pictureDialog(context, { name: file.name, bitmap, own, read });
  return null;
}

/** @param {ActionContext} context @param {Picture} picture */
function pictureDialog({ studio, keeper }, { name, bitmap, own, read }) {
  document.getElementById("picture-dialog")?.remove();
  const stitchSize = studio.material.value?.fabrics.stockinette;
  const stitch = (stitchSize?.stitch_wale_mm ?? 0.8) / (stitchSize?.stitch_course_mm ?? 1);
  /** The side that was typed last. The other follows from it; both from the picture if none was. */
  let typed = /** @type {"columns" | "rows" | null} */ (own ? null : "columns");
  /** The chart on show. @type {Grid | null} */
  let grid = null;
  const latest = new Latest(TYPING_MS);

  /** @param {string} id @param {boolean} checked */
  const check = (id, checked) => h("input", { type: "checkbox", id: `picture-${id}`, checked, onchange: () => ask() });
  const locked = check("locked", true);
  const knitted = check("knitted", !own && Boolean(stitchSize));
  const given = check("given", false);
  const inverted = check("inverted", false);
  const threshold = h("input", {
    type: "range",
    class: "slider grows",
    id: "picture-threshold",
    "aria-label": "Grey below which a stitch is a purl",
    min: 1,
    max: 255,
    value: 128,
    oninput: () => {
      given.checked = true;
      ask();
    },
  });
  const size = sizeFields("picture", MAX_SIDE, (side) => {
    typed = side;
    ask();
  });
  size.show(own ?? { columns: PHOTO_COLUMNS, rows: PHOTO_COLUMNS });
  const share = h("output", { class: "figures muted", for: "picture-threshold" });
  const notes = remark("");
  const status = h("div", { class: "dialog-status", role: "status" });
  const views = previews(stitch);

  /** What is asked of the picture. @returns {Reading} */
  const reading = () => {
    const { columns, rows } = size;
    const how = {
      dark_below: given.checked ? threshold.valueAsNumber : null,
      light_is_purl: inverted.checked,
      aspect: /** @type {Reading["aspect"]} */ (knitted.checked ? "as-knitted" : "keep"),
    };
    if (!typed) return how;
    if (locked.checked) return { ...how, [typed]: size[typed].valueAsNumber };
    return { ...how, aspect: "free", columns: columns.valueAsNumber, rows: rows.valueAsNumber };
  };
  const ask = () => {
    latest.cancel();
    show(null);
    if (typed && !size.read()) return;
    share.textContent = "Reading …";
    latest.run(
      async (signal) => take(await read(reading(), signal)),
      ({ problem }) => status.replaceChildren(problemBox(problem)),
    );
  };
  /** @param {ImportResult} result */
  const take = (result) => {
    size.show(result);
    notes.textContent = result.notes?.join(" ") ?? "";
    if (size.read() && isChartText(result.chart)) show(Grid.fromText(result.chart));
  };
  /** @param {Grid | null} chart */
  const show = (chart) => {
    grid = chart;
    apply.disabled = replace.disabled = !grid;
    share.textContent = "";
    status.replaceChildren();
    if (!grid) return;
    share.textContent = `${Math.round((100 * grid.purl.reduce((sum, p) => sum + p, 0)) / grid.purl.length)} % purl`;
    views.show(grid, share.textContent);
  };

  /** @param {string} id @param {string} label @param {(grid: Grid) => string} use says where the old chart is */
  const taking = (id, label, use) =>
    textButton(
      null,
      label,
      () => {
        if (!grid) return;
        element.close();
        studio.tell(`Imported ${grid.columns} stitches × ${grid.rows} rows from ${name}. ${use(grid)}`);
      },
      { id, class: id === "picture-apply" ? "button primary" : "button" },
    );
  const apply = taking("picture-apply", "New design", (chart) => {
    keeper.openNew(plainDesign(name.replace(/\.[^.]*$/, "") || "Picture", chart.text, studio.materialId.value));
    return "The design before it is still among your designs.";
  });
  const replace = taking("picture-replace", "Replace this chart", (chart) => {
    studio.document.replace(chart, "Import");
    return "Undo brings the old chart back.";
  });

  /** @param {string} id @param {string} label @param {{columns: number, rows: number}} cells @param {typeof typed} side */
  const sizeButton = (id, label, cells, side) =>
    textButton(
      null,
      label,
      () => {
        [typed, knitted.checked] = [side, false];
        size.show(cells);
        ask();
      },
      { id },
    );
  const pixels = bitmap && { columns: bitmap.width, rows: bitmap.height };
  const isPixels = own?.columns === pixels?.columns && own?.rows === pixels?.rows;
  const element = dialog(
    "picture-dialog",
    "Import a picture",
    h("div", { class: "picture-pair stack" }, bitmap && original(name, bitmap), ...views.figures),
    h(
      "div",
      { class: "fields" },
      ...size.elements,
      h(
        "div",
        { class: "picture-sizes flex wrap gap-8" },
        pixels &&
          Math.max(pixels.columns, pixels.rows) <= MAX_SIDE &&
          sizeButton("picture-each", "A pixel a stitch", pixels, "columns"),
        own && !isPixels && sizeButton("picture-found", `Grid found: ${own.columns} × ${own.rows}`, own, null),
      ),
    ),
    h(
      "div",
      { class: "picture-tone line wrap gap-12" },
      h("label", { class: "check" }, locked, "Keep the proportions"),
      h("label", { class: "check" }, knitted, "as it is knitted in this yarn"),
    ),
    size.problem,
    notes,
    h(
      "div",
      { class: "picture-tone line wrap gap-12" },
      h("label", { class: "check" }, given, "Purl if darker than"),
      threshold,
      share,
      h("label", { class: "check" }, inverted, "Light is purl"),
    ),
    status,
    h(
      "div",
      { class: "dialog-buttons" },
      h("button", { class: "button", onclick: () => element.close() }, "Cancel"),
      replace,
      apply,
    ),
  );
  element.addEventListener("close", () => {
    latest.cancel();
    element.remove();
  });
  element.showModal();
  if (own) take(own);
  else ask();
  size.columns.focus();
}

/** The picture as it came. @param {string} name @param {ImageBitmap} bitmap */
function original(name, bitmap) {
  const canvas = h("canvas", { class: "picture-preview", role: "img", "aria-label": `The picture ${name}` });
  fit(canvas, bitmap.width, bitmap.height, (context, wide, high) => {
    context.imageSmoothingEnabled = wide < bitmap.width;
    context.drawImage(bitmap, 0, 0, wide, high);
  });
  return figure(canvas, `${name}, ${bitmap.width} × ${bitmap.height} pixels`, "ellipsis");
}

/** @param {HTMLCanvasElement} canvas @param {string} caption @param {string} [style] of the caption */
const figure = (canvas, caption, style = "") =>
  h("figure", {}, canvas, h("figcaption", { class: `muted small ${style}` }, caption));

/**
 * The chart in squares, and as it is knitted in this yarn.
 *
 * @param {number} stitch height of a stitch over its width
 */
function previews(stitch) {
  /** @param {string} id */
  const canvas = (id) => h("canvas", { class: "picture-preview", id, role: "img" });
  const [preview, asKnitted] = [canvas("picture-preview"), canvas("picture-as-knitted")];
  const views = [
    { canvas: preview, tall: 1, words: "The chart in squares" },
    { canvas: asKnitted, tall: stitch, words: "As it is knitted" },
  ];
  return {
    figures: [
      figure(preview, "The chart in squares, from the face"),
      figure(asKnitted, `As knitted: a stitch is ${stitch.toFixed(2)} times as high as wide`),
    ],
    /** @param {Grid} grid @param {string} share of purls, in words */
    show: (grid, share) => {
      const palette = readPalette();
      const small = drawn(grid, palette);
      for (const { canvas, tall, words } of views) {
        canvas.ariaLabel = `${words}: ${grid.columns} stitches × ${grid.rows} rows, ${share}`;
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
    },
  };
}

/** A chart with a pixel for a stitch. @param {Grid} grid @param {ReturnType<typeof readPalette>} palette */
function drawn({ rows, columns, purl }, palette) {
  const [light, dark] = [pixel(palette.knit), pixel(palette.dark ? [28, 26, 24] : [92, 80, 68])];
  const image = new ImageData(columns, rows);
  const pixels = new Uint32Array(image.data.buffer);
  for (let row = 0, i = 0; row < rows; row++) {
    const line = (rows - 1 - row) * columns;
    for (let column = 0; column < columns; column++, i++) pixels[line + column] = purl[i] ? dark : light;
  }
  const canvas = new OffscreenCanvas(columns, rows);
  /** @type {OffscreenCanvasRenderingContext2D} */ (canvas.getContext("2d")).putImageData(image, 0, 0);
  return canvas;
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
