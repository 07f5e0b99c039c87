/**
 * Stress against strain: the four fabrics of the material, and the stretch test with the step on show.
 *
 * @import {Studio} from "../studio.js"
 * @import {Plotly, Trace} from "./plotly.js"
 */

import { FABRICS } from "../core/segments.js";
import { loadPlotly } from "./plotly.js";

/**
 * @param {HTMLElement} host
 * @param {Studio} studio
 * @returns {() => void} draws anew
 */
export function curvePlot(host, studio) {
  /** @type {Plotly | null} */
  let plotly = null;
  let drawn = false;
  let width = 0;
  let height = 0;

  const draw = async () => {
    try {
      if (!plotly) {
        host.classList.add("loading");
        plotly = await loadPlotly();
      }
    } catch {
      host.dataset.problem = "The plot could not be loaded. It is tried again with the next stretch.";
      return;
    } finally {
      host.classList.remove("loading");
    }
    delete host.dataset.problem;
    if (host.hidden || !host.clientWidth) return;
    ({ clientWidth: width, clientHeight: height } = host);
    await plotly.react(host, traces(studio), layout(width, height), {
      displayModeBar: false,
      responsive: false,
    });
    drawn = true;
  };
  const redraw = () => {
    if (!host.hidden) void draw();
  };
  studio.stretch.listen(redraw);
  studio.material.listen(redraw);
  studio.step.listen(() => {
    const stretch = studio.stretch.value.value;
    if (host.hidden || !drawn || !plotly || !stretch) return;
    const { step } = studio;
    void plotly.restyle(
      host,
      { x: [[100 * stretch.strain[step.value]]], y: [[stretch.stress_n_per_mm[step.value]]] },
      [FABRICS.length + 1],
    );
  });
  new ResizeObserver(() => {
    if (drawn && (host.clientWidth !== width || host.clientHeight !== height)) redraw();
  }).observe(host);
  return redraw;
}

/**
 * @param {Studio} studio
 * @returns {Trace[]}
 */
function traces(studio) {
  const style = getComputedStyle(document.documentElement);
  const { value: stretch, direction, stale } = studio.stretch.value;
  const accent = style.getPropertyValue("--accent").trim();
  const end = stretch ? 1.35 * Math.max(...stretch.strain) : 0.6;
  /** @type {Trace[]} */
  const result = FABRICS.map((fabric) => {
    const curve = studio.material.value?.curves[fabric]?.[direction];
    const kept = (curve?.strain ?? []).filter((strain) => strain <= end).length;
    return {
      name: fabric,
      x: (curve?.strain ?? []).slice(0, kept).map((strain) => 100 * strain),
      y: (curve?.stress_n_per_mm ?? []).slice(0, kept),
      mode: "lines",
      line: { color: style.getPropertyValue(`--${fabric}`).trim(), width: 1.6 },
      hovertemplate: `%{x:.0f} %, %{y:.3g} N/mm<extra>${fabric}</extra>`,
    };
  });
  const step = studio.step.value;
  result.push(
    {
      name: stale ? "before the change" : "this chart",
      x: stretch?.strain.map((strain) => 100 * strain) ?? [],
      y: stretch?.stress_n_per_mm ?? [],
      mode: "lines",
      line: { color: accent, width: 3, dash: stale ? "dot" : "solid" },
      hovertemplate: "%{x:.0f} %, %{y:.3g} N/mm<extra>this chart</extra>",
    },
    {
      name: "step",
      x: stretch ? [100 * stretch.strain[step]] : [],
      y: stretch ? [stretch.stress_n_per_mm[step]] : [],
      mode: "markers",
      showlegend: false,
      hoverinfo: "skip",
      marker: {
        color: style.getPropertyValue("--panel").trim(),
        size: 11,
        line: { color: accent, width: 3 },
      },
    },
  );
  return result;
}

/**
 * @param {number} width
 * @param {number} height
 */
function layout(width, height) {
  const style = getComputedStyle(document.documentElement);
  const text = style.getPropertyValue("--text").trim();
  const line = style.getPropertyValue("--line").trim();
  const axis = {
    gridcolor: line,
    zerolinecolor: line,
    linecolor: line,
    rangemode: "nonnegative",
    tickfont: { size: 13 },
    fixedrange: true,
  };
  return {
    width,
    height,
    margin: { l: 56, r: 10, t: 8, b: 42 },
    paper_bgcolor: "transparent",
    plot_bgcolor: "transparent",
    font: { family: "system-ui, sans-serif", size: 13, color: text },
    showlegend: false,
    hovermode: "closest",
    xaxis: { ...axis, title: { text: "Strain (%)", standoff: 6, font: { size: 13 } }, nticks: 6 },
    yaxis: { ...axis, title: { text: "Stress (N/mm)", standoff: 8, font: { size: 13 } }, nticks: 5 },
  };
}
