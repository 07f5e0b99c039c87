import { ellipse as filled } from "../core/raster.js";

/** @type {import("./tool.js").Tool} */
export const ellipse = {
  id: "ellipse",
  label: "Ellipse",
  icon: "ellipse",
  key: "o",
  hint: "Drag a filled ellipse",
  mode: "shape",
  cells: ({ start, current }) => filled(start, current),
};
