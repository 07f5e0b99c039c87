/** @typedef {{steps: number[], room: [low: number, high: number]}} AxisOptions ticks within a decade; room in decades */

/** Ticks nearer to each other than this are too many, in pixels. */
const APART_PX = 40;

/**
 * A logarithmic axis, with room at both ends.
 *
 * @param {number[]} values positive
 * @param {number} from pixel of the low end
 * @param {number} to
 * @param {AxisOptions} options
 */
export function logAxis(values, from, to, { steps, room }) {
  const low = Math.log10(Math.min(...values)) - room[0];
  const high = Math.log10(Math.max(...values)) + room[1];
  const ticks = [];
  for (let power = Math.floor(low); power <= high; power++) {
    for (const step of steps) {
      const tick = Number((step * 10 ** power).toPrecision(2));
      if (Math.log10(tick) >= low && Math.log10(tick) <= high) ticks.push(tick);
    }
  }
  /** @param {number} value */
  const at = (value) => from + ((Math.log10(value) - low) / (high - low)) * (to - from);
  const crowded = ticks.length * APART_PX > Math.abs(to - from);
  return { at, ticks: crowded ? ticks.filter((tick) => Math.abs(Math.log10(tick) % 1) < 1e-6) : ticks };
}
