import { Grid } from "../grid/grid.js";

/** A repeatable random chart. @param {number} seed */
export function random(seed) {
  let state = seed * 2654435761;
  const next = () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
  const rows = 1 + Math.floor(9 * next());
  const columns = 1 + Math.floor(9 * next());
  return Grid.build(rows, columns, () => next() < 0.5);
}
