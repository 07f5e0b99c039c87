/**
 * plotly, loaded when the first plot needs it, and the page has nothing better to do.
 *
 * @typedef {Record<string, unknown>} Trace
 * @typedef {object} Plotly
 * @property {(host: HTMLElement, traces: Trace[], layout: object, config: object) => Promise<void>} react
 * @property {(host: HTMLElement, frame: object, how: object) => Promise<void>} animate
 */

import { idle, nextTask } from "../elements/dom.js";

/** @type {Promise<Plotly> | null} */
let loading = null;

/** What a plot is to show, and its drawing while that is under way. @type {WeakMap<HTMLElement, [Trace[], object]>} */
const latest = new WeakMap();
/** @type {WeakMap<HTMLElement, Promise<void>>} */
const drawings = new WeakMap();

const CONFIG = { displayModeBar: false, responsive: false };

/** @returns {Promise<Plotly>} */
export function loadPlotly() {
  loading ??= load();
  return loading;
}

/** Draw a plot, or draw it anew. @param {HTMLElement} host @param {Trace[]} traces @param {object} layout */
export function drawPlot(host, traces, layout) {
  latest.set(host, [traces, layout]);
  let drawing = drawings.get(host);
  if (!drawing) drawings.set(host, (drawing = draw(host).finally(() => drawings.delete(host))));
  return drawing;
}

/** Draws what is wanted, in tasks of their own: the axes, half of the curves, all of them. @param {HTMLElement} host */
async function draw(host) {
  const plotly = await loadPlotly();
  let share = host.classList.contains("js-plotly-plot") ? 1 : 0;
  for (let shown; shown !== latest.get(host); share = Math.min(1, share + 0.5)) {
    await nextTask();
    const now = /** @type {[Trace[], object]} */ (latest.get(host));
    await plotly.react(host, now[0].slice(0, share * now[0].length), now[1], CONFIG);
    if (share === 1) shown = now;
  }
}

/**
 * Move a trace of one point; the rest is not drawn anew, which would take twice as long.
 *
 * @param {HTMLElement} host
 * @param {number} trace
 * @param {{x: number[], y: number[]}} place
 */
export async function movePoint(host, trace, place) {
  const plotly = await loadPlotly();
  const atOnce = { mode: "immediate", frame: { redraw: false, duration: 0 }, transition: { duration: 0 } };
  try {
    await plotly.animate(host, { data: [place], traces: [trace] }, atOnce);
  } catch (reason) {
    if (reason) throw reason; // without one, a newer move has taken its place
  }
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
