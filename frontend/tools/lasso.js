import { enclosed } from "../grid/raster.js";

/** @type {import("./tool.js").Tool} */
export const lasso = {
  id: "lasso",
  label: "Lasso",
  icon: "lasso",
  key: "Q",
  hint: "Draw around stitches to select them; Shift adds, Alt takes away, both intersect",
  mode: "select",
  spans: ({ path }) => (path.length > 2 ? enclosed(path) : []),
};
