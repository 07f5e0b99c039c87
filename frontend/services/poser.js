/**
 * Keeps the piece in the pose in which somebody looks at it, as it lies or on the body: a first shape
 * a moment after each change, then the shape at rest, both given up when the next change comes. Until
 * the first shape is there, the old one is shown, if the piece has kept its size.
 *
 * @import {Posed} from "../state/seeing.js"
 * @import {Studio} from "../state/studio.js"
 */

import { ApiError, api } from "../api.js";
import { along } from "../core/directions.js";
import { Latest } from "./latest.js";
import { limbOf, pieceIn, pieceOf, scopeIn } from "./scope.js";
import { figure, percent } from "../core/format.js";
import { POSES, hindrance } from "../state/seeing.js";
import { REST } from "../state/studio.js";

const DELAY_MS = 25;
/** CPU time of the first shape, and that after which the second is shown as a preview, too. */
const PATIENCE_S = [0.03, 40];

const CHANGED = {
  type: "input",
  title: "This glove cannot be shown on the hand",
  status: 422,
  detail: "Its stitches or its yarn were changed since it was planned, and its fit is known only as planned.",
  remedy: "Plan the glove with other fabrics or in another yarn, or undo the changes.",
};

/** @type {Record<string, (studio: Studio, signal: AbortSignal) => AsyncGenerator<Posed>>} */
const SHAPES = { lying, worn, pulled, hung };
/** @param {Studio} studio */
export function startPoser(studio) {
  const latest = new Latest(DELAY_MS);
  const { pose, posed, limb, curling } = studio.seeing;
  /** @returns {Posed["pose"]} */
  const poseToShow = () => (pose.value === "flat" && curling.value && studio.currentStrain() ? "pulled" : pose.value);
  const ask = () => {
    latest.cancel();
    const now = poseToShow();
    const shapes = SHAPES[now];
    const { rows, columns } = studio.document.grid;
    const old = posed.value;
    const fits = old?.pose === now && old.rows === rows && old.columns === columns;
    // What was said of it in numbers does not hold any more.
    const words = now === "pulled" ? "Stretched" : POSES[now];
    posed.value = fits && old ? { ...old, words, pressure: undefined, converged: false } : null;
    if (!shapes) return;
    const why = hindrance(studio, now);
    if (why) {
      studio.tell(why);
      pose.value = "flat";
      curling.value = false;
      return;
    }
    latest.run(
      async (signal) => {
        for await (const shape of shapes(studio, signal)) {
          if (signal.aborted) return;
          posed.value = shape;
          if (shape.converged) return;
        }
      },
      ({ offline, problem }) => {
        if (offline) studio.online.value = false;
        studio.tellProblem(problem);
        pose.value = "flat";
        curling.value = false;
      },
    );
  };
  const again = () => {
    if (pose.value === "tested")
      pose.value = "flat"; // it was a piece of the chart before
    else if (poseToShow() !== "flat") ask();
  };
  pose.listen((now) => now !== "tested" && ask());
  studio.weight.listen(() => {
    if (pose.value === "tested") again();
    else if (pose.value === "hung") ask();
  });
  limb.listen(() => pose.value === "worn" && ask());
  studio.step.listen((step) => {
    if (step !== REST) pose.value = "flat"; // it is pulled
    if (curling.value) ask();
  });
  studio.stretch.listen(() => curling.value && ask());
  curling.listen(ask);
  studio.document.onChange(again);
  studio.materialId.listen(again);
  studio.gauges.changes.listen(again);
  if (pose.value !== "tested") again(); // chosen before
}

/** @param {Studio} studio @param {AbortSignal} signal @returns {AsyncGenerator<Posed>} */
async function* lying(studio, signal) {
  for await (const shape of curled(studio, signal, null)) {
    yield { ...shape, pose: "lying", words: "Unpinned (no friction with the table)" };
  }
}

/** @param {Studio} studio @param {AbortSignal} signal @returns {AsyncGenerator<Posed>} */
async function* pulled(studio, signal) {
  const [direction, strain] = [studio.stretchDirection(), studio.currentStrain() ?? 0];
  const words = `Stretched ${along(direction)} by ${(100 * strain).toFixed(0)} %, free edges curl`;
  for await (const shape of curled(studio, signal, { direction, strain })) {
    yield { ...shape, pose: "pulled", words };
  }
}

