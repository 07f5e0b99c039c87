/**
 * What to do with the selection: clipboard, patterns, repeats, regions.
 *
 * @import {Studio} from "../state/studio.js"
 */

import { thousands } from "../core/format.js";
import { byHand, withKey } from "../core/pointing.js";
import { actionsOf } from "./action.js";
import { Clip, Floating } from "../design/floating.js";
import { MAX_ITEMS, MAX_MOTIF } from "../design/design.js";
import { motifText } from "../grid/grid.js";
import { ownInk } from "../design/shelf.js";
import { selectedCells, selectionOf } from "../design/selection.js";
import { move, placeRepeat, stamp } from "../tools/tools.js";
import { nextRegionColour } from "../state/palette.js";

const action = actionsOf("Selection");

/** @param {Studio} studio */
const some = ({ selection }) => selection.value !== null;

/** @param {Studio} studio */
function copyPart({ document, editing, selection }) {
  if (!selection.value) return;
  editing.clip = Clip.of(document, selection.value);
  // For other programs, too, where the browser allows it.
  void navigator.clipboard?.writeText(editing.clip.text).catch(() => {});
}

/** @param {Studio} studio @param {string} label */
function clearPart({ document, selection }, label) {
  if (!selection.value) return;
  document.set(
    selectedCells(selection.value, document.grid).map((i) => [i, 0]),
    label,
  );
}

/** The selected box as a motif, if it is small enough for one. @param {Studio} studio */
function selectedMotif(studio) {
  const box = studio.selection.value;
  if (!box) return null;
  const part = studio.document.grid.region(box);
  if (motifText(part).length > MAX_MOTIF) {
    studio.tell(`A pattern has at most ${thousands(MAX_MOTIF)} stitches; select fewer.`);
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

export const SELECTION = [
  action(
    "select-all",
    "Select all",
    ["Mod+A"],
    { icon: "select" },
    ({ studio: { document, selection } }) => (selection.value = selectionOf(document.outline, document.grid)),
  ),
  action(
    "deselect",
    "Select nothing",
    ["Escape"],
    { icon: "close", enabled: some },
    ({ studio }) => (studio.selection.value = null),
  ),
  action("invert", "Select the rest", ["Mod+Shift+I"], { enabled: some }, ({ studio: { document, selection } }) => {
    const rest = document.outline.slice();
    if (selection.value) for (const i of selectedCells(selection.value, document.grid)) rest[i] = 0;
    selection.value = selectionOf(rest, document.grid);
  }),
  action("copy", "Copy", ["Mod+C"], { icon: "copy", enabled: some }, ({ studio }) => {
    copyPart(studio);
    studio.tell(byHand("Copied. Paste (Mod+V) puts it at the pointer.", "Copied. Paste puts it in the chart."));
  }),
  action("cut", "Cut", ["Mod+X"], { icon: "cut", enabled: some }, ({ studio }) => {
    copyPart(studio);
    clearPart(studio, "Cut");
  }),
  // The browser's own paste event brings it, or what another program has copied.
  action("paste", "Paste at the pointer", ["Mod+V"], { icon: "paste", native: true }, ({ studio, view }) => {
    const { document, editing, selection } = studio;
    const { clip } = editing;
    if (!clip) {
      studio.tell(`${withKey("Nothing is copied yet: select stitches, then copy them", "Mod+C")}.`);
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
    const others = document.others.entries;
    document.set(clip.at(grid, place), "Paste", "stitches", clip.stitchesAt(grid, place));
    editing.hold(new Floating(clip, place, under, others));
    studio.tool.value = move;
  }),
  action("clear", "Turn it into knits", ["Delete", "Backspace"], { icon: "trash", enabled: some }, ({ studio }) =>
    clearPart(studio, "Clear"),
  ),
  action(
    "keep-pattern",
    "Keep as a pattern on the shelf",
    ["Shift+S"],
    { icon: "stamp", enabled: some },
    ({ studio }) => {
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
  ),
  action(
    "make-repeat",
    "Make it a linked repeat",
    ["Shift+P"],
    { icon: "repeat", enabled: some },
    ({ studio, open }) => {
      const box = studio.selection.value;
      const motif = selectedMotif(studio);
      if (!box || !motif || !hasRoom(studio, "repeats", "linked repeats")) return;
      const { document, editing } = studio;
      const place = { row: box.row0, column: box.column0, rows: motif.rows, columns: motif.columns };
      const name = `Repeat ${document.repeats.length + 1}`;
      editing.repeatId.value = document.addRepeat({ name, motif, placements: [place] });
      studio.selection.value = null;
      studio.tool.value = placeRepeat;
      open("repeats");
      studio.tell(`${name}: drag to place copies. Paint one, and all follow.`);
    },
  ),
  action("make-region", "Make it a region", ["Shift+G"], { icon: "regions", enabled: some }, ({ studio, open }) => {
    const { document, selection } = studio;
    if (!selection.value || !hasRoom(studio, "regions", "regions")) return;
    const look = { name: `Region ${document.regions.length + 1}`, colour: nextRegionColour(document.regions) };
    document.addRegion(look, selectedCells(selection.value, document.grid));
    selection.value = null;
    open("regions");
  }),
  action(
    "cut-outline",
    "Cut the outline to the selection",
    [],
    { icon: "cut", enabled: some },
    ({ studio: { document, selection } }) => {
      if (!selection.value) return;
      const kept = new Set(selectedCells(selection.value, document.grid));
      document.set(
        Array.from(document.outline, (_, i) => [i, kept.has(i) ? 1 : 0]),
        "Outline",
        "outline",
      );
    },
  ),
  action(
    "full-outline",
    "Make the outline a full rectangle",
    [],
    { group: "Edit", enabled: ({ document }) => document.shaped },
    ({ studio: { document } }) =>
      void document.set(
        Array.from(document.outline, (_, i) => [i, 1]),
        "Outline",
        "outline",
      ),
  ),
];
