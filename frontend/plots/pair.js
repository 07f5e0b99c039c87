/**
 * Two stress–strain curves with their 90 % intervals.
 *
 * @import {CurveResult} from "../types.js"
 * @import {Trace} from "./plotly.js"
 */

import { stressStrainLayout } from "./curve.js";
import { themedReader } from "../state/palette.js";
import { drawPlot } from "./plotly.js";

/**
 * @param {HTMLElement} host
 * @param {{name: string, colour: string, curve: CurveResult}[]} curves colour: name of a custom property
 */
export async function drawPair(host, curves) {
  const read = themedReader();
  const end = Math.max(...curves.map(({ curve }) => 100 * Math.max(...curve.strain)));
  const traces = curves.flatMap(({ name, colour: property, curve }, k) => {
    const colour = read(`--${property}`);
    const percent = (/** @type {number[]} */ strain) => strain.map((value) => Math.min(100 * value, 1.15 * end));
    const stress = curve.stress_n_per_mm;
    return /** @type {Trace[]} */ ([
      {
        name: `${name}, 90 % interval`,
        x: [...percent(curve.strain_interval[0]), ...percent(curve.strain_interval[1]).toReversed()],
        y: [...stress, ...stress.toReversed()],
        mode: "lines",
        fill: "toself",
        fillcolor: `${colour}2e`, // #rrggbbaa
        line: { width: 0 },
        hoverinfo: "skip",
      },
      {
        name,
        x: percent(curve.strain),
        y: stress,
        mode: "lines",
        line: { color: colour, width: 2.5, dash: k ? "dash" : "solid" }, // the first is seen below a like one
        hovertemplate: `%{x:.0f} %, %{y:.3g} N/mm<extra>${name}</extra>`,
      },
    ]);
  });
  await drawPlot(host, traces, stressStrainLayout(host.clientWidth, host.clientHeight));
}
