/**
 * Borders between panels that can be dragged, or moved with the arrow keys.
 */

import { loadSettings, saveSettings } from "../design/store.js";

/**
 * @param {HTMLElement} handle
 * @param {"--side-width" | "--inspector-height"} property
 * @param {{axis: "x" | "y", least: number, size: () => number, most: () => number}} options
 */
export function split(handle, property, { axis, least, size, most }) {
  const root = document.documentElement;
  const stored = /** @type {Record<string, number>} */ (loadSettings({}))[property];
  const tell = () => {
    handle.setAttribute("aria-valuemin", String(least));
    handle.setAttribute("aria-valuemax", String(Math.max(least, most())));
    handle.setAttribute("aria-valuenow", String(Math.round(size())));
  };
  /** @param {number} pixels */
  const set = (pixels) => {
    const value = Math.round(Math.max(least, Math.min(most(), pixels)));
    root.style.setProperty(property, `${value}px`);
    tell();
    return value;
  };
  if (Number.isFinite(stored)) set(stored);
  else tell();

  handle.addEventListener("pointerdown", (event) => {
    handle.setPointerCapture(event.pointerId);
    const begin = axis === "x" ? event.clientX : event.clientY;
    const before = size();
    root.dataset.resizing = "";
    /** @param {PointerEvent} moved */
    const move = (moved) => set(before + begin - (axis === "x" ? moved.clientX : moved.clientY));
    handle.addEventListener("pointermove", move);
    handle.addEventListener(
      "lostpointercapture",
      () => {
        handle.removeEventListener("pointermove", move);
        delete root.dataset.resizing;
        saveSettings({ [property]: size() });
      },
      { once: true },
    );
  });
  handle.addEventListener("keydown", ({ key }) => {
    const larger = axis === "x" ? "ArrowLeft" : "ArrowUp";
    const smaller = axis === "x" ? "ArrowRight" : "ArrowDown";
    if (key !== larger && key !== smaller) return;
    saveSettings({ [property]: set(size() + (key === larger ? 24 : -24)) });
  });
}
