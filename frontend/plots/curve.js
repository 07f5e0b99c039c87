/**
 * Stress against strain: the four fabrics of the material, as points where they were measured, the
 * chart (or its part) with the interval that the service knows, and the stretch test with the step
 * on show.
 *
 * @import {Studio} from "../state/studio.js"
 * @import {CurveResult, StretchResult} from "../types.js"
 * @import {Plotly, Trace} from "./plotly.js"
 */

import { api } from "../api.js";
import { Belonging, clothOf } from "../services/belonging.js";
import { Latest } from "../services/latest.js";
import { paced } from "../core/paced.js";
import { FABRICS } from "../grid/segments.js";
import { scopeOf } from "../services/scope.js";
import { anyClothIn } from "../services/stitches.js";
import { themedReader } from "../state/palette.js";
import { drawPlot, loadPlotly, movePoint } from "./plotly.js";

/** Number of the trace that shows the step. */
const STEP = FABRICS.length + 3;
/** The service is asked this long after a change. */
const DELAY_MS = 300;

/** @param {HTMLElement} host @param {Studio} studio @returns {() => void} draws anew */
export function curvePlot(host, studio) {
  /** @type {Plotly | null} */
  let plotly = null;
  let drawn = false;
  let width = 0;
  let height = 0;
  /** @type {{key: string, curve: CurveResult} | null} */
  let answer = null;
  const belonging = new Belonging(studio, () => {
    return { ...clothOf(studio), direction: studio.seeing.pull.value };
  });
  belonging.marks(host, "curve");
  const latest = new Latest(DELAY_MS);

  const draw = async () => {
    try {
      if (!plotly) {
        host.dataset.words = "Loading the plot …";
        plotly = await loadPlotly();
      }
    } catch {
      host.dataset.words = "The plot could not be loaded. It is tried again with the next stretch.";
      return;
    }
    delete host.dataset.words;
    if (host.hidden || !host.clientWidth) return;
    ({ clientWidth: width, clientHeight: height } = host);
    await drawPlot(host, traces(studio, answer?.curve ?? null), stressStrainLayout(width, height));
    drawn = true;
  };
  const ask = () => {
    if (host.hidden) return;
    latest.run(
      async (signal) => {
        const body = { ...anyClothIn(studio, scopeOf(studio)), direction: studio.seeing.pull.value };
        const key = JSON.stringify(body);
        const { basis } = belonging;
        if (answer?.key !== key) {
          answer = { key, curve: await api.run("curve", body, signal) };
          void draw();
        }
        belonging.show(basis);
      },
      () => {
        answer = null; // the inspector's numbers say why
        belonging.clear();
        void draw();
      },
    );
  };
  // In a task of its own: drawing takes too long for the end of a stroke, which changes the test.
  const redraw = paced(() => {
    if (host.hidden) return;
    void draw();
    ask();
  }, 0);
  studio.stretch.listen(redraw);
  studio.material.listen(redraw);
  studio.seeing.pull.listen(redraw);
  studio.prediction.listen(({ busy }) => !busy && redraw());
  studio.step.listen(() => {
    const stretch = shownStretch(studio);
    if (host.hidden || !drawn || !plotly || !stretch) return;
    const { step } = studio;
    const place = { x: [100 * (stretch.strain[step.value] ?? 0)], y: [stretch.stress_n_per_mm[step.value] ?? 0] };
    void movePoint(host, STEP, place);
  });
  new ResizeObserver(() => {
    if (drawn && (host.clientWidth !== width || host.clientHeight !== height)) void draw();
  }).observe(host);
  return redraw;
}

/** The stretch test, if it is in the direction of the curves. @param {Studio} studio */
function shownStretch(studio) {
  const { value, direction } = studio.stretch.value;
  return direction === studio.seeing.pull.value ? value : null;
}

