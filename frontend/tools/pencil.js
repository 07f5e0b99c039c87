import { line, thick } from "../grid/raster.js";

/** @type {import("./tool.js").Tool} */
export const pencil = {
  id: "pencil",
  label: "Pencil",
  icon: "pencil",
  key: "B",
  hint: "Draw freely; [ and ] change its size",
  mode: "stroke",
  sized: true,
  spans: ({ previous, current }, { size }) => thick(line(previous, current), size),
};
