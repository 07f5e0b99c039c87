/**
 * Directions of the cloth in knitters' words.
 *
 * @import {Direction} from "../types.js"
 */

/** @type {readonly Direction[]} */
export const DIRECTIONS = ["course", "wale"];

/** What runs there. @type {Record<Direction, string>} */
export const LINES = { course: "rows", wale: "columns" };

/** @param {Direction} direction */
export const along = (direction) => `along the ${LINES[direction]}`;
