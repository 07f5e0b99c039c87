/**
 * Colours of the canvas, taken from the style sheet, so that both themes have one source.
 *
 * @typedef {object} Palette
 * @property {string} text
 * @property {string} muted
 * @property {string} accent
 * @property {string} pane
 * @property {string} even
 * @property {string} odd
 * @property {number[]} knit colour of a knit: red, green, blue
 * @property {number[]} purl
 * @property {number[][]} fabrics by phase
 * @property {boolean} dark
 */

/** @returns {Palette} */
export function readPalette() {
  const style = getComputedStyle(document.documentElement);
  /** @param {string} name */
  const read = (name) => style.getPropertyValue(name).trim();
  return {
    text: read("--text"),
    muted: read("--muted"),
    accent: read("--accent"),
    pane: read("--pane"),
    even: read("--even"),
    odd: read("--odd"),
    knit: channels(read("--knit")),
    purl: channels(read("--purl")),
    fabrics: ["--stockinette", "--garter", "--rib", "--seed"].map((name) => channels(read(name))),
    dark: read("color-scheme") === "dark",
  };
}

/**
 * @param {string} hex #rrggbb
 * @returns {number[]}
 */
export function channels(hex) {
  const value = Number.parseInt(hex.slice(1), 16);
  return [(value >> 16) & 255, (value >> 8) & 255, value & 255];
}

/**
 * Bytes of an opaque pixel, as ImageData has them on little-endian machines.
 *
 * @param {number[]} rgb
 * @param {number} [shade] factor on all channels
 */
export function pixel([red, green, blue], shade = 1) {
  return (
    ((255 << 24) | (Math.round(blue * shade) << 16) | (Math.round(green * shade) << 8) | Math.round(red * shade)) >>> 0
  );
}

/** Perceived lightness of a pixel, 0 to 1. @param {number} value */
export function lightness(value) {
  const red = value & 255;
  const green = (value >> 8) & 255;
  const blue = (value >> 16) & 255;
  return (0.299 * red + 0.587 * green + 0.114 * blue) / 255;
}

/** For regions: apart from the fabrics' colours, and from each other also for the colour-blind. */
export const REGION_COLOURS = ["#c2185b", "#b58900", "#00838f", "#6d4c41", "#0072b2", "#d55e00", "#7f7f7f", "#009e73"];

/** The one that is used least. @param {readonly {colour: string}[]} regions */
export function nextRegionColour(regions) {
  const used = REGION_COLOURS.map((colour) => regions.filter((region) => region.colour === colour).length);
  return REGION_COLOURS[used.indexOf(Math.min(...used))];
}
