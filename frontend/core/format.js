/** Numbers for people: three significant figures, a unit beside each. */

/** How many, or how much to a tenth: 8,866 stitches. @param {number} number */
export const thousands = (number) => number.toLocaleString("en", { maximumFractionDigits: 1 });

/** @param {number | null | undefined} value @param {number} [digits] significant figures */
export function figure(value, digits = 3) {
  if (value === null || value === undefined || !Number.isFinite(value)) return "–";
  if (value === 0) return "0";
  const magnitude = Math.floor(Math.log10(Math.abs(Number(value.toPrecision(digits)))));
  const decimals = Math.min(6, Math.max(0, digits - 1 - magnitude));
  return (Math.abs(value) < 999.5 ? value.toFixed(decimals) : thousands(Math.round(value))).replace("-", "−");
}

/** Between the ends of an interval: a dash beside a minus would be a second one. @param {readonly (number | undefined)[]} ends */
const upTo = (ends) => (ends.some((end) => end !== undefined && end < 0) ? " to " : " – ");

/** Both ends with as many decimals as the larger one needs. @param {readonly number[] | null | undefined} interval */
export function range(interval) {
  if (!interval || !interval.every(Number.isFinite)) return "";
  const [low, high] = interval;
  return `${figure(low, 2)}${upTo(interval)}${figure(high, 2)}`;
}

/** An interval of which one end is more than this times the other says no more than that it is wide. */
const WIDE = 3;

/**
 * An interval by its ends; one that is too wide to be of use as numbers, in words.
 *
 * @param {readonly number[]} interval
 * @returns {{text: string, wide: boolean}}
 */
export function spread([low, high]) {
  const times = high / low;
  if (!(low > 0) || times <= WIDE) return { text: range([low, high]), wide: false };
  const either = Math.sqrt(times);
  return { text: `up to ${either.toFixed(either < 3 ? 1 : 0)} times less or more`, wide: true };
}

/**
 * The ends of a share's interval in percent; "" if not known.
 *
 * @param {readonly (number | undefined)[]} ends
 * @param {number} [decimals]
 */
export function percentRange(ends, decimals = 0) {
  return ends.map((end) => (end === undefined ? "" : percent(end, decimals).slice(0, -2))).join(upTo(ends));
}

/** A sentence in which no line ends between the ends of an interval, or before their "%". @param {string} sentence */
export const unbroken = (sentence) => sentence.replace(/ (?=– |%)|(?<=–) /g, "\u00a0");

/** @param {number} share @param {number} [decimals] */
export function percent(share, decimals = 0) {
  return `${(100 * share).toFixed(decimals).replace("-", "−")} %`;
}

/**
 * Shares of a whole in percent that add up to 100: the largest remainders are rounded up.
 *
 * @param {readonly number[]} shares
 * @returns {string[]}
 */
export function percents(shares) {
  const whole = shares.map((share) => Math.floor(100 * share + 1e-9));
  const missing =
    Math.round(100 * shares.reduce((sum, share) => sum + share, 0)) - whole.reduce((sum, n) => sum + n, 0);
  const rest = (/** @type {number} */ i) => 100 * shares[i] - whole[i];
  const up = new Set([...shares.keys()].sort((a, b) => rest(b) - rest(a)).slice(0, missing));
  return shares.map((share, i) => {
    const rounded = whole[i] + (up.has(i) ? 1 : 0);
    return share > 0 && rounded === 0 ? "< 1 %" : `${rounded} %`;
  });
}
