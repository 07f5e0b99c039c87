/** @type {import("./tool.js").Tool} */
export const stamp = {
  id: "stamp",
  label: "Stamp",
  icon: "stamp",
  key: "s",
  hint: "Put down one repeat of the pattern, its lower left corner here",
  mode: "shape",
  cells: ({ current: [row, column] }, { ink }) => {
    const { rows, columns } = ink.repeat ?? { rows: 1, columns: 1 };
    /** @type {import("../core/raster.js").Cell[]} */
    const cells = [];
    for (let r = 0; r < rows; r++) for (let c = 0; c < columns; c++) cells.push([row + r, column + c]);
    return cells;
  },
  origin: ({ current }) => current,
};
