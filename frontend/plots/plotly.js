/**
 * plotly, loaded when the first plot needs it.
 *
 * @typedef {Record<string, unknown>} Trace
 * @typedef {object} Plotly
 * @property {(host: HTMLElement, traces: Trace[], layout: object, config: object) => Promise<void>} react
 * @property {(host: HTMLElement, update: object, traces: number[]) => Promise<void>} restyle
 */

/** @type {Promise<Plotly> | null} */
let loading = null;

/** @returns {Promise<Plotly>} */
export function loadPlotly() {
  loading ??= new Promise((resolve, reject) => {
    const script = document.createElement("script");
    script.src = "/static/plotly.min.js";
    script.onload = () => resolve(/** @type {{Plotly: Plotly}} */ (/** @type {unknown} */ (window)).Plotly);
    script.onerror = () => {
      loading = null; // try again next time
      reject(new Error("plotly could not be loaded."));
    };
    document.head.append(script);
  });
  return loading;
}
