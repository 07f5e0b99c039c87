/**
 * A tour of two minutes: what each part of the page is for. Arrow keys go on and back,
 * Escape ends it.
 */

import { besides, byHand } from "../core/pointing.js";
import { saveSettings } from "../design/store.js";
import { h } from "../elements/dom.js";

/** @type {{at: string, title: string, text: string}[]} */
const STOPS = [
  {
    at: "#chart-host",
    title: "This is your cloth",
    text: `One cell is one stitch, seen from the face. ${besides("Drag to paint", "with the right button, the opposite")}. Knit beside purl makes soft joints, knit beside knit stiff ones: how they alternate is what you design with.`,
  },
  {
    at: "#rail",
    title: "Tools",
    text: byHand(
      "Pencil, shapes, fill, stamps and selections. Every tool has a letter; ? lists them all, and Mod+K finds any command by its name.",
      "Pencil, shapes, fill, stamps and selections.",
    ),
  },
  {
    at: "#shelf",
    title: "Patterns to paint with",
    text: "Choose rib, seed, basket or a pattern of your own, and paint or fill with it instead of single stitches.",
  },
  {
    at: "#overlays",
    title: "See the mechanics",
    text: "Colour the chart by fabric, by even and odd segments, by stiffness. The colours change while you paint, and the line below reads out the stitch under the pointer.",
  },
  {
    at: "#inspector",
    title: "The whole cloth in numbers",
    text: "How far it stretches along its rows and its columns and how large it is, with an interval and where the numbers come from, and your cloth among the four fabrics.",
  },
  {
    at: "#stretch",
    title: "Pull it",
    text: "Choose a direction and how far, and press Stretch. Then the slider takes you through the test: chart, curve and 3D move together.",
  },
  {
    at: "#fabric",
    title: "Turn it in your hands",
    text: byHand(
      "The loops in 3D: drag to turn, wheel to come closer, click a stitch to find it in the chart.",
      "The loops in 3D: drag to turn, spread two fingers to come closer, tap a stitch to find it in the chart.",
    ),
  },
  {
    at: "#designs-button",
    title: "Saved automatically",
    text: "Every stroke is saved, here and at the service. Your designs, their versions, examples to begin with and this tour are in this menu.",
  },
];

/** Makes the tour; returns what starts it. */
export function create() {
  let at = 0;
  const title = h("h2", { id: "tour-title" });
  const text = h("p", { id: "tour-text" });
  const place = h("span", { class: "muted figures" });
  const back = h("button", { class: "button", id: "tour-back", onclick: () => go(at - 1) }, "Back");
  const next = h("button", { class: "button primary", id: "tour-next", onclick: () => go(at + 1) }, "Next");
  const ring = h("div", { class: "tour-ring" });
  const box = h(
    "div",
    { class: "tour-box stack panelled shadowed gap-8" },
    title,
    text,
    h(
      "div",
      { class: "dialog-buttons" },
      place,
      h("span", { class: "spacer" }),
      h("button", { class: "button quiet", id: "tour-end", onclick: () => element.close() }, "End the tour"),
      back,
      next,
    ),
  );
  const element = h(
    "dialog",
    {
      class: "tour clipped",
      id: "tour",
      "aria-labelledby": "tour-title",
      "aria-describedby": "tour-text",
      onkeydown: (/** @type {KeyboardEvent} */ event) => {
        const step = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
        if (!step) return;
        event.preventDefault();
        go(at + step);
      },
      onclose: () => saveSettings({ tour: "seen" }),
    },
    ring,
    box,
  );
  document.body.append(element);
  window.addEventListener("resize", () => element.open && go(at));

  /** @param {number} stop */
  const go = (stop) => {
    if (stop >= STOPS.length) return element.close();
    at = Math.max(0, stop);
    const { at: selector, title: heading, text: words } = STOPS[at];
    title.textContent = heading;
    text.textContent = words;
    place.textContent = `${at + 1} of ${STOPS.length}`;
    back.disabled = at === 0;
    next.textContent = at === STOPS.length - 1 ? "Done" : "Next";
    const part = document.querySelector(selector);
    part?.scrollIntoView({ block: "nearest" });
    settle(part?.getBoundingClientRect() ?? new DOMRect(innerWidth / 2, innerHeight / 2, 0, 0));
    next.focus();
  };

  /** Put the ring around a part of the page, and the box beside it where there is most room. @param {DOMRect} part */
  const settle = (part) => {
    Object.assign(ring.style, {
      left: `${part.left}px`,
      top: `${part.top}px`,
      width: `${part.width}px`,
      height: `${part.height}px`,
    });
    const [width, height] = [box.offsetWidth, box.offsetHeight];
    const room = { right: innerWidth - part.right, left: part.left, below: innerHeight - part.bottom, above: part.top };
    /** @param {number} value @param {number} most */
    const within = (value, most) => `${Math.max(12, Math.min(most - 12, value))}px`;
    const beside = Math.max(room.right, room.left) > width + 24;
    const over = Math.max(room.below, room.above) > height + 24;
    let [x, y] = [part.left + (part.width - width) / 2, part.top + (part.height - height) / 2];
    if (over && (!beside || part.width > part.height))
      y = room.below > room.above ? part.bottom + 12 : part.top - height - 12;
    else if (beside) x = room.right > room.left ? part.right + 12 : part.left - width - 12;
    box.style.left = within(x, innerWidth - width);
    box.style.top = within(y, innerHeight - height);
  };

  return () => {
    element.showModal();
    go(0);
  };
}
