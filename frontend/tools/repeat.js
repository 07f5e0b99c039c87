/** @type {import("./tool.js").Tool} */
export const repeat = {
  id: "repeat",
  label: "Place a repeat",
  icon: "repeat",
  key: "P",
  hint: "Drag out copies of a linked repeat, in whole motifs; edit one copy and all follow",
  mode: "place",
  spans: () => [],
};
