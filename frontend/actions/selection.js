/**
 * What to do with the selection: clipboard, patterns, repeats, regions.
 *
 * @import {Action} from "./action.js"
 * @import {Studio} from "../state/studio.js"
 */

import { Clip, Floating } from "../design/floating.js";
import { MAX_ITEMS, MAX_MOTIF } from "../design/design.js";
import { motifText } from "../grid/motif.js";
import { ownInk } from "../design/shelf.js";
import { selectedCells, selectionOf } from "../design/selection.js";
import { move } from "../tools/move.js";
import { repeat as placeTool } from "../tools/repeat.js";
import { stamp } from "../tools/stamp.js";
import { nextRegionColour } from "../state/palette.js";

const group = "Selection";

/** @param {Studio} studio */
const some = ({ selection }) => selection.value !== null;

/** @param {Studio} studio */
function copyPart({ document, editing, selection }) {
  if (!selection.value) return;
  editing.clip = Clip.of(document.grid, selection.value);
  // For other programs, too, where the browser allows it.
  void navigator.clipboard?.writeText(editing.clip.part.text).catch(() => {});
}

/** @param {Studio} studio @param {string} label */
function clearPart({ document, selection }, label) {
  if (!selection.value) return;
  document.set(
    selectedCells(selection.value, document.grid).map((i) => [i, 0]),
    label,
  );
}

/** @type {Action} */
const selectAll = {
  id: "select-all",
  label: "Select all",
  group,
  icon: "select",
  keys: ["Mod+A"],
  perform: ({ studio: { document, selection } }) => (selection.value = selectionOf(document.outline, document.grid)),
};

/** @type {Action} */
const deselect = {
  id: "deselect",
  label: "Select nothing",
  group,
  icon: "close",
  keys: ["Escape"],
  enabled: some,
  perform: ({ studio }) => (studio.selection.value = null),
};

/** @type {Action} */
const invert = {
  id: "invert",
  label: "Select the rest",
  group,
  keys: ["Mod+Shift+I"],
  enabled: some,
  perform: ({ studio: { document, selection } }) => {
    const rest = document.outline.slice();
    if (selection.value) for (const i of selectedCells(selection.value, document.grid)) rest[i] = 0;
    selection.value = selectionOf(rest, document.grid);
  },
};

/** @type {Action} */
const copy = {
  id: "copy",
  label: "Copy",
  group,
  icon: "copy",
  keys: ["Mod+C"],
  enabled: some,
  perform: ({ studio }) => {
    copyPart(studio);
    studio.tell("Copied. Paste (Ctrl+V) puts it at the pointer.");
  },
};

/** @type {Action} */
const cut = {
  id: "cut",
  label: "Cut",
  group,
  icon: "cut",
  keys: ["Mod+X"],
  enabled: some,
  perform: ({ studio }) => {
    copyPart(studio);
    clearPart(studio, "Cut");
  },
};

/** @type {Action} */
export const paste = {
  id: "paste",
  label: "Paste at the pointer",
  group,
  icon: "paste",
  keys: ["Mod+V"],
  // The browser's own paste event brings it, or what another program has copied.
  native: true,
  perform: ({ studio, view }) => {
    const { document, editing, selection } = studio;
    const { clip } = editing;
    if (!clip) {
      studio.tell("Nothing is copied yet: select stitches, then copy them (Ctrl+C).");
      return;
    }
    const { grid } = document;
    const corner = selection.value && /** @type {const} */ ([selection.value.row0, selection.value.column0]);
    const [row, column] = view.hover.value ?? corner ?? [0, 0];
    /** @type {[number, number]} */
    const place = [
      Math.max(0, Math.min(row, grid.rows - clip.part.rows)),
      Math.max(0, Math.min(column, grid.columns - clip.part.columns)),
    ];
    const under = grid.purl.slice();
    document.set(clip.at(grid, place), "Paste");
    editing.hold(new Floating(clip, place, under));
    studio.tool.value = move;
  },
};

/** @type {Action} */
const clear = {
  id: "clear",
  label: "Turn it into knits",
  group,
  icon: "trash",
  keys: ["Delete", "Backspace"],
  enabled: some,
  perform: ({ studio }) => clearPart(studio, "Clear"),
};

