import { flood } from "../core/raster.js";

/** @type {import("./tool.js").Tool} */
export const fill = {
  id: "fill",
  label: "Fill",
  icon: "fill",
  key: "g",
  hint: "Fill connected like stitches; with Shift, a connected area of one fabric",
  mode: "once",
  cells: ({ start, constrain }, { grid, codes }) => flood(grid, constrain ? codes : grid.purl, start),
};
