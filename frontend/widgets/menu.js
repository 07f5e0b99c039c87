/**
 * A button that opens a list of choices; arrow keys, Enter and Escape as in any menu.
 *
 * @import {Child} from "../elements/dom.js"
 *
 * @typedef {{id: string, content: Child, checked?: boolean, disabled?: boolean, perform: () => void}} Item
 */

import { h } from "../elements/dom.js";
import { icon } from "../elements/icons.js";

/** @param {{id: string, label: string, content: Child[], class: string, title?: string}} options `title` names it without words */
export function menu({ id, label, content, class: style, title }) {
  const list = h("div", {
    class: "menu raised shadowed",
    role: "menu",
    id: `${id}-menu`,
    popover: "auto",
    "aria-label": label,
    onkeydown: (/** @type {KeyboardEvent} */ event) => {
      const items = [...list.querySelectorAll("button:not(:disabled)")];
      const at = items.indexOf(/** @type {HTMLButtonElement} */ (document.activeElement));
      const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
      if (!step) return;
      event.preventDefault();
      const next = items[(at + step + items.length) % items.length];
      if (next instanceof HTMLElement) next.focus();
    },
    ontoggle: (/** @type {ToggleEvent} */ event) => {
      const open = event.newState === "open";
      button.setAttribute("aria-expanded", String(open));
      if (!open) return;
      const box = button.getBoundingClientRect();
      list.style.top = `${box.bottom + 6}px`;
      list.style.maxHeight = `${innerHeight - box.bottom - 14}px`;
      list.style.left = `${Math.max(8, Math.min(box.left, innerWidth - list.offsetWidth - 8))}px`;
      const first = list.querySelector("[aria-checked=true]") ?? list.querySelector("button");
      if (first instanceof HTMLElement) first.focus();
    },
  });
  const button = h(
    "button",
    {
      class: style,
      id: `${id}-button`,
      "aria-haspopup": "menu",
      "aria-expanded": "false",
      popoverTargetElement: list,
      title,
      "aria-label": title && label,
    },
    ...content,
  );
  const root = h("div", { class: "menu-root" }, button, list);

  /** @param {(Item | null)[]} items null is a line between them */
  const setItems = (items) => {
    list.replaceChildren(
      ...items.map((item) =>
        item === null
          ? h("hr", {})
          : h(
              "button",
              {
                class: "menu-item bare line full-width gap-6",
                id: item.id,
                role: item.checked === undefined ? "menuitem" : "menuitemradio",
                "aria-checked": item.checked === undefined ? undefined : String(item.checked),
                disabled: item.disabled,
                onclick: () => {
                  list.hidePopover();
                  button.focus();
                  item.perform();
                },
              },
              h("span", { class: "menu-tick" }, item.checked && icon("check")),
              item.content,
            ),
      ),
    );
  };
  return { root, setItems };
}
