/**
 * Stiffness along the course against stiffness along the wale, of all fabrics of all materials, and
 * where this chart lies among them (as in the paper's Fig. 2c).
 *
 * @import {Studio} from "../state/studio.js"
 */

import { figure } from "../core/format.js";
import { paced } from "../core/paced.js";
import { predictionOf } from "../services/belonging.js";
import { logAxis } from "./axis.js";
import { drawing, svg } from "../elements/dom.js";
import { FABRICS } from "../grid/segments.js";

const PAD = { left: 50, right: 10, top: 8, bottom: 40 };
/** @type {import("./axis.js").AxisOptions} */
const AXIS = { steps: [1, 3], room: [0.12, 0.12] };

/** @param {HTMLElement} host @param {Studio} studio @returns {() => void} draws anew */
export function rigidityPlot(host, studio) {
  const { plot, add } = drawing({ role: "img" });
  host.append(plot);

  const draw = () => {
    const { clientWidth: width, clientHeight: height } = host;
    if (width < 60 || height < 60) return;
    plot.setAttribute("viewBox", `0 0 ${width} ${height}`);
    plot.replaceChildren();
    const points = studio.materials.value.flatMap(({ id, name, fabrics }) =>
      FABRICS.flatMap((fabric) => {
        const moduli = fabrics[fabric];
        return moduli ? [{ id, name, fabric, x: moduli.modulus_course_n_per_mm, y: moduli.modulus_wale_n_per_mm }] : [];
      }),
    );
    const { value, scope } = studio.prediction.value;
    const own = value && { x: value.modulus_course_n_per_mm, y: value.modulus_wale_n_per_mm };
    if (!own) belonging.clear(); // only here: while it is hidden, the old dot stays
    const all = own ? [...points, own] : points;
    if (!all.length) return;
    const x = logAxis(
      all.map((p) => p.x),
      PAD.left,
      width - PAD.right,
      AXIS,
    );
    const y = logAxis(
      all.map((p) => p.y),
      height - PAD.bottom,
      PAD.top,
      AXIS,
    );

    for (const tick of x.ticks) {
      add("line", { x1: x.at(tick), x2: x.at(tick), y1: PAD.top, y2: height - PAD.bottom, class: "grid-line" });
      add("text", { x: x.at(tick), y: height - PAD.bottom + 16, class: "tick middle" }, String(tick));
    }
    for (const tick of y.ticks) {
      add("line", { x1: PAD.left, x2: width - PAD.right, y1: y.at(tick), y2: y.at(tick), class: "grid-line" });
      add("text", { x: PAD.left - 6, y: y.at(tick) + 4, class: "tick end" }, String(tick));
    }
    add(
      "text",
      { x: width - PAD.right, y: height - 6, class: "axis end" }, // a narrow plot has room before its axis
      "Stiffness along rows (N/mm)",
    );
    add(
      "text",
      { transform: `translate(11 ${(PAD.top + height - PAD.bottom) / 2}) rotate(-90)`, class: "axis middle" },
      "along columns (N/mm)",
    );
    for (const point of points) {
      const chosen = point.id === studio.materialId.value;
      const tip = `${point.name}, ${point.fabric}: ${figure(point.x)} and ${figure(point.y)} N/mm`;
      const place = { cx: x.at(point.x), cy: y.at(point.y), r: chosen ? 6 : 3.2 };
      add(
        "circle",
        { ...place, fill: `var(--${point.fabric})`, class: chosen ? "fabric-dot chosen" : "fabric-dot" },
        svg("title", {}, tip),
      );
    }
    if (own && value) {
      const intervals = [value.modulus_course_interval_n_per_mm, value.modulus_wale_interval_n_per_mm];
      const [across, up] = intervals;
      /** @param {number} v */
      const clampX = (v) => Math.min(width - PAD.right, Math.max(PAD.left, x.at(v)));
      /** @param {number} v */
      const clampY = (v) => Math.min(height - PAD.bottom, Math.max(PAD.top, y.at(v)));
      if (across && across[0] > 0) {
        add("line", {
          x1: clampX(across[0]),
          x2: clampX(across[1]),
          y1: y.at(own.y),
          y2: y.at(own.y),
          class: "own-interval",
        });
      }
      if (up && up[0] > 0) {
        add("line", { x1: x.at(own.x), x2: x.at(own.x), y1: clampY(up[0]), y2: clampY(up[1]), class: "own-interval" });
      }
      add("path", { d: "M0-8L8 0 0 8-8 0z", transform: `translate(${x.at(own.x)} ${y.at(own.y)})`, class: "own-dot" });
      const label = add("text", { y: y.at(own.y) - 9, class: "own-label" }, `this ${scope}`);
      const wide = label.getComputedTextLength();
      const right = x.at(own.x) + 13 + wide > width;
      // Beside the dot, but never over the axis.
      label.setAttribute("x", String(Math.max(PAD.left + 3, x.at(own.x) + (right ? -13 - wide : 13))));
    }
    plot.setAttribute(
      "aria-label",
      own
        ? `This ${scope}: ${figure(own.x)} N/mm along the rows, ${figure(own.y)} N/mm along the columns, among the fabrics of all materials.`
        : "Stiffness of the fabrics of all materials.",
    );
  };
  const soon = paced(draw, 0); // once for all that changes together
  const belonging = predictionOf(studio);
  belonging.marks(host, "rigidity");
  studio.prediction.listen(({ busy, value, basis }) => {
    if (busy) return;
    if (value) belonging.show(basis);
    soon();
  });
  studio.materials.listen(soon);
  studio.material.listen(soon);
  new ResizeObserver(soon).observe(host);
  return soon;
}
