/** @type {import("./tool.js").Tool} */
export const pan = {
  id: "pan",
  label: "Move view",
  icon: "hand",
  key: "H",
  hint: "Drag the chart about; Space does it with any tool, the wheel zooms",
  mode: "pan",
  spans: () => [],
};
