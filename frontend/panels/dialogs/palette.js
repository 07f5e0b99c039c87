/**
 * Every tool and command, yarn, pattern and colouring, found by its name.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {Studio} from "../../studio.js"
 * @import {IconName} from "../../icons.js"
 *
 * @typedef {{label: string, words: string, icon?: IconName, key?: string, perform: () => void}} Entry
 */

import { ACTIONS, shown } from "../../actions/registry.js";
import { OVERLAYS } from "../../studio/overlays.js";
import { h } from "../../dom.js";
import { icon } from "../../icons.js";
import { dialog } from "../../widgets/dialog.js";

/** Search words that an action's name does not contain. @type {Record<string, string>} */
const WORDS = {
  garments: "measure measurements pressure glove sock sleeve brace plan",
  "open-find": "pressure search target stretch stiffness",
  "open-fill": "target wish stiffness softer stiffer relax region",
  "open-atlas": "repeats patterns",
  stretch: "pull test force load",
  versions: "history",
  yarns: "material own test files measure fit add",
  compare: "difference side by side versions regions yarns",
  exports: "print pdf knitout written download save",
};

/**
 * @param {ActionContext} context
 * @returns {Entry[]}
 */
function entries(context) {
  const { studio } = context;
  const patterns = studio.shelf.value.filter(({ repeat }) => repeat);
  return [
    ...ACTIONS.filter(({ id, enabled }) => id !== "palette" && enabled?.(studio) !== false).map((one) => ({
      label: one.label,
      words: WORDS[one.id] ?? "",
      icon: one.icon,
      key: one.keys[0],
      perform: () => one.perform(context),
    })),
    ...OVERLAYS.filter((overlay) => overlay.available(studio)).map((overlay) => ({
      label: `Colour the chart by: ${overlay.label.toLowerCase()}`,
      words: "colours show",
      perform: () => (studio.overlay.value = overlay),
    })),
    ...patterns.map((ink) => ({
      label: `Paint with ${ink.name}`,
      words: "pattern rib",
      perform: () => (studio.ink.value = ink),
    })),
    ...studio.materials.value
      .filter(({ fabrics }) => Object.keys(fabrics).length === 4)
      .map(({ id, name }) => ({
        label: `Yarn: ${name}`,
        words: "material",
        icon: /** @type {IconName} */ ("yarn"),
        perform: () => (studio.materialId.value = id),
      })),
  ];
}

/** @param {Studio} _studio @param {ActionContext} context */
export function create(_studio, context) {
  const nothing = h("p", { class: "muted command-none", role: "status" });
  const list = h("div", { class: "command-list", role: "listbox", "aria-label": "Commands" });
  const search = h("input", {
    type: "text",
    id: "command-search",
    class: "command-search",
    placeholder: "Find a tool, command, yarn, pattern or colouring",
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
      } else if (event.key === "Enter") {
        event.preventDefault(); // otherwise it would press whatever has the focus after closing
        items[at]?.click();
      }
    },
  });
  const show = () => {
    const wanted = search.value.trim().toLowerCase();
    const all = entries(context);
    const named = all.filter(({ label }) => label.toLowerCase().includes(wanted));
    const meant = wanted ? all.filter((one) => !named.includes(one) && one.words.includes(wanted)) : [];
    const found = [...named, ...meant];
    nothing.textContent = found.length ? "" : "Nothing of that name. Try a tool, a yarn, a pattern or a colouring.";
    list.replaceChildren(
      ...found.map((one, i) =>
        h(
          "button",
          {
            class: "command",
            role: "option",
            tabIndex: -1,
            "aria-selected": String(i === 0),
            onclick: () => {
              element.close();
              one.perform();
            },
          },
          one.icon ? icon(one.icon) : h("span", { class: "icon" }),
          h("span", {}, one.label),
          one.key && h("kbd", {}, shown(one.key)),
        ),
      ),
    );
  };
  const element = dialog("palette-dialog", "Commands", search, nothing, list);
  return () => {
    search.value = "";
    show();
    element.showModal();
    search.focus();
  };
}