/**
 * The selected box as a motif, if it is small enough for one.
 *
 * @param {Studio} studio
 */
function selectedMotif(studio) {
  const box = studio.selection.value;
  if (!box) return null;
  const part = studio.document.grid.region(box);
  if (motifText(part).length > MAX_MOTIF) {
    studio.tell(`A pattern has at most ${MAX_MOTIF.toLocaleString("en")} stitches; select fewer.`);
    return null;
  }
  return part;
}

/**
 * Whether a list of the design can take one more.
 *
 * @param {Studio} studio
 * @param {"regions" | "repeats" | "shelf"} list
 * @param {string} what
 */
export function hasRoom(studio, list, what) {
  const room = studio.document[list].length < MAX_ITEMS;
  if (!room) studio.tell(`A design has at most ${MAX_ITEMS} ${what}; remove some first.`);
  return room;
}

/** @type {Action} */
const pattern = {
  id: "keep-pattern",
  label: "Keep as a pattern on the shelf",
  group,
  icon: "stamp",
  keys: ["Shift+S"],
  enabled: some,
  perform: ({ studio }) => {
    const part = selectedMotif(studio);
    if (!part || !hasRoom(studio, "shelf", "own patterns")) return;
    const { document } = studio;
    const motif = motifText(part);
    const known = document.shelf.find((item) => item.motif === motif);
    const name = known?.name ?? `Mine ${document.shelf.length + 1}`;
    if (!known) document.changeShelf([...document.shelf, { name, motif }], "Keep a pattern");
    studio.ink.value = ownInk({ name, motif });
    studio.tool.value = stamp;
    studio.selection.value = null;
    studio.tell(`${name} is on the shelf. Click to stamp it, or paint with it.`);
  },
};

/** @type {Action} */
export const makeRepeat = {
  id: "make-repeat",
  label: "Make it a linked repeat",
  group,
  icon: "repeat",
  keys: ["Shift+P"],
  enabled: some,
  perform: ({ studio, open }) => {
    const box = studio.selection.value;
    const motif = selectedMotif(studio);
    if (!box || !motif || !hasRoom(studio, "repeats", "linked repeats")) return;
    const { document, editing } = studio;
    const place = { row: box.row0, column: box.column0, rows: motif.rows, columns: motif.columns };
    const name = `Repeat ${document.repeats.length + 1}`;
    editing.repeatId.value = document.addRepeat({ name, motif, placements: [place] });
    studio.selection.value = null;
    studio.tool.value = placeTool;
    open("repeats");
    studio.tell(`${name}: drag to place copies. Paint one, and all follow.`);
  },
};

/** @type {Action} */
export const makeRegion = {
  id: "make-region",
  label: "Make it a region",
  group,
  icon: "regions",
  keys: ["Shift+G"],
  enabled: some,
  perform: ({ studio, open }) => {
    const { document, selection } = studio;
    if (!selection.value || !hasRoom(studio, "regions", "regions")) return;
    const look = { name: `Region ${document.regions.length + 1}`, colour: nextRegionColour(document.regions) };
    document.addRegion(look, selectedCells(selection.value, document.grid));
    selection.value = null;
    open("regions");
  },
};

/** @type {Action} */
const cutOutline = {
  id: "cut-outline",
  label: "Cut the outline to the selection",
  group,
  icon: "cut",
  keys: [],
  enabled: some,
  perform: ({ studio: { document, selection } }) => {
    if (!selection.value) return;
    const kept = new Set(selectedCells(selection.value, document.grid));
    document.set(
      Array.from(document.outline, (_, i) => [i, kept.has(i) ? 1 : 0]),
      "Outline",
      "outline",
    );
  },
};

/** @type {Action} */
const fullOutline = {
  id: "full-outline",
  label: "Make the outline a full rectangle",
  group: "Edit",
  keys: [],
  enabled: ({ document }) => document.shaped,
  perform: ({ studio: { document } }) =>
    void document.set(
      Array.from(document.outline, (_, i) => [i, 1]),
      "Outline",
      "outline",
    ),
};

/** @type {Action[]} */
export const SELECTION = [
  selectAll,
  deselect,
  invert,
  copy,
  cut,
  paste,
  clear,
  pattern,
  makeRepeat,
  makeRegion,
  cutOutline,
  fullOutline,
];
