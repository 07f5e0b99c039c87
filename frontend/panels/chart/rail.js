/**
 * The tools at the left, brush size and symmetry, and the panels of the chart's parts.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {Studio} from "../../state/studio.js"
 */

import { SIZES } from "../../actions/look.js";
import { action } from "../../actions/registry.js";
import { h } from "../../elements/dom.js";
import { icon } from "../../elements/icons.js";
import { TOOLS } from "../../tools/tools.js";
import { actionButton } from "../../widgets/buttons.js";

/** What a tool is called, on screens that are wide enough. @param {string} text */
const words = (text) => h("span", { class: "tool-words nowrap clipped", "aria-hidden": "true" }, text);

/** Tools with longer names. @type {Record<string, string>} */
const SHORT = { repeat: "Repeat", pan: "Pan" };

const SYMMETRY_NAMES = { none: "off", across: "left and right", up: "top and bottom", both: "both ways" };

/** @param {HTMLElement} host @param {Studio} studio @param {ActionContext} context */
export function rail(host, studio, context) {
  const tools = TOOLS.map((tool) =>
    h(
      "button",
      {
        class: "tool relative rounded",
        id: `tool-${tool.id}`,
        title: `${tool.label} (${tool.key})\n${tool.hint}`,
        "aria-label": tool.label,
        "aria-keyshortcuts": tool.key,
        onclick: () => (studio.tool.value = tool),
      },
      icon(tool.icon),
      words(SHORT[tool.id] ?? tool.label),
    ),
  );
  studio.tool.watch((chosen) =>
    TOOLS.forEach((tool, i) => tools[i].setAttribute("aria-pressed", String(tool === chosen))),
  );

  const size = h("button", {
    class: "tool size relative rounded gap-2 small",
    id: "brush-size",
    onclick: () => {
      studio.size.value = SIZES[(SIZES.indexOf(studio.size.value) + 1) % SIZES.length];
    },
  });
  studio.size.watch((value) => {
    const dot = h("span", { class: "size-dot" });
    dot.style.width = dot.style.height = `${4 + 1.4 * value}px`;
    size.replaceChildren(dot, h("span", { class: "figures" }, value), words("Brush"));
    size.title = `Brush: ${value} × ${value} stitches ([ and ])`;
    size.setAttribute("aria-label", `Brush size ${value}; next size`);
  });
  studio.tool.watch(({ sized }) => (size.disabled = !sized));

  /** @param {string} id */
  const small = (id) => actionButton(action(id), context, "tool relative rounded");
  const symmetry = small("symmetry");
  studio.symmetry.watch((value) => {
    symmetry.setAttribute("aria-pressed", String(value !== "none"));
    symmetry.setAttribute("aria-label", `Symmetry: ${SYMMETRY_NAMES[value]}`);
    symmetry.title = `Symmetry: ${SYMMETRY_NAMES[value]} (Y)`;
    symmetry.replaceChildren(
      icon(value === "up" ? "flip" : "mirror"),
      value === "both" ? h("span", { class: "badge small" }, "2") : "",
      words("Symmetry"),
    );
  });

  /** @param {"stitches" | "regions" | "repeats"} name @param {"stitches" | "regions" | "link"} sign @param {string} label */
  const panel = (name, sign, label) => {
    const button = actionButton(
      action(name),
      context,
      "tool relative rounded",
      { id: `open-${name}` },
      icon(sign),
      words(label),
    );
    studio.editing.panel.watch((open) => button.setAttribute("aria-pressed", String(open === name)));
    return button;
  };

  host.append(
    ...tools,
    h("hr"),
    size,
    symmetry,
    h("hr"),
    panel("stitches", "stitches", "Stitches"),
    panel("regions", "regions", "Regions"),
    panel("repeats", "link", "Repeats"),
    actionButton(action("open-atlas"), context, "tool relative rounded", {}, words("Atlas")),
  );
}
