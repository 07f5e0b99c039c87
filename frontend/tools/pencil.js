import { line, thick } from "../core/raster.js";

/** @type {import("./tool.js").Tool} */
export const pencil = {
  id: "pencil",
  label: "Pencil",
  icon: "pencil",
  key: "b",
  hint: "Draw freely; [ and ] change its size",
  mode: "stroke",
  sized: true,
  cells: ({ previous, current }, { size }) => thick(line(previous, current), size),
};
