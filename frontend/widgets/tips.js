/**
 * What a button is called and its key, at once beside it: the words of its `title`, which browsers show only
 * after a second and never on touch screens.
 */

import { h } from "../elements/dom.js";

/** A finger that rests so long on a button wants to know what it is. */
const TOUCH_MS = 450;
const GAP_PX = 8;

export function tips() {
  const tip = h("div", { class: "tip small shadowed", popover: "manual", "aria-hidden": "true" });
  document.body.append(tip);
  /** @type {{element: HTMLElement, title: string} | null} */
  let shown = null;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  /** A button under the pointer may be given other words: *Stretch*, then *Give the test up*. */
  const renamed = new MutationObserver(() => {
    const element = shown?.element;
    if (!element?.title) return;
    hide();
    show(element);
  });

  const hide = () => {
    clearTimeout(timer);
    if (!shown) return;
    renamed.disconnect();
    if (!shown.element.title) shown.element.title = shown.title;
    shown = null;
    if (tip.matches(":popover-open")) tip.hidePopover();
  };
  /** @param {HTMLElement} element */
  const show = (element) => {
    if (shown?.element === element) return;
    hide();
    const { title } = element;
    if (!title || !element.isConnected || element.closest("[aria-haspopup][aria-expanded=true]")) return; // on the menu
    shown = { element, title };
    element.removeAttribute("title"); // the browser would show it, too
    const [head, ...more] = title.split("\n");
    const keyed = head.match(/^(.*) \(([^()]{1,14})\)$/);
    tip.replaceChildren(
      h("strong", {}, keyed ? keyed[1] : head),
      keyed ? h("kbd", {}, keyed[2]) : "",
      ...more.map((line) => h("span", {}, line)),
    );
    tip.showPopover();
    place(tip, element);
    renamed.observe(element, { attributeFilter: ["title"] });
  };

  /** @param {Event} event */
  const named = ({ target }) =>
    target instanceof Element ? /** @type {HTMLElement | null} */ (target.closest("[title]:not(iframe)")) : null;
  document.addEventListener("pointerover", (event) => {
    if (event.pointerType === "touch") return;
    const element = named(event);
    if (element) show(element);
    else if (shown && !(event.target instanceof Node && shown.element.contains(event.target))) hide();
  });
  document.addEventListener("pointerdown", (event) => {
    hide();
    const element = event.pointerType === "touch" ? named(event) : null;
    if (element) timer = setTimeout(() => show(element), TOUCH_MS);
  });
  document.addEventListener("pointerup", () => clearTimeout(timer));
  document.addEventListener("focusin", (event) => {
    const element = named(event);
    if (element?.matches(":focus-visible")) show(element);
  });
  for (const name of ["focusout", "keydown", "pointerleave", "blur", "scroll"]) {
    (name === "blur" ? window : document).addEventListener(name, hide, { capture: name === "scroll" });
  }
}

/**
 * Beside a tool of the rail, below anything else, and within the window.
 *
 * @param {HTMLElement} tip
 * @param {HTMLElement} element
 */
function place(tip, element) {
  const at = element.getBoundingClientRect();
  const { width, height } = tip.getBoundingClientRect();
  const beside = element.closest(".rail") !== null;
  const below = at.bottom + GAP_PX + height < innerHeight;
  const left = beside ? at.right + GAP_PX : at.left + (at.width - width) / 2;
  const top = beside ? at.top + (at.height - height) / 2 : below ? at.bottom + GAP_PX : at.top - GAP_PX - height;
  tip.style.left = `${Math.max(4, Math.min(left, innerWidth - width - 4))}px`;
  tip.style.top = `${Math.max(4, Math.min(top, innerHeight - height - 4))}px`;
}
