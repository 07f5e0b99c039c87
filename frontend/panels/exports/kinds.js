/**
 * What a design can become.
 *
 * @import {Extensions} from "../../types.js"
 *
 * @typedef {"worked" | "finish" | "note" | "tex"} Option
 * @typedef {{to: string, name: string, note: string, group: string, options: Option[], text?: boolean}} ExportKind
 */

/** Whether a picture of the cloth goes into a file. @param {string} to */
export const isPattern = (to) => to.startsWith("pattern");

/** Stitches of the largest chart that the service makes solids, or programs, of. */
const MOST = { glb: 2500, stl: 2500, knitout: 20_000 };

/**
 * Why a chart cannot become a file of a kind; "" where it can.
 *
 * @param {string} to
 * @param {{shaped: boolean, stitches: number}} chart
 */
export function hindrance(to, { shaped, stitches }) {
  if (shaped && ["knitspeak", "text"].includes(to)) return "holds no outline: rectangular charts only";
  const most = MOST[/** @type {keyof typeof MOST} */ (to)] ?? Infinity;
  return stitches > most ? `at most ${most.toLocaleString("en")} stitches` : "";
}

/**
 * The formats that extensions add.
 *
 * @param {Extensions["extensions"]} extensions
 * @returns {ExportKind[]}
 */
export function ofExtensions(extensions) {
  return extensions
    .filter(({ group, problem }) => group === "knitcore.exporters" && problem === null)
    .flatMap(({ offers, package: from }) =>
      offers.map((to) => ({
        to,
        name: to,
        note: `added by ${from}`,
        group: "From extensions",
        options: ["worked", "note", "tex"],
      })),
    );
}

/** @type {ExportKind[]} */
export const KINDS = [
  {
    to: "pattern",
    name: "Pattern to knit from",
    note: "PDF: the 3D view as it is now, materials, gauge, parts, written rows, finishing, evidence, chart",
    group: "To knit by hand",
    options: ["worked", "note", "tex"],
  },
  {
    to: "pattern-svg",
    name: "The same as a drawing",
    note: "SVG, its pages one below the other",
    group: "To knit by hand",
    options: ["worked", "note", "tex"],
  },
  {
    to: "written",
    name: "Written rows",
    note: "as knitters write them, with shaping and colours",
    group: "To knit by hand",
    options: ["worked"],
    text: true,
  },
  {
    to: "pdf",
    name: "Chart to print",
    note: "PDF with key, row numbers, repeat and notes",
    group: "To knit by hand",
    options: ["worked", "note", "tex"],
  },
  {
    to: "svg",
    name: "Chart as a drawing",
    note: "SVG",
    group: "To knit by hand",
    options: ["worked", "note", "tex"],
    text: true,
  },
  {
    to: "knitspeak",
    name: "KnitSpeak",
    note: "for Stitch Maps and other tools; rectangular charts only",
    group: "To knit by hand",
    options: ["worked"],
    text: true,
  },
  {
    to: "knitout",
    name: "Knitout",
    note: "for a V-bed machine; knitted on a virtual one first",
    group: "For a machine",
    options: ["finish"],
    text: true,
  },
  {
    to: "report",
    name: "Report",
    note: "PDF: numbers with intervals, maps, curves, assumptions, chart",
    group: "To keep and to compute with",
    options: ["worked", "note", "tex"],
  },
  {
    to: "design",
    name: "Project file",
    note: "everything in this design, to open again",
    group: "To keep and to compute with",
    options: ["note"],
    text: true,
  },
  {
    to: "png",
    name: "Picture",
    note: "one pixel per stitch; purls are dark, cells without a stitch transparent",
    group: "To keep and to compute with",
    options: [],
  },
  {
    to: "text",
    name: "Lines of K and P",
    note: "rectangular charts only",
    group: "To keep and to compute with",
    options: [],
    text: true,
  },
  {
    to: "csv",
    name: "Values of every stitch",
    note: "CSV",
    group: "To keep and to compute with",
    options: [],
    text: true,
  },
  { to: "vtu", name: "Mesh for ParaView", note: "VTU", group: "To keep and to compute with", options: [] },
  { to: "glb", name: "Loops in 3D", note: "glTF", group: "To keep and to compute with", options: [] },
  { to: "stl", name: "Loops to print in 3D", note: "STL", group: "To keep and to compute with", options: [] },
];
