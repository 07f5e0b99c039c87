/** The symbol of a stitch as an element, in the colour of the text. */

import { signOf } from "../chart/symbols.js";
import { svg } from "../elements/dom.js";
import { kindOf } from "../grid/kinds.js";

/** @param {string} code @param {import("../state/editing.js").Symbols} style */
export function signElement(code, style) {
  const { strokes, dots } = signOf(code, style);
  const d = strokes.map((points) => `M${points.map(([x, y]) => `${100 * x},${100 * (1 - y)}`).join("L")}`).join("");
  const circles = dots.map(([x, y]) => svg("circle", { cx: 100 * x, cy: 100 * (1 - y), r: 11 }));
  const { width } = kindOf(code);
  return svg(
    "svg",
    { viewBox: `0 0 ${100 * width} 100`, class: "sign", "aria-hidden": "true" },
    svg("path", { d }),
    ...circles,
  );
}
