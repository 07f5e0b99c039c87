/** @import {Action} from "./action.js" */

import { Ink } from "../core/ink.js";
import { stamp } from "../tools/stamp.js";

const MAX_COPY = 100;

/** @type {Action} */
export const selectAll = {
  id: "select-all",
  label: "Select all",
  group: "Selection",
  icon: "select",
  keys: ["Mod+A"],
  perform: ({ studio }) => (studio.selection.value = studio.document.grid.box),
};

/** @type {Action} */
export const deselect = {
  id: "deselect",
  label: "Select nothing",
  group: "Selection",
  keys: ["Escape"],
  enabled: ({ selection }) => selection.value !== null,
  perform: ({ studio }) => (studio.selection.value = null),
};

/** @type {Action} */
export const copy = {
  id: "copy",
  label: "Copy as a pattern to paint with",
  group: "Selection",
  icon: "copy",
  keys: ["Mod+C"],
  enabled: ({ selection }) => selection.value !== null,
  perform: ({ studio }) => {
    const box = studio.selection.value;
    if (!box) return;
    const part = studio.document.grid.region(box);
    if (Math.max(part.rows, part.columns) > MAX_COPY) {
      studio.tell(`A pattern has at most ${MAX_COPY} × ${MAX_COPY} stitches; select fewer.`);
      return;
    }
    const own = studio.shelf.value.filter(({ id }) => id.startsWith("own-")).length + 1;
    const ink = new Ink(`own-${own}`, `Mine ${own}`, part, "Copied from this chart");
    studio.shelf.value = [...studio.shelf.value, ink];
    studio.ink.value = ink;
    studio.tool.value = stamp;
    studio.selection.value = null;
    studio.tell("Copied: it is on the shelf as a pattern. Click to stamp it, or paint with it.");
  },
};
