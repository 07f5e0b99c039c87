/**
 * What colours mean: a bar for a quantity, a key for kinds.
 *
 * @import {ScaleLegend, SwatchLegend} from "../state/overlays.js"
 */

import { figure, percent } from "../core/format.js";
import { h } from "../elements/dom.js";

/** @param {SwatchLegend | ScaleLegend} content @returns {HTMLElement[]} */
export const legendOf = (content) =>
  content.kind === "scale" ? scale(content) : content.items.map(({ label, colour }) => keyOf(label, colour));

/** @param {string} label @param {string} colour */
function keyOf(label, colour) {
  const key = h("span", { class: "key" });
  key.style.background = colour;
  return h("span", { class: "legend-item gap-5" }, key, label);
}

/** @param {ScaleLegend} scale */
function scale({ map, low, high, unit, log, label, limit = high }) {
  const gradient = h("span", { class: "gradient" });
  const colours = Array.from({ length: 33 }, (_, i) => map.css(i / 32));
  gradient.style.backgroundImage = `linear-gradient(to right, ${colours})`;
  const passed = limit < high;
  if (passed) {
    const line = h("span", { class: "limit" });
    line.style.left = percent((limit - low) / (high - low)).replace(" ", "");
    gradient.append(line);
  }
  return [
    h("span", {}, label),
    h("span", { class: "figures" }, figure(low, 2)),
    gradient,
    h("span", { class: "figures" }, `${figure(high, 2)}${unit ? ` ${unit}` : ""}`),
    passed && h("span", { class: "figures" }, `limit ${figure(limit, 2)}`),
    log && h("span", { class: "muted" }, "log"),
  ].filter((part) => part instanceof HTMLElement);
}
