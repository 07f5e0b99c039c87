/**
 * Stitches from a wanted outline: how wide the stretched swatch shall be, line by line.
 *
 * @import {Studio} from "../../state/studio.js"
 * @import {Direction} from "../../types.js"
 * @import {ShapeResult} from "../../types.js"
 */

import { figure, percent } from "../../core/format.js";
import { Belonging } from "../../services/belonging.js";
import { Grid } from "../../grid/grid.js";
import { drawing, h } from "../../elements/dom.js";
import { thumbnail } from "../../widgets/thumbnail.js";
import { nameOf } from "./apply.js";
import { field, fillButton, form, verdict } from "./form.js";
import { segmented } from "../../widgets/fields.js";
import { Run } from "../../widgets/jobrun.js";
import { textButton } from "../../widgets/buttons.js";

const WIDTH = 316;
const HEIGHT = 200;
const PAD = { left: 34, right: 10, top: 10, bottom: 48 };
const LOW = 0.7;
const HIGH = 1.05;
/** Where the handles stand, as shares of the length; the clamps hold the ends. */
const PLACES = [0.1, 0.25, 0.4, 0.5, 0.6, 0.75, 0.9];

/** @param {Studio} studio */
export function fromOutline(studio) {
  const run = new Run(studio);
  const answer = h("div", { class: "inverse-answer", id: "outline-answer" });
  /** @type {Direction} */ let direction = "wale";
  const widths = [0.98, 0.95, 0.92, 0.91, 0.92, 0.95, 0.98];
  const belonging = new Belonging(studio, () => ({
    design: studio.designId,
    chart: [studio.document.grid.rows, studio.document.grid.columns], // its stitches are replaced
    yarn: studio.materialId.value,
    wish: [direction, widths, strain.value, band.value],
  }));
  belonging.marks(answer, "outline");
  belonging.bars(answer);
  /** @type {number[] | null} */ let reached = null;
  const strain = field("Stretch in percent", 30, { min: "1", max: "200", step: "any", id: "outline-strain" });
  const band = field("Narrowest band, lines", 4, { min: "1", max: "100", step: "1" });
  let seed = 0;

  const { plot, add } = drawing({
    viewBox: `0 0 ${WIDTH} ${HEIGHT}`,
    class: "outline-plot full-width",
    role: "group",
    "aria-label": "Target width of the stretched swatch over its width at rest",
  });
  const x = (/** @type {number} */ share) => PAD.left + share * (WIDTH - PAD.left - PAD.right);
  const y = (/** @type {number} */ width) =>
    PAD.top + ((HIGH - width) / (HIGH - LOW)) * (HEIGHT - PAD.top - PAD.bottom);

  /** The wanted width at a share of the length. @param {number} share */
  const targetWidth = (share) => {
    const at = [0, ...PLACES, 1];
    const values = [1, ...widths, 1];
    const k = Math.max(
      0,
      at.findLastIndex((place) => place <= share),
    );
    if (k >= at.length - 1) return 1;
    const t = (share - at[k]) / (at[k + 1] - at[k]);
    return values[k] + (values[k + 1] - values[k]) * t * t * (3 - 2 * t);
  };
  const draw = () => {
    const focused = plot.contains(document.activeElement) ? document.activeElement?.id : "";
    plot.replaceChildren();
    for (const tick of [0.7, 0.8, 0.9, 1]) {
      add("line", { x1: PAD.left, x2: WIDTH - PAD.right, y1: y(tick), y2: y(tick), class: "grid-line" });
      add("text", { x: PAD.left - 6, y: y(tick) + 4, class: "tick end" }, tick.toFixed(1));
    }
    const [first, last] = direction === "wale" ? ["bottom row", "top row"] : ["first column", "last column"];
    add("text", { x: PAD.left, y: HEIGHT - 28, class: "tick" }, first);
    add("text", { x: WIDTH - PAD.right, y: HEIGHT - 28, class: "tick end" }, last);
    add(
      "text",
      { x: (PAD.left + WIDTH - PAD.right) / 2, y: HEIGHT - 8, class: "tick middle" },
      "stretched width over width at rest",
    );
    const shares = Array.from({ length: 81 }, (_, i) => i / 80);
    add("path", { d: path(shares.map((s) => [x(s), y(targetWidth(s))])), class: "outline-wanted" });
    if (reached) {
      const { length } = reached;
      add("path", { d: path(reached.map((w, i) => [x((i + 0.5) / length), y(w)])), class: "outline-reached" });
    }
    PLACES.forEach((place, k) => {
      const handle = add("circle", {
        id: `outline-${k}`,
        cx: x(place),
        cy: y(widths[k]),
        r: 7,
        class: "outline-handle",
        tabindex: 0,
        role: "slider",
        "aria-label": `Target width at ${percent(place)} of the length`,
        "aria-valuemin": LOW,
        "aria-valuemax": HIGH,
        "aria-valuenow": widths[k],
        "aria-valuetext": figure(widths[k], 2),
      });
      handle.addEventListener("pointerdown", (event) => drag(event, k));
      handle.addEventListener("keydown", (event) => {
        const step = { ArrowUp: 0.01, ArrowDown: -0.01 }[event.key];
        if (!step) return;
        event.preventDefault();
        event.stopPropagation();
        set(k, widths[k] + step);
      });
    });
    if (focused) document.getElementById(focused)?.focus({ preventScroll: true });
  };
  /** @param {number} k @param {number} width */
  const set = (k, width) => {
    widths[k] = Math.round(100 * Math.min(HIGH, Math.max(LOW, width))) / 100;
    reached = null;
    belonging.check();
    draw();
  };
  /** @param {PointerEvent} down @param {number} k */
  const drag = (down, k) => {
    down.preventDefault();
    const done = new AbortController();
    window.addEventListener(
      "pointermove",
      ({ clientY }) => {
        const box = plot.getBoundingClientRect();
        const at = ((clientY - box.top) / box.height) * HEIGHT;
        set(k, HIGH - ((at - PAD.top) / (HEIGHT - PAD.top - PAD.bottom)) * (HIGH - LOW));
      },
      { signal: done.signal },
    );
    for (const name of ["pointerup", "pointercancel"])
      window.addEventListener(name, () => done.abort(), { signal: done.signal });
  };

  const fill = async () => {
    const { rows, columns } = studio.document.grid;
    const lines = direction === "wale" ? rows : columns;
    answer.replaceChildren();
    reached = null;
    draw();
    belonging.clear();
    const { basis } = belonging;
    /** @type {ShapeResult | null} */
    const shapeResult = await run.run(
      "shape",
      {
        material: studio.materialId.value,
        direction,
        strain: strain.valueAsNumber / 100,
        width: Array.from({ length: lines }, (_, i) => Number(targetWidth((i + 0.5) / lines).toFixed(4))),
        across: direction === "wale" ? columns : rows,
        smallest_band: Math.min(band.valueAsNumber || 4, lines),
        seed,
      },
      "Pulling swatches",
    );
    if (!shapeResult) return;
    show(shapeResult);
    belonging.show(basis);
  };
  /** @param {ShapeResult} shapeResult */
  const show = (shapeResult) => {
    reached = shapeResult.width;
    draw();
    const filled = Grid.fromText(shapeResult.chart);
    const good = shapeResult.largest <= 0.03;
    answer.replaceChildren(
      verdict(
        good,
        `Stretched, the widths are ${percent(shapeResult.rms, 1)} off on average and ${percent(shapeResult.largest, 1)} at most (${figure(shapeResult.force_n, 2)} N; ${shapeResult.pulls} swatches pulled).`,
      ),
      h(
        "div",
        { class: "inverse-preview flex" },
        thumbnail({ chart: shapeResult.chart }, { side: 150, label: "The filled chart" }),
        h(
          "div",
          { class: "preview-words stack small shrinks-x grows gap-6" },
          h(
            "p",
            {},
            `From the ${direction === "wale" ? "bottom" : "left"}: ${shapeResult.bands.map(({ repeat, lines }) => `${lines} of ${nameOf(repeat)}`).join(", ")}.`,
          ),
          ...shapeResult.messages.map((message) => h("p", {}, message)),
          h(
            "div",
            { class: "inverse-buttons" },
            textButton(
              "check",
              "Apply",
              () => {
                studio.document.replace(filled, "Fill from an outline");
                studio.tell("The chart is filled. Stretch it below to see the outline.");
              },
              { class: "button primary", id: "outline-apply" },
            ),
            textButton(null, "Discard", () => {
              reached = null;
              draw();
              answer.replaceChildren();
            }),
            textButton("wand", "Another try", () => {
              seed += 1;
              void fill();
            }),
          ),
        ),
      ),
    );
  };

  const pulls = segmented(
    "Pulled along",
    [
      ["wale", "Columns"],
      ["course", "Rows"],
    ],
    direction,
    (way) => {
      direction = /** @type {Direction} */ (way);
      reached = null;
      belonging.check();
      draw();
    },
  );
  for (const input of [strain, band]) input.addEventListener("input", () => belonging.check());
  draw();
  const element = h(
    "div",
    { class: "inverse-section" },
    form(
      fill,
      h(
        "p",
        { class: "muted inverse-hint" },
        "Drag the points: how wide the swatch should be when it is stretched between clamps. The whole chart is filled with bands.",
      ),
      plot,
      h(
        "div",
        { class: "inverse-bar" },
        h("span", { class: "muted" }, "Pulled along"),
        pulls.element,
        h("label", { class: "check" }, "by", strain, h("span", { class: "muted" }, "%")),
        h("label", { class: "check" }, "bands of at least", band, "lines"),
      ),
      fillButton(studio, "outline-run", "shape", "an outline, for which it is pulled a hundred times", run),
    ),
    answer,
  );
  return { element };
}

/** @param {number[][]} points */
function path(points) {
  return points.map(([px, py], i) => `${i ? "L" : "M"}${px.toFixed(1)} ${py.toFixed(1)}`).join("");
}
