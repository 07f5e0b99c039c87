/**
 * Directions of the cloth in knitters' words.
 *
 * @import {Direction} from "../types.js"
 */

/** What runs there. @type {Record<Direction, string>} */
export const LINES = { course: "rows", wale: "columns" };

/** @param {Direction} direction */
export const along = (direction) => `along the ${LINES[direction]}`;
