/**
 * The dialogs: size and new chart, import, commands, help.
 *
 * @import {ActionContext} from "../actions/action.js"
 * @import {Studio} from "../studio.js"
 */

import { ACTIONS, shown } from "../actions/registry.js";
import { importFile, importText } from "../services/importer.js";
import { Grid, MAX_SIDE } from "../core/grid.js";
import { h } from "../dom.js";
import { icon } from "../icons.js";
import { TOOLS } from "../tools/registry.js";

/**
 * @param {string} id
 * @param {string} title
 * @param {...Node} content
 */
function dialog(id, title, ...content) {
  const element = h(
    "dialog",
    { id, class: "dialog", "aria-labelledby": `${id}-title` },
    h("header", {},
      h("h2", { id: `${id}-title` }, title),
      h("button", { class: "button quiet icon-only", type: "button", "aria-label": "Close", onclick: () => element.close() }, icon("close"))),
    ...content,
  );
  element.addEventListener("click", (event) => {
    if (event.target === element) element.close();
  });
  document.body.append(element);
  return element;
}

/** @param {Studio} studio */
export function resizeDialog(studio) {
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

/** @param {Studio} studio */
export function importDialog(studio) {
  const text = h("textarea", {
    id: "import-text",
    class: "import-text",
    rows: 10,
    spellcheck: false,
    placeholder: "KPKPKP\nPKPKPK",
    "aria-label": "Chart as lines of K and P, top row first",
  });
  const problem = h("div", { class: "problem", role: "alert", id: "import-problem", hidden: true });
  /** @param {Promise<import("../types.js").Problem | null>} outcome */
  const settle = async (outcome) => {
    const wrong = await outcome;
    problem.hidden = wrong === null;
    if (wrong) {
      problem.replaceChildren(icon("warning"), h("div", {}, h("strong", {}, wrong.title), h("p", {}, wrong.detail), h("p", {}, wrong.remedy ?? "")));
    } else element.close();
  };
  const file = h("input", {
    type: "file",
    id: "import-file",
    accept: ".txt,.png,text/plain,image/png",
    class: "visually-hidden",
    onchange: () => file.files?.[0] && void settle(importFile(studio, file.files[0])),
  });
  const element = dialog(
    "import-dialog",
    "Import a chart",
    h("p", { class: "muted" }, "Lines of K and P (or | and •), the top row first, as seen from the face. A text or PNG file (one pixel a stitch, dark = purl) can also be dropped anywhere on the page."),
    text,
    problem,
    h("div", { class: "dialog-buttons" },
      h("label", { class: "button", for: "import-file" }, "Choose a file …"),
      file,
      h("button", { class: "button primary", type: "button", id: "import-apply", onclick: () => void settle(importText(studio, text.value)) }, "Import")),
  );
  return () => {
    problem.hidden = true;
    text.value = "";
    element.showModal();
    text.focus();
  };
}

/** @param {ActionContext} context */
export function paletteDialog(context) {
  const list = h("div", { class: "command-list", role: "listbox", "aria-label": "Commands" });
  const search = h("input", {
    type: "text",
    id: "command-search",
    class: "command-search",
    placeholder: "Find a tool or command",
    "aria-label": "Find a tool or command",
    oninput: () => show(),
    onkeydown: (/** @type {KeyboardEvent} */ event) => {
      const items = /** @type {HTMLElement[]} */ ([...list.children]);
      const at = items.findIndex((item) => item.ariaSelected === "true");
      const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
      if (step && items.length) {
        event.preventDefault();
        items[at].ariaSelected = "false";
        const next = items[(at + step + items.length) % items.length];
        next.ariaSelected = "true";
        next.scrollIntoView({ block: "nearest" });
      } else if (event.key === "Enter") items[at]?.click();
    },
  });
  const show = () => {
    const wanted = search.value.trim().toLowerCase();
    const found = ACTIONS.filter(
      ({ label, enabled, id }) =>
        id !== "palette" && label.toLowerCase().includes(wanted) && enabled?.(context.studio) !== false,
    );
    list.replaceChildren(
      ...found.map((one, i) =>
        h(
          "button",
          {
            class: "command",
            type: "button",
            role: "option",
            tabIndex: -1,
            "aria-selected": String(i === 0),
            onclick: () => {
              element.close();
              one.perform(context);
            },
          },
          one.icon ? icon(one.icon) : h("span", { class: "icon" }),
          h("span", {}, one.label),
          h("kbd", {}, shown(one.keys[0])),
        ),
      ),
    );
  };
  const element = dialog("palette-dialog", "Commands", search, list);
  return () => {
    search.value = "";
    show();
    element.showModal();
    search.focus();
  };
}

export function helpDialog() {
  const hints = new Map(TOOLS.map((tool) => [`tool-${tool.id}`, tool.hint]));
  const groups = [...new Set(ACTIONS.map(({ group }) => group))];
  const element = dialog(
    "help-dialog",
    "Keys and tools",
    h("p", { class: "muted" },
      "Paint stitches in the chart; its colours show what each will do, and the panel at the right what the whole cloth will do. The right mouse button paints the opposite stitch. The wheel zooms, Space and drag moves. With the chart focused, arrow keys move and Enter paints."),
    h("div", { class: "help-columns" },
      ...groups.map((group) =>
        h("section", {},
          h("h3", {}, group),
          h("dl", { class: "keys" },
            ...ACTIONS.filter((one) => one.group === group).flatMap((one) => [
              h("dt", {}, ...one.keys.slice(0, 2).map((key) => h("kbd", {}, shown(key)))),
              h("dd", {}, one.label, hints.has(one.id) && h("span", { class: "muted" }, ` – ${hints.get(one.id)}`)),
            ]))))),
  );
  return () => element.showModal();
}
