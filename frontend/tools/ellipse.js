import { ellipse as filled } from "../grid/raster.js";

/** @type {import("./tool.js").Tool} */
export const ellipse = {
  id: "ellipse",
  label: "Ellipse",
  icon: "ellipse",
  key: "O",
  hint: "Drag a filled ellipse",
  mode: "shape",
  spans: ({ start, current }) => filled(start, current),
};
