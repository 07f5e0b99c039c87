import { line as straight, thick } from "../grid/raster.js";

/** @type {import("./tool.js").Tool} */
export const line = {
  id: "line",
  label: "Line",
  icon: "line",
  key: "L",
  hint: "Drag a straight line; Shift keeps it level, upright or diagonal",
  mode: "shape",
  sized: true,
  spans: ({ start, current, constrain }, { size }) =>
    thick(straight(start, constrain ? constrained(start, current) : current), size),
};

/**
 * @param {import("../grid/raster.js").Cell} start
 * @param {import("../grid/raster.js").Cell} current
 * @returns {import("../grid/raster.js").Cell}
 */
function constrained(start, current) {
  const up = current[0] - start[0];
  const across = current[1] - start[1];
  if (Math.abs(up) > 2 * Math.abs(across)) return [current[0], start[1]];
  if (Math.abs(across) > 2 * Math.abs(up)) return [start[0], current[1]];
  const length = Math.max(Math.abs(up), Math.abs(across));
  return [start[0] + Math.sign(up) * length, start[1] + Math.sign(across) * length];
}
