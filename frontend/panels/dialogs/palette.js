/**
 * Every tool and command, found by its name.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {Studio} from "../../studio.js"
 */

import { ACTIONS, shown } from "../../actions/registry.js";
import { h } from "../../dom.js";
import { icon } from "../../icons.js";
import { dialog } from "../../widgets/dialog.js";

/** @param {Studio} _studio @param {ActionContext} context */
export function create(_studio, context) {
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
      } else if (event.key === "Enter") {
        event.preventDefault(); // or it presses what has the focus once this is closed
        items[at]?.click();
      }
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
          one.keys[0] && h("kbd", {}, shown(one.keys[0])),
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
