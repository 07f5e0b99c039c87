/**
 * Pulls of a stretch test: force per width against stretch.
 *
 * @import {PullResult} from "../types.js"
 */

import { drawing } from "../elements/dom.js";

const WIDTH = 260;
const HEIGHT = 150;
const PAD = { left: 44, right: 8, top: 8, bottom: 34 };

/** @param {PullResult[]} pulls @param {string} label */
export function pullsPlot(pulls, label) {
  const { plot, add } = drawing({
    viewBox: `0 0 ${WIDTH} ${HEIGHT}`,
    class: "pressure-plot pulls-plot",
    role: "img",
    "aria-label": label,
  });
  const far = Math.max(1e-9, ...pulls.flatMap(({ strain }) => strain));
  const most = Math.max(1e-9, ...pulls.flatMap(({ stress_n_per_mm: stress }) => stress));
  const bottom = HEIGHT - PAD.bottom;
  /** @param {number} strain */
  const x = (strain) => PAD.left + (strain / far) * (WIDTH - PAD.left - PAD.right);
  /** @param {number} stress */
  const y = (stress) => bottom - (stress / most) * (bottom - PAD.top);
  for (const share of [0, 0.5, 1]) {
    const [across, up] = [x(share * far), y(share * most)];
    add("line", { x1: PAD.left, x2: WIDTH - PAD.right, y1: up, y2: up, class: "grid-line" });
    add("text", { x: PAD.left - 5, y: up + 4, class: "tick end" }, String(Number((share * most).toPrecision(2))));
    add(
      "text",
      { x: across, y: bottom + 14, class: `tick ${share > 0.5 ? "end" : "middle"}` },
      (100 * share * far).toFixed(0),
    );
  }
  add("text", { x: x(far / 2), y: HEIGHT - 3, class: "axis middle" }, "N/mm against stretch, %");
  for (const { strain, stress_n_per_mm: stress } of pulls) {
    add("path", { d: `M${strain.map((e, k) => `${x(e)} ${y(stress[k])}`).join("L")}`, class: "pull-line" });
  }
  return plot;
}
