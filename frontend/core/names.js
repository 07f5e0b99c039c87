/** Names as the service keeps them: one that is too long ends in an ellipsis, so that nothing is cut in silence. */

/** Most characters of a design's name, and of the name of anything in it. */
export const DESIGN_NAME = 200;
const NAME = 80;

/** @param {string} text @param {number} [most] characters @param {string} [ending] such as " (copy)" */
export function shortName(text, most = NAME, ending = "") {
  const whole = text.trim();
  const room = most - ending.length;
  return (whole.length > room ? `${whole.slice(0, room - 1).trimEnd()}…` : whole) + ending;
}
