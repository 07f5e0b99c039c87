/**
 * plotly, loaded when the first plot needs it, and the page has nothing better to do.
 *
 * @typedef {Record<string, unknown>} Trace
 * @typedef {object} Plotly
 * @property {(host: HTMLElement, traces: Trace[], layout: object, config: object) => Promise<void>} react
 * @property {(host: HTMLElement, update: object, traces: number[]) => Promise<void>} restyle
 */

import { idle, nextTask } from "../dom.js";

/** @type {Promise<Plotly> | null} */
let loading = null;

const CONFIG = { displayModeBar: false, responsive: false };

/** @returns {Promise<Plotly>} */
export function loadPlotly() {
  loading ??= load();
  return loading;
}

/**
 * Draw a plot, or draw it anew.
 *
 * @param {HTMLElement} host
 * @param {Trace[]} traces
 * @param {object} layout
 */
export async function drawPlot(host, traces, layout) {
  const plotly = await loadPlotly();
  if (!host.classList.contains("js-plotly-plot")) {
    await plotly.react(host, [], layout, CONFIG); // the axes first: all at once would be one long task
    await nextTask();
  }
  await plotly.react(host, traces, layout, CONFIG);
}

async function load() {
  await idle();
  const script = document.createElement("script");
  script.src = "/static/plotly.min.js";
  document.head.append(script);
  try {
    await new Promise((resolve, reject) => Object.assign(script, { onload: resolve, onerror: reject }));
  } catch {
    loading = null; // try again next time
    throw new Error("plotly could not be loaded.");
  }
  await nextTask(); // the first plot is not part of the long task that evaluates it
  return /** @type {{Plotly: Plotly}} */ (/** @type {unknown} */ (window)).Plotly;
}
