/**
 * Pressure along a limb: the range from axially free to fixed, within its 90 % interval, and the place
 * nearest to the lock-up.
 *
 * @import {LimbPlaceResult} from "../types.js"
 */

import { drawing } from "../elements/dom.js";

const WIDTH = 320;
const HEIGHT = 132;
const PAD = { left: 40, right: 8, top: 8, bottom: 34 };

/** @param {LimbPlaceResult[]} places along the limb */
export function pressurePlot(places) {
  const { plot, add } = drawing({
    viewBox: `0 0 ${WIDTH} ${HEIGHT}`,
    class: "pressure-plot full-width",
    role: "img",
    "aria-label": "Pressure along the limb, mmHg, with its 90 % interval",
  });
  const first = places[0].at_mm;
  const long = Math.max(places[places.length - 1].at_mm - first, 1e-9);
  const most = rounded(Math.max(1, ...places.map(({ mmhg_with_spread: ends }) => ends?.[1] ?? 0)));
  const bottom = HEIGHT - PAD.bottom;
  /** @param {number} at */
  const x = (at) => PAD.left + ((at - first) / long) * (WIDTH - PAD.left - PAD.right);
  /** @param {number} mmhg */
  const y = (mmhg) => bottom - (mmhg / most) * (bottom - PAD.top);
  for (const tick of [0, most / 2, most]) {
    add("line", { x1: PAD.left, x2: WIDTH - PAD.right, y1: y(tick), y2: y(tick), class: "grid-line" });
    add("text", { x: PAD.left - 5, y: y(tick) + 4, class: "tick end" }, String(tick));
  }
  for (const at of [first, first + long / 2, first + long]) {
    add("text", { x: x(at), y: bottom + 14, class: `tick ${at > first + long / 2 ? "end" : "middle"}` }, at.toFixed(0));
  }
  add("text", { x: x(first + long / 2), y: HEIGHT - 3, class: "axis middle" }, "mmHg along the limb (mm)");
  for (const name of /** @type {const} */ (["mmhg_with_spread", "mmhg"])) {
    const low = places.map((place) => `${x(place.at_mm)} ${y(place[name]?.[0] ?? 0)}`);
    const high = places.map((place) => `${x(place.at_mm)} ${y(place[name]?.[1] ?? 0)}`);
    add("path", { d: `M${[...low, ...high.reverse()].join("L")}z`, class: `pressure-band ${name}` });
  }
  const { at_mm: tightest } = places.reduce((a, b) => (b.lock_up_share > a.lock_up_share ? b : a));
  add("line", { x1: x(tightest), x2: x(tightest), y1: PAD.top, y2: bottom, class: "pressure-tightest" });
  return plot;
}

/** 1, 2 or 5 times a power of ten that is not less. @param {number} value */
function rounded(value) {
  const power = 10 ** Math.floor(Math.log10(value));
  return power * /** @type {number} */ ([1, 2, 5, 10].find((step) => step * power >= value));
}
