/**
 * Perceptually uniform colour maps: Fabio Crameri's scientific colour maps, version 8 (MIT licence,
 * doi:10.5281/zenodo.1243862), 33 stops each, interpolated between.
 */

/** batlow: dark blue to pale pink, for quantities that grow. */
const BATLOW =
  "011959 08255b 0d315d 0f3b5f 114360 134b61 175262 1b5962 226061 2b655e 356a59 " +
  "416f53 4d734d 5a7745 677b3e 747e38 828231 8f862d 9f892b af8d2e be9035 cd923f " +
  "db954b e7985a f19d6b f8a27e fca890 fdaea2 fdb4b4 fdbac4 fcbfd6 fbc6e8 faccfa";

/** vik: blue through white to red, for signed quantities. */
const VIK =
  "001261 021f69 022b71 023779 034481 055189 0c5e92 1c6d9c 307da6 488db2 619ebd " +
  "7aaec8 94bed2 adcddd c6dbe6 dee6e9 ece5e0 eedbd0 e9ccba e3bca5 dcac90 d69d7c " +
  "cf8e68 c98056 c37243 bd6431 b3531f a5400f 942f06 832106 741506 670a07 590008";

/** @typedef {{ at(t: number): [number, number, number], css(t: number): string }} ColourMap */

/**
 * The piece of a map between two places: a legend of what occurs.
 *
 * @param {ColourMap} map
 * @param {number} from
 * @param {number} to
 * @returns {ColourMap}
 */
export const part = (map, from, to) => ({
  at: (t) => map.at(from + t * (to - from)),
  css: (t) => map.css(from + t * (to - from)),
});

/** @param {string} stops @returns {ColourMap} */
function colourMap(stops) {
  const table = stops.split(" ").map((hex) => Number.parseInt(hex, 16));
  const last = table.length - 1;
  /** @type {ColourMap["at"]} */
  const at = (t) => {
    const x = Math.min(1, Math.max(0, Number.isFinite(t) ? t : 0)) * last;
    const i = Math.min(last - 1, Math.floor(x));
    const f = x - i;
    /** @param {number} shift */
    const mix = (shift) => Math.round(((table[i] >> shift) & 255) * (1 - f) + ((table[i + 1] >> shift) & 255) * f);
    return [mix(16), mix(8), mix(0)];
  };
  return { at, css: (t) => `rgb(${at(t).join(" ")})` };
}

export const batlow = colourMap(BATLOW);
/** Share of its stretch from which a stitch is taut. */
export const TAUT = 0.95;
const WARNING = /** @type {[number, number, number]} */ ([214, 30, 36]);
/** For the share of its stretch that a stitch has used: batlow up to orange, and a warning for what is taut. */
export const taut = {
  at: (/** @type {number} */ t) => (t >= TAUT ? WARNING : batlow.at(0.7 * t)),
  css: (/** @type {number} */ t) => `rgb(${taut.at(t).join(" ")})`,
};
export const vik = colourMap(VIK);
