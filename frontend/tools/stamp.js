import { rectangle } from "../grid/raster.js";

/** @type {import("./tool.js").Tool} */
export const stamp = {
  id: "stamp",
  label: "Stamp",
  icon: "stamp",
  key: "S",
  hint: "Put down one repeat of the pattern, its lower left corner here",
  mode: "shape",
  spans: ({ current: [row, column] }, { ink }) => {
    const { rows, columns } = ink.repeat ?? { rows: 1, columns: 1 };
    return rectangle([row, column], [row + rows - 1, column + columns - 1]);
  },
  origin: ({ current }) => current,
};
