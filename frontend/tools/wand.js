import { flood } from "../grid/raster.js";

/** @type {import("./tool.js").Tool} */
export const wand = {
  id: "wand",
  label: "Wand",
  icon: "wand",
  key: "W",
  hint: "Select a connected area of one fabric; Shift adds, Alt takes away, both intersect",
  mode: "select",
  spans: ({ current: [row, column] }, context) =>
    context.grid.has(row, column) ? flood(context.grid, looks(context, true), [row, column]) : [],
};

/**
 * What distinguishes stitches: knit or purl or, by fabric, their surroundings; or that there is none.
 *
 * @param {import("./tool.js").ToolContext} context
 * @param {boolean} byFabric
 */
export function looks({ grid, codes, outline }, byFabric) {
  const values = byFabric ? codes : grid.purl;
  return outline.includes(0) ? values.map((value, i) => (outline[i] ? value : 255)) : values;
}
