/**
 * What is said of a file that cannot be imported.
 *
 * @import {Problem} from "../types.js"
 */

/** @param {string} detail @param {string} remedy @returns {Problem} */
export const refusal = (detail, remedy) => ({
  type: "input",
  title: "This chart cannot be imported",
  status: 422,
  detail,
  remedy,
});
