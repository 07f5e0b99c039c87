/**
 * Keeps the piece in the pose in which somebody looks at it, as it lies or on the body: a first shape
 * a moment after each change, then the shape at rest, both given up when the next change comes. Until
 * the first shape is there, the old one is shown, if the piece has kept its size.
 *
 * @import {Posed} from "../chart/seeing.js"
 * @import {Studio} from "../studio.js"
 */

import { ApiError, api, isAbort } from "../api.js";
import { Latest } from "../core/latest.js";
import { figure } from "../core/format.js";
import { REST } from "../studio.js";

const DELAY_MS = 150;
/** CPU time of the first shape, and that after which the second is shown as a preview, too. */
const PATIENCE_S = [0.15, 40];

/** @type {Record<string, (studio: Studio, signal: AbortSignal) => AsyncGenerator<Posed>>} */
const POSES = { lying, worn };

/** @param {Studio} studio */
export function startPoser(studio) {
  const latest = new Latest(DELAY_MS);
  const { pose, posed, limb } = studio.seeing;
  const ask = () => {
    latest.cancel();
    const shapes = POSES[pose.value];
    const { rows, columns } = studio.document.grid;
    const old = posed.value;
    const fits = old?.pose === pose.value && old.rows === rows && old.columns === columns;
    posed.value = fits && old ? { ...old, converged: false } : null;
    if (!shapes) return;
    latest.run(async (signal) => {
      try {
        for await (const found of shapes(studio, signal)) {
          if (signal.aborted) return;
          posed.value = found;
          if (found.converged) return;
        }
      } catch (error) {
        if (isAbort(error) || signal.aborted) return;
        if (!(error instanceof ApiError)) throw error;
        if (error.offline) studio.online.value = false;
        studio.tellProblem(error.problem);
        pose.value = "flat";
      }
    });
  };
  const again = () => pose.value !== "flat" && ask();
  pose.listen(ask);
  limb.listen(() => pose.value === "worn" && ask());
  studio.step.listen((step) => {
    if (step !== REST) pose.value = "flat"; // it is pulled
  });
  studio.document.onChange(again);
  studio.materialId.listen(again);
}

/** @param {Studio} studio @param {AbortSignal} signal @returns {AsyncGenerator<Posed>} */
async function* lying(studio, signal) {
  for (const time_limit_s of PATIENCE_S) {
    const { id, rows, columns, converged, notes } = await api.curl({ ...studio.request, time_limit_s }, signal);
    const words = converged ? "As it lies, without friction" : "As it lies: a preview, still moving";
    yield { pose: "lying", id, rows, columns, converged, words, note: notes[0] };
  }
}

/** @param {Studio} studio @param {AbortSignal} signal @returns {AsyncGenerator<Posed>} */
async function* worn(studio, signal) {
  const { rows, columns } = studio.document.grid;
  const { id, places, notes } = await api.limb({ ...studio.request, ...studio.limb }, signal);
  if (!id) return;
  const most = Math.max(0, ...places.map(({ mmhg }) => (mmhg ? (mmhg[0] + mmhg[1]) / 2 : 0)));
  const words = most ? `On the body: 0 to ${figure(most, 2)} mmHg, dark to light` : "On the body: loose";
  yield { pose: "worn", id, rows, columns, converged: true, words, note: notes[0] };
}
