/**
 * What a strip test says beside its curve: where it runs out of stretch; its steps as a table.
 *
 * @import {StretchResult} from "../types.js"
 */

import { figure, percent, spread } from "./format.js";

/**
 * Where the tightest stitches run out of stretch, or how near they come.
 *
 * @param {Pick<StretchResult, "strain" | "force_n" | "force_interval_n" | "first_taut" | "tightest">} test
 */
export function lockUpInWords({ strain, force_n, force_interval_n, first_taut: taut, tightest }) {
  if (!taut)
    return tightest > 0 ? `No stitch runs out of stretch: the tightest has used ${percent(tightest)} of it.` : "";
  const after = Math.max(
    0,
    strain.findIndex((value) => value >= taut.strain),
  );
  const [low, high] = force_interval_n.map((ends) => (ends[after] / force_n[after]) * taut.force_n);
  const known = spread([low, high]);
  return `The tightest stitches run out of stretch at ${percent(taut.strain)} (${figure(taut.force_n)} N${known.wide ? `, which may be ${known.text}` : ""}).`;
}

/** Values of stitches by those of the blocks that were taken for one. @type {WeakMap<number[], number[]>} */
const AT_STITCHES = new WeakMap();

/**
 * Values of all stitches, row by row from the bottom, from those of a test's stitches or blocks.
 *
 * @param {Pick<StretchResult, "rows" | "columns" | "block">} test
 * @param {number[]} values
 */
export function atStitches({ rows, columns, block }, values) {
  if (!(block > 1)) return values; // a test that the service has kept since before there were blocks has none
  let all = AT_STITCHES.get(values);
  if (!all) {
    const [up, across] = [rows, columns].map((count) => Math.ceil(count / block));
    all = Array.from({ length: rows * columns }, (_, i) => {
      const [row, column] = [Math.floor(i / columns), i % columns];
      return values[Math.floor((row * up) / rows) * across + Math.floor((column * across) / columns)];
    });
    AT_STITCHES.set(values, all);
  }
  return all;
}

/**
 * All steps with their 90 % intervals, as CSV for a spreadsheet.
 *
 * @param {Pick<StretchResult, "strain" | "force_n" | "force_interval_n" | "stress_n_per_mm" | "waist_strain" | "waist_strain_interval">} test
 */
export function table(test) {
  const columns = {
    strain: test.strain,
    force_n: test.force_n,
    force_low_n: test.force_interval_n[0],
    force_high_n: test.force_interval_n[1],
    stress_n_per_mm: test.stress_n_per_mm,
    waist_strain: test.waist_strain,
    waist_strain_low: test.waist_strain_interval[0],
    waist_strain_high: test.waist_strain_interval[1],
  };
  const rows = test.strain.map((_, k) => Object.values(columns).map((values) => values[k]));
  return [Object.keys(columns), ...rows].map((row) => `${row.join(",")}\n`).join("");
}