/** @param {Studio} studio @param {AbortSignal} signal @returns {AsyncGenerator<Posed>} */
async function* hung(studio, signal) {
  const { rows, columns } = studio.document.grid;
  const request = { ...pieceOf(studio), linear_density_g_per_m: studio.weight.value };
  for (const time_limit_s of PATIENCE_S) {
    const { id, converged, weight_g, drop_mm, lengthening, notes } = await api.run(
      "hang",
      { ...request, time_limit_s },
      signal,
    );
    const change = `${percent(Math.abs(lengthening), 1)} ${lengthening < 0 ? "shorter" : "longer"}`;
    const length = `reaches ${figure(drop_mm / 10, 3)} cm down, stitches ${change}`;
    const words = `Hanging: ${figure(weight_g, 2)} g, ${length}`;
    yield { pose: "hung", id, rows, columns, converged, words, note: notes[0] };
  }
}

/** @param {Studio} studio @param {AbortSignal} signal @param {import("../types.js").CurlRequest["pull"]} pull */
async function* curled(studio, signal, pull) {
  const request = { ...pieceOf(studio), pull };
  /** The first shape begins at the old one; the last one depends on the chart only. */
  let after = studio.seeing.posed.value?.id ?? null;
  for (const time_limit_s of PATIENCE_S) {
    const { id, rows, columns, converged, notes } = await api.run("curl", { ...request, after, time_limit_s }, signal);
    yield { id, rows, columns, converged: converged && !after, note: notes[0] };
    after = null;
  }
}

/** @param {Studio} studio @param {AbortSignal} signal @returns {AsyncGenerator<Posed>} */
async function* worn(studio, signal) {
  const { rows, columns } = studio.document.grid;
  const hand = gloveOf(studio);
  if (hand) {
    const { id, parts, limit_mmhg, notes } = await api.run("glove", hand, signal);
    const planned = pieceOf(studio).gauge ? "hand, with the gauge of its plan" : "hand";
    yield {
      pose: "worn",
      id,
      rows,
      columns,
      converged: true,
      note: notes.at(-1) ?? "",
      ...pressed(parts, limit_mmhg, notes, planned),
    };
    return;
  }
  const whole = scopeIn(studio.document, null);
  const piece = pieceIn(studio, whole);
  const limb = limbOf(studio, whole, await api.run("predict", piece, signal));
  const { id, places, limit_mmhg, notes } = await api.run("limb", { ...piece, ...limb }, signal);
  if (!id) return;
  const note = notes.find((words) => !isWarning(words)) ?? "";
  yield { pose: "worn", id, rows, columns, converged: true, note, ...pressed(places, limit_mmhg, notes, "body") };
}

/** Whether a note of the service warns of a pressure that can stop the blood. @param {string} note */
export const isWarning = (note) => note.includes("stop the blood");

/**
 * What to say of a garment that is worn; its brightest stitches have the highest pressure of all ranges.
 *
 * @param {{mmhg: [number, number] | null}[]} places
 * @param {number} limit above which the blood can stop, mmHg
 * @param {string[]} notes
 * @param {string} where
 * @returns {Pick<Posed, "words" | "pressure">}
 */
function pressed(places, limit, notes, where) {
  const most = Math.max(0, ...places.map(({ mmhg }) => mmhg?.[1] ?? 0));
  const warning = notes.filter(isWarning).join(" ");
  if (!most && !warning) return { words: `On the ${where}: loose` };
  return { words: `Pressure on the ${where}`, pressure: { most, limit, warning } };
}

/** The hand that the chart is a glove for; null if it is none. @param {Studio} studio */
function gloveOf(studio) {
  const glove = studio.seeing.glove.value;
  const { outlineText, grid } = studio.document;
  if (!glove?.chart || outlineText !== glove.outline) return null;
  if (grid.text !== glove.chart || studio.materialId.value !== glove.request.material) throw new ApiError(CHANGED);
  return glove.request;
}
