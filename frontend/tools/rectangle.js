import { rectangle as filled } from "../grid/raster.js";

/** @type {import("./tool.js").Tool} */
export const rectangle = {
  id: "rectangle",
  label: "Rectangle",
  icon: "rectangle",
  key: "R",
  hint: "Drag a filled rectangle; paint a panel with a pattern",
  mode: "shape",
  spans: ({ start, current }) => filled(start, current),
};
