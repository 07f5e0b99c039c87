/**
 * The size of the chart, and a new one.
 *
 * @import {Studio} from "../../studio.js"
 */

import { Grid, MAX_SIDE } from "../../core/grid.js";
import { h } from "../../dom.js";
import { dialog } from "./dialog.js";

/** @param {Studio} studio */
export function create(studio) {
  /** @param {string} label @param {string} id */
  const field = (label, id) => {
    const input = h("input", { type: "number", class: "number figures", id, min: "1", max: String(MAX_SIDE), required: true });
    return { input, row: h("label", { class: "field" }, h("span", {}, label), input) };
  };
  const columns = field("Stitches", "new-columns");
  const rows = field("Rows", "new-rows");
  const problem = h("p", { class: "problem-text", role: "alert" });
  /** @param {(rows: number, columns: number) => Grid} make @param {string} label */
  const apply = (make, label) => {
    const size = [rows.input, columns.input].map(({ valueAsNumber }) => valueAsNumber);
    if (!size.every((n) => Number.isInteger(n) && n >= 1 && n <= MAX_SIDE)) {
      problem.textContent = `Use whole numbers from 1 to ${MAX_SIDE}.`;
      return;
    }
    studio.document.replace(make(size[0], size[1]), label);
    element.close();
  };
  const { document } = studio;
  const element = dialog(
    "resize-dialog",
    "Size of the chart",
    h("div", { class: "fields" }, columns.row, rows.row),
    problem,
    h("p", { class: "muted" }, "The chart is kept at its bottom left corner. All three can be undone."),
    h("div", { class: "dialog-buttons" },
      h("button", { class: "button", type: "button", onclick: () => apply((r, c) => new Grid(r, c), "New chart") }, "New, all knit"),
      h("button", { class: "button", type: "button", onclick: () => apply((r, c) => document.grid.tiled(r, c), "Repeat") }, "Repeat to this size"),
      h("button", { class: "button primary", type: "button", id: "resize-apply", onclick: () => apply((r, c) => document.grid.resized(r, c), "Resize") }, "Resize")),
  );
  return () => {
    columns.input.value = String(document.grid.columns);
    rows.input.value = String(document.grid.rows);
    problem.textContent = "";
    element.showModal();
    columns.input.select();
  };
}
