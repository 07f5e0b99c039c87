import { rectangle } from "../grid/raster.js";

/** @type {import("./tool.js").Tool} */
export const select = {
  id: "select",
  label: "Select",
  icon: "select",
  key: "M",
  hint: "Drag a box around stitches to see their numbers or change them; Shift adds, Alt takes away",
  mode: "select",
  // A click alone selects nothing.
  spans: ({ start, current, path }) => (path.length > 1 ? rectangle(start, current) : []),
};
