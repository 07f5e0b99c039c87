/**
 * One row as it hangs on the needles.
 *
 * @import {Symbols} from "../../state/editing.js"
 * @import {KnitAlongResult} from "../../types.js"
 */

import { signOf } from "../../chart/symbols.js";
import { drawing } from "../../elements/dom.js";
import { isOther, kindOf } from "../../grid/kinds.js";

/** Least and greatest width of a stitch, and its least height, px. */
const CELL = [14, 44];
const HIGH = 30;
/** Room for a number, px. */
const NAME = 34;
/** Stitches or needles between two numbers. */
const NUMBERED = 5;

/** Black or white, whichever is seen better on a colour. @param {string} colour `#rrggbb` */
function inkOn(colour) {
  const [red, green, blue] = [1, 3, 5].map((at) => parseInt(colour.slice(at, at + 2), 16));
  return 0.299 * red + 0.587 * green + 0.114 * blue > 140 ? "#1c1a18" : "#ffffff";
}

/**
 * What stands in a stitch.
 *
 * @param {Symbols} symbols
 * @param {boolean} purl
 * @param {number} x @param {number} y of its centre
 * @param {number} size of the stitch
 */
function sign(symbols, purl, x, y, size) {
  const reach = size * 0.27;
  if (symbols === "japanese" && !purl) return `M${x} ${y - reach}V${y + reach}`;
  if (!purl) return "";
  return symbols === "dots" ? `M${x} ${y}h0.01` : `M${x - reach} ${y}H${x + reach}`;
}

/**
 * The symbol of a stitch that is neither knit nor purl: its strokes, and its dots.
 *
 * @param {Symbols} symbols
 * @param {string} code
 * @param {number} x left edge
 * @param {number} width of a cell @param {number} height
 */
function signs(symbols, code, x, width, height) {
  const top = (height - width) / 2;
  const at = (/** @type {[number, number]} */ [px, py]) => `${x + px * width} ${top + (1 - py) * width}`;
  const { strokes, dots } = signOf(code, symbols);
  return [strokes.map((points) => `M${points.map(at).join("L")}`), dots.map((dot) => `M${at(dot)}h0.01`)];
}

/** Stitches that are neither knit nor purl, and where they begin. @param {readonly string[]} codes */
function* others(codes) {
  let column = 0;
  for (const code of codes) {
    if (isOther(code)) yield /** @type {const} */ ([column, code]);
    column += isOther(code) ? kindOf(code).width : 1;
  }
}

/**
 * @param {KnitAlongResult} along
 * @param {number} row its number, from 0
 * @param {Symbols} symbols
 * @param {number} room px across
 */
export function rowPicture({ rows, yarns, needles, marked }, row, symbols, room) {
  const { stitches, first, leftwards, yarns: stretches, heading, codes } = rows[row];
  const onMachine = needles.length > 0;
  const count = stitches.length;
  const cell = Math.round(Math.min(Math.max(room / count, CELL[0]), CELL[1]) * 10) / 10;
  const high = Math.max(cell, HIGH);
  const [width, height] = [count * cell, high + 20];
  const purls = [...stitches].filter((stitch) => stitch === "P").length;
  const placed = [...others(codes ?? [])]; // rows that this browser kept long ago have none
  const special = placed.length ? `, ${placed.length} of other kinds` : "";
  const { plot, add } = drawing({
    width,
    height,
    viewBox: `0 0 ${width} ${height}`,
    role: "img",
    "aria-label": `${count} stitches, ${purls} ${onMachine ? marked : "purls"}${special}. ${heading}`,
  });
  const colours = stretches.flatMap(([length, yarn]) => Array(length).fill(yarns[yarn].colour));
  for (let index = 0; index < count; index++) {
    const purl = stitches[index] === "P";
    const x = index * cell;
    const middle = x + cell / 2;
    const style = yarns.length > 1 ? `fill: ${colours[index]}; --ink: ${inkOn(colours[index])}` : "";
    add("rect", {
      x: x + 0.5,
      y: 0.5,
      width: cell - 1,
      height: high - 1,
      class: onMachine ? (purl ? "needle chosen" : "needle") : purl ? "purl" : "knit",
      style: onMachine && purl ? "" : style,
    });
    const drawn = onMachine ? "" : sign(symbols, purl, middle, high / 2, cell);
    if (drawn) {
      const thick = symbols === "dots" ? cell * 0.34 : Math.max(2, cell * 0.1);
      add("path", { d: drawn, class: "sign", style: `${style}; stroke-width: ${thick}; fill: none` });
    }
    const number = leftwards ? count - index : index + 1;
    const name = onMachine ? needles[first + index] : String(number);
    const at = Number(name.replace(/\D/g, ""));
    const edge = index === 0 || index === count - 1;
    const isFree = Math.min(index, count - 1 - index) * cell > NAME;
    if (edge || (at % NUMBERED === 0 && isFree)) {
      const anchor = index === 0 ? "start" : index === count - 1 ? "end" : "middle";
      const place = { start: x, end: x + cell, middle }[anchor];
      add("text", { x: place, y: high + 16, "text-anchor": anchor }, name);
    }
  }
  for (const [column, code] of placed) {
    const { width: columns, group } = kindOf(code);
    const box = { x: column * cell + 0.5, y: 0.5, width: columns * cell - 1, height: high - 1 };
    add("rect", { ...box, style: `fill: var(--${group})` });
    signs(symbols, code, column * cell, cell, high).forEach((paths, dots) => {
      const thick = dots ? cell * 0.22 : Math.max(2, cell * 0.1);
      add("path", { d: paths.join(""), class: "sign", style: `stroke-width: ${thick}; fill: none` });
    });
  }
  return plot;
}
