/** @type {import("./tool.js").Tool} */
export const select = {
  id: "select",
  label: "Select",
  icon: "select",
  key: "m",
  hint: "Drag around stitches to see their numbers, copy them or change them together",
  mode: "select",
  cells: () => [],
};
