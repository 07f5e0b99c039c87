import { flood } from "../grid/raster.js";
import { looks } from "./wand.js";

/** @type {import("./tool.js").Tool} */
export const fill = {
  id: "fill",
  label: "Fill",
  icon: "fill",
  key: "G",
  hint: "Fill connected like stitches; with Shift, a connected area of one fabric",
  mode: "once",
  spans: ({ start, constrain }, context) => flood(context.grid, looks(context, constrain), start),
};
