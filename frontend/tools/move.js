/** @type {import("./tool.js").Tool} */
export const move = {
  id: "move",
  label: "Move",
  icon: "move",
  key: "Shift+M",
  hint: "Drag the selected stitches elsewhere, or push them with the arrow keys; Alt leaves a copy behind",
  mode: "move",
  spans: () => [],
};
