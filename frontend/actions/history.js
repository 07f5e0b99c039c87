/** @type {import("./action.js").Action} */
export const undo = {
  id: "undo",
  label: "Undo",
  group: "Edit",
  icon: "undo",
  keys: ["Mod+Z"],
  enabled: ({ document }) => document.history.done.length > 0,
  perform: ({ studio }) => void studio.document.undo(),
};

/** @type {import("./action.js").Action} */
export const redo = {
  id: "redo",
  label: "Redo",
  group: "Edit",
  icon: "redo",
  keys: ["Mod+Shift+Z", "Mod+Y"],
  enabled: ({ document }) => document.history.undone.length > 0,
  perform: ({ studio }) => void studio.document.redo(),
};
