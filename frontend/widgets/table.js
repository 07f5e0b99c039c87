/**
 * Tables of figures.
 *
 * @import {Child} from "../elements/dom.js"
 */

import { h } from "../elements/dom.js";

/**
 * @param {Record<string, unknown>} properties
 * @param {Child[]} heads names of the columns
 * @param {HTMLTableSectionElement} body
 */
export const table = (properties, heads, body) =>
  h("table", properties, h("thead", {}, h("tr", {}, ...heads.map((head) => h("th", { scope: "col" }, head)))), body);

/** A row, by its name if it has one. @param {Child} name @param {...Child} cells */
export const tableRow = (name, ...cells) =>
  h("tr", {}, name !== null && h("th", { scope: "row" }, name), ...cells.map((cell) => h("td", {}, cell)));
