/**
 * The design's name, undo and redo, size, material, import, export, theme, help.
 *
 * @import {ActionContext} from "../actions/action.js"
 * @import {Studio} from "../studio.js"
 * @import {MaterialSummary} from "../types.js"
 */

import { action, shown } from "../actions/registry.js";
import { h } from "../dom.js";
import { icon } from "../icons.js";
import { menu } from "./menu.js";

/**
 * @param {HTMLElement} host
 * @param {Studio} studio
 * @param {ActionContext} context
 */
export function topbar(host, studio, context) {
  const name = h("input", {
    class: "design-name",
    type: "text",
    value: studio.name.value,
    maxLength: 80,
    spellcheck: false,
    "aria-label": "Name of the design",
    onchange: () => {
      studio.name.value = name.value.trim() || "Untitled";
      name.value = studio.name.value;
    },
    onkeydown: (/** @type {KeyboardEvent} */ { key }) => {
      if (key === "Enter" || key === "Escape") name.blur();
    },
  });

  /** @param {string} id @param {string} [text] */
  const button = (id, text) => {
    const { label, icon: picture, keys, perform, enabled } = action(id);
    const element = h(
      "button",
      {
        class: text ? "button quiet" : "button quiet icon-only",
        type: "button",
        id: `action-${id}`,
        title: `${label} (${shown(keys[0])})`,
        "aria-label": text ? undefined : label,
        onclick: () => perform(context),
      },
      picture && icon(picture),
      text,
    );
    if (enabled) {
      const update = () => (element.disabled = !enabled(studio));
      studio.document.onSettle(update);
      update();
    }
    return element;
  };

  const size = h("button", {
    class: "button quiet figures",
    type: "button",
    id: "chart-size",
    title: "Size and new chart (N)",
    onclick: () => context.open("resize"),
  });
  const showSize = () => {
    const { columns, rows } = studio.document.grid;
    size.replaceChildren(icon("resize"), `${columns} × ${rows} sts`);
    size.setAttribute("aria-label", `${columns} stitches by ${rows} rows: change size`);
  };
  studio.document.onChange(({ resized }) => resized && showSize());
  showSize();

  host.append(
    h("div", { class: "brand", title: "Knitcore" }, h("img", { src: "/static/icon.svg", alt: "Knitcore", width: 26, height: 26 })),
    name,
    h("div", { class: "group" }, button("undo"), button("redo")),
    size,
    h("div", { class: "spacer" }),
    materialMenu(studio),
    button("import", "Import"),
    exportMenu(studio),
    h("div", { class: "group" }, button("theme"), button("help")),
  );
}

/** @param {Studio} studio */
function materialMenu(studio) {
  const label = h("span", { class: "ellipsis" }, "Material");
  const { root, setItems, button } = menu({
    id: "material",
    label: "Material",
    content: [h("span", { class: "muted" }, "Material"), label, icon("down")],
    class: "button material-button",
  });
  const show = () => {
    const all = studio.materials.value;
    const chosen = all.find(({ id }) => id === studio.materialId.value);
    label.textContent = chosen?.name ?? studio.materialId.value;
    button.setAttribute("aria-label", `Material: ${label.textContent}`);
    setItems(
      all.map((material) => ({
        id: `material-${material.id}`,
        content: materialItem(material),
        checked: material.id === studio.materialId.value,
        disabled: Object.keys(material.fabrics).length < 4,
        perform: () => (studio.materialId.value = material.id),
      })),
    );
  };
  studio.materials.watch(show);
  studio.materialId.listen(show);
  return root;
}

/** @param {MaterialSummary} material */
function materialItem({ name, description, fabrics }) {
  const gauge = fabrics.stockinette;
  const complete = Object.keys(fabrics).length === 4;
  const stitches =
    gauge?.stitch_course_mm && gauge.stitch_wale_mm
      ? `${(100 / gauge.stitch_course_mm).toFixed(0)} sts × ${(100 / gauge.stitch_wale_mm).toFixed(0)} rows per 10 cm`
      : "";
  return h(
    "span",
    { class: "menu-lines" },
    h("span", {}, name),
    h(
      "span",
      { class: "muted figures" },
      complete
        ? [description, stitches].filter(Boolean).join(" · ")
        : "Not all four fabrics were measured: cannot be mixed in a chart",
    ),
  );
}

/** @param {Studio} studio */
function exportMenu(studio) {
  const { root, setItems } = menu({
    id: "export",
    label: "Export",
    content: [icon("export"), "Export"],
    class: "button primary",
  });
  const file = () => studio.name.value.replace(/[^\p{L}\p{N}]+/gu, "-").toLowerCase() || "chart";
  setItems([
    {
      id: "export-text",
      content: "Chart as text (.txt)",
      perform: () => download(`${file()}.txt`, new Blob([`${studio.document.grid.text}\n`], { type: "text/plain" })),
    },
    {
      id: "export-copy",
      content: "Copy the text",
      perform: () =>
        void navigator.clipboard.writeText(studio.document.grid.text).then(
          () => studio.tell("The chart's text is on the clipboard."),
          () => studio.tell("The browser does not allow copying; export as a file instead."),
        ),
    },
    {
      id: "export-image",
      content: "Picture, one pixel a stitch (.png)",
      perform: () => void picture(studio).then((blob) => download(`${file()}.png`, blob)),
    },
  ]);
  return root;
}

/** Knits white, purls black. @param {Studio} studio */
function picture({ document }) {
  const { rows, columns, purl } = document.grid;
  const canvas = new OffscreenCanvas(columns, rows);
  const context = /** @type {OffscreenCanvasRenderingContext2D} */ (canvas.getContext("2d"));
  const image = new ImageData(columns, rows);
  const pixels = new Uint32Array(image.data.buffer);
  purl.forEach((p, i) => {
    const row = Math.floor(i / columns);
    pixels[(rows - 1 - row) * columns + (i % columns)] = p ? 0xff000000 : 0xffffffff;
  });
  context.putImageData(image, 0, 0);
  return canvas.convertToBlob({ type: "image/png" });
}

/**
 * @param {string} name
 * @param {Blob} blob
 */
function download(name, blob) {
  const link = h("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10_000);
}
