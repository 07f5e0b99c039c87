/**
 * What a design can become.
 *
 * @import {Extensions} from "../../types.js"
 *
 * @typedef {"worked" | "finish" | "machine" | "dial" | "from" | "note" | "tex" | "price"} Option
 * @typedef {{to: string, name: string, note: string, group: string, options: Option[], text?: boolean}} ExportKind
 */

import { thousands } from "../../core/format.js";

/** Whether a picture of the cloth goes into a file. @param {string} to */
export const isPattern = (to) => to.startsWith("pattern");

/**
 * Why a chart cannot become a file of a kind; "" where it can.
 *
 * @param {string} to
 * @param {{shaped: boolean, stitches: number}} chart
 * @param {Extensions["largest_exports"]} largest stitches that a kind can have, where not any number
 */
export function hindrance(to, { shaped, stitches }, largest) {
  if (shaped && ["knitspeak", "text"].includes(to)) return "holds no outline: rectangular charts only";
  const most = largest[to] ?? Infinity;
  return stitches > most ? `at most ${thousands(most)} stitches` : "";
}

/** The formats that extensions add. @param {Extensions["extensions"]} extensions @returns {ExportKind[]} */
export function ofExtensions(extensions) {
  return extensions
    .filter(({ group, problem }) => group === "knitcore.exporters" && problem === null)
    .flatMap(({ offers, package: from }) =>
      kinds(
        "From extensions",
        offers.map((to) => [to, to, `added by ${from}`, PAPER]),
      ),
    );
}

/** What can be said about a file on paper. @type {Option[]} */
const PAPER = ["worked", "note", "tex"];

/** What can be said about a plan for a home machine. @type {Option[]} */
const HOME = ["machine", "dial", "from", "tex", "price"];

/**
 * A group's formats: each by its name for the service, name and note on the page, options, and whether
 * it is text that can be read here.
 *
 * @param {string} group
 * @param {[to: string, name: string, note: string, options: Option[], text?: boolean][]} formats
 * @returns {ExportKind[]}
 */
const kinds = (group, formats) =>
  formats.map(([to, name, note, options, text]) => ({ to, name, note, group, options, text }));

export const KINDS = [
  ...kinds("To knit by hand", [
    [
      "pattern",
      "Pattern to knit from",
      "PDF: the 3D view as it is now, materials, gauge, parts, written rows, finishing, evidence, chart",
      PAPER,
    ],
    ["pattern-svg", "The same, as SVG", "one long page", PAPER],
    ["written", "Written rows", "as knitters write them, with shaping and colours", ["worked"], true],
    ["pdf", "Chart to print", "PDF with key, row numbers, repeat and notes", PAPER],
    ["svg", "Chart as a drawing", "SVG", PAPER, true],
    ["knitspeak", "KnitSpeak", "for Stitch Maps and other tools; rectangular charts only", ["worked"], true],
  ]),
  ...kinds("For a machine", [
    [
      "knitout",
      "Knitout",
      "for your machine; knitted on a virtual one first",
      ["machine", "dial", "finish", "from", "tex", "price"],
      true,
    ],
  ]),
  ...kinds("For a home machine", [
    ["hand-plan", "Plan by the row", "PDF: what to latch up, transfer or turn, and on which needles", HOME],
    ["hand-plan-text", "The same, as text", "to be read on a phone", HOME, true],
    ["ayab", "Picture for AYAB", "two colours of knits, or a guide for work by hand; up to 200 needles", ["machine"]],
    ["punch-card", "Punch card", "PDF at true size, 24 stitches", ["machine"]],
    ["punch-card-text", "Punch card, as text", "x for a hole", ["machine"], true],
  ]),
  ...kinds("Data and files", [
    ["report", "Report", "PDF: numbers with intervals, maps, curves, assumptions, chart", PAPER],
    ["design", "Project file", "everything in this design, to open again", ["note"], true],
    ["png", "Picture", "one pixel per stitch; purls are dark, cells without a stitch transparent", []],
    ["text", "Lines of K and P", "rectangular charts only", [], true],
    ["csv", "Values of every stitch", "CSV", [], true],
    ["vtu", "Mesh for ParaView", "VTU", []],
    ["glb", "Loops in 3D", "glTF", []],
    ["stl", "Loops to print in 3D", "STL", []],
  ]),
];