/** @param {Studio} studio @param {CurveResult | null} own @returns {Trace[]} */
function traces(studio, own) {
  const read = themedReader();
  /** @param {string} name */
  const colour = (name) => read(`--${name}`);
  const stretch = shownStretch(studio);
  const { stale } = studio.stretch.value;
  const { kind } = scopeOf(studio);
  const band = stressBand(stretch);
  const farthest = Math.max(...(stretch?.strain ?? [0]), own ? 0.6 * Math.max(...own.strain) : 0);
  const end = farthest ? 1.35 * farthest : 0.6;
  /** @param {number[]} strain @param {number[]} stress */
  const upTo = (strain, stress) => {
    const kept = strain.filter((value) => value <= end).length;
    return { x: strain.slice(0, kept).map((value) => 100 * value), y: stress.slice(0, kept) };
  };
  /** @type {Trace[]} */
  const result = FABRICS.map((fabric) => {
    const curve = studio.material.value?.curves[fabric]?.[studio.seeing.pull.value];
    return {
      name: fabric,
      ...upTo(curve?.strain ?? [], curve?.stress_n_per_mm ?? []),
      mode: "lines",
      line: { color: colour(fabric), width: 1.6 },
      hovertemplate: `%{x:.0f} %, %{y:.3g} N/mm<extra>${fabric}</extra>`,
    };
  });
  const stress = own?.stress_n_per_mm ?? [];
  const [low, high] = (own?.strain_interval ?? [[], []]).map((ends) => upTo(ends, stress));
  result.push(
    {
      name: "90 % interval",
      x: own ? [...low.x, ...high.x.toReversed()] : band.x,
      y: own ? [...low.y, ...high.y.toReversed()] : band.y,
      mode: "lines",
      fill: "toself",
      fillcolor: `${colour("accent")}2e`, // #rrggbbaa
      line: { width: 0 },
      hoverinfo: "skip",
    },
    {
      name: `this ${kind}`,
      ...upTo(own?.strain ?? [], stress),
      mode: "lines",
      line: { color: colour("accent"), width: 2, dash: "dash" },
      hovertemplate: `%{x:.0f} %, %{y:.3g} N/mm<extra>this ${kind}, sides free</extra>`,
    },
  );
  const step = studio.step.value;
  result.push(
    {
      name: stale ? "before the change" : "stretch test",
      x: stretch ? [0, ...stretch.strain.map((strain) => 100 * strain)] : [],
      y: stretch ? [0, ...stretch.stress_n_per_mm] : [],
      mode: "lines",
      line: { color: colour("accent"), width: stale ? 1.5 : 3, dash: stale ? "dot" : "solid" },
      opacity: stale ? 0.4 : 1,
      hovertemplate: "%{x:.0f} %, %{y:.3g} N/mm<extra>stretch test</extra>",
    },
    {
      name: "step",
      x: stretch ? [100 * (stretch.strain[step] ?? 0)] : [],
      y: stretch ? [stretch.stress_n_per_mm[step] ?? 0] : [],
      mode: "markers",
      showlegend: false,
      hoverinfo: "skip",
      marker: { color: colour("panel"), size: 11, line: { color: colour("accent"), width: 3 } },
    },
    ...FABRICS.map((fabric) => {
      const curve = studio.material.value?.measured?.[fabric]?.[studio.seeing.pull.value];
      const pulls = curve?.pulls === 1 ? "1 pull" : `median of ${curve?.pulls} pulls`;
      return {
        name: `${fabric}, measured`,
        ...upTo(curve?.strain ?? [], curve?.stress_n_per_mm ?? []),
        mode: "markers",
        marker: { color: colour("panel"), size: 5, line: { color: colour(fabric), width: 1.4 } },
        hovertemplate: `%{x:.0f} %, %{y:.3g} N/mm<extra>${fabric}, measured, ${pulls}</extra>`,
      };
    }),
  );
  return result;
}

/** The interval of the stretch test. @param {StretchResult | null} stretch */
function stressBand(stretch) {
  if (!stretch) return { x: [], y: [] };
  const { force_n: force, stress_n_per_mm: stress } = stretch;
  const strain = stretch.strain.map((fraction) => 100 * fraction);
  const [low, high] = stretch.force_interval_n.map((ends) => ends.map((end, i) => (end * stress[i]) / force[i]));
  return { x: [0, ...strain, ...strain.toReversed()], y: [0, ...low, ...high.toReversed()] };
}

/** @param {number} width @param {number} height */
export function stressStrainLayout(width, height) {
  const read = themedReader();
  const text = read("--text");
  const line = read("--line");
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
    xaxis: { ...axis, title: { text: "Stretch (%)", standoff: 6, font: { size: 13 } }, nticks: 6 },
    yaxis: { ...axis, title: { text: "Stress (N/mm)", standoff: 8, font: { size: 13 } }, nticks: 5 },
  };
}
