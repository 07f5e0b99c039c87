/**
 * What a strip test says beside its curve: how far a force pulls, and where the first stitch locks.
 *
 * @typedef {{strain: number[], force_n: number[], stitch_fields?: {utilisation?: number[][]}}} Test from
 *   small to large strains; it begins at rest
 */

/** Share of its stretch from which a stitch counts as taut. */
export const TAUT = 0.95;
/** A test that fell short is continued by at most this factor. */
const FURTHER = 1.8;

/**
 * The strain at which a test reaches a force.
 *
 * @param {Test} test
 * @param {number} newtons
 * @returns {number | null} null if it ends before that
 */
export const strainAt = ({ strain, force_n }, newtons) => crossing(force_n, newtons, strain);

/**
 * How far to pull in order to come to a force that a test fell short of: along its last slope, as fabric only
 * gets stiffer.
 *
 * @param {Test} test
 * @param {number} newtons
 */
export function further({ strain, force_n }, newtons) {
  const end = strain.length - 1;
  const slope = (force_n[end] - (force_n[end - 1] ?? 0)) / (strain[end] - (strain[end - 1] ?? 0));
  return Math.min(FURTHER * strain[end], strain[end] + (1.02 * (newtons - force_n[end])) / slope);
}

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
