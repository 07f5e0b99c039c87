/**
 * Colours of the canvas, taken from the style sheet, so that both themes have one source.
 *
 * @import {Fabric} from "../types.js"
 *
 * @typedef {object} Palette
 * @property {string} text
 * @property {string} muted
 * @property {string} accent
 * @property {string} pane
 * @property {string} danger
 * @property {string} even
 * @property {string} odd
 * @property {number[]} knit colour of a knit: red, green, blue
 * @property {number[]} purl
 * @property {number[][]} fabrics by phase
 * @property {Record<Fabric, string>} written the same as #rrggbb
 * @property {Record<string, string>} groups grounds of stitches that are neither knit nor purl
 * @property {boolean} dark
 */

import { KIND_GROUPS } from "../grid/kinds.js";
import { FABRICS } from "../grid/segments.js";

const systemIsDark = () => matchMedia("(prefers-color-scheme: dark)");

/** Of both themes, once they were read: reading makes the browser work out the page's styles. @type {Map<boolean, Palette>} */
const known = new Map();

/** @returns {Palette} */
export function readPalette() {
  const dark = isDark();
  let colours = known.get(dark);
  if (!colours) known.set(dark, (colours = palette(dark)));
  return colours;
}

/** Whether the page is in its dark theme now. */
export function isDark() {
  return (document.documentElement.dataset.theme ?? (systemIsDark().matches ? "dark" : "light")) === "dark";
}

/** Call when that changes. @param {() => void} listener */
export function onTheme(listener) {
  systemIsDark().addEventListener("change", listener);
  new MutationObserver(listener).observe(document.documentElement, { attributeFilter: ["data-theme"] });
}

/** A reader of the style sheet's colours in the theme on show, by the name of their custom property. */
export function themedReader() {
  const style = getComputedStyle(document.documentElement);
  const dark = isDark();
  return (/** @type {string} */ name) => {
    const token = style.getPropertyValue(name).trim();
    const pair = /^light-dark\((.+?),\s*(.+)\)$/.exec(token);
    return pair ? pair[dark ? 2 : 1] : token;
  };
}

/** @param {boolean} dark @returns {Palette} */
function palette(dark) {
  const read = themedReader();
  const written = /** @type {Record<Fabric, string>} */ (
    Object.fromEntries(FABRICS.map((fabric) => [fabric, read(`--${fabric}`)]))
  );
  return {
    text: read("--text"),
    muted: read("--muted"),
    accent: read("--accent"),
    pane: read("--pane"),
    danger: read("--danger"),
    even: read("--even"),
    odd: read("--odd"),
    knit: channels(read("--knit")),
    purl: channels(read("--purl")),
    fabrics: FABRICS.map((fabric) => channels(written[fabric])),
    written,
    groups: Object.fromEntries(KIND_GROUPS.map((group) => [group, read(`--${group}`)])),
    dark,
  };
}

/** @param {string} hex #rrggbb @returns {number[]} */
function channels(hex) {
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
const REGION_COLOURS = ["#c2185b", "#b58900", "#00838f", "#6d4c41", "#0072b2", "#d55e00", "#7f7f7f", "#009e73"];

/** The one that is used least. @param {readonly {colour: string}[]} regions */
export function nextRegionColour(regions) {
  const used = REGION_COLOURS.map((colour) => regions.filter((region) => region.colour === colour).length);
  return REGION_COLOURS[used.indexOf(Math.min(...used))];
}
