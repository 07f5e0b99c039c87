import { actionsOf } from "./action.js";

const action = actionsOf("Edit");

export const undo = action(
  "undo",
  "Undo",
  ["Mod+Z"],
  { icon: "undo", enabled: ({ document }) => document.history.done.length > 0 },
  ({ studio }) => void studio.document.undo(),
);

export const redo = action(
  "redo",
  "Redo",
  ["Mod+Shift+Z", "Mod+Y"],
  { icon: "redo", enabled: ({ document }) => document.history.undone.length > 0 },
  ({ studio }) => void studio.document.redo(),
);
