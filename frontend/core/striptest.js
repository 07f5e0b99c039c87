/**
 * What a strip test says beside its curve: where the first stitch locks; its steps as a table.
 *
 * @import {StretchResult} from "../types.js"
 *
 * @typedef {{strain: number[], force_n: number[], stitch_fields?: {utilisation?: number[][]}}} Test from
 *   small to large strains; it begins at rest
 */

/** Share of its stretch from which a stitch counts as taut. */
const TAUT = 0.95;

/**
 * Where the first stitch locks.
 *
 * @param {Test} test
 * @returns {{strain: number, force: number} | null} null if none does
 */
export function firstLock({ strain, force_n, stitch_fields }) {
  const used = stitch_fields?.utilisation?.map(most);
  const at = used && crossing(used, TAUT, strain);
  if (!used || at === null || at === undefined) return null;
  return { strain: at, force: /** @type {number} */ (crossing(used, TAUT, force_n)) };
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

/** @param {readonly number[]} values */
export const most = (values) => values.reduce((high, value) => Math.max(high, value), 0);

/**
 * Where values that begin at 0 first reach a level, on a scale that begins at 0, too.
 *
 * @param {readonly number[]} values
 * @param {number} level
 * @param {readonly number[]} scale
 */
function crossing(values, level, scale) {
  const after = values.findIndex((value) => value >= level);
  if (after < 0) return null;
  const [low, from] = after ? [values[after - 1], scale[after - 1]] : [0, 0];
  return from + ((scale[after] - from) * (level - low)) / (values[after] - low);
}
