/**
 * Asks the service for the mechanics of the chart, or of the selection, a moment after each change.
 *
 * @import {Studio} from "../state/studio.js"
 */

import { api } from "../api.js";
import { predictionOf } from "./belonging.js";
import { Latest } from "./latest.js";
import { scopeOf } from "./scope.js";
import { anyClothIn, remarksOn } from "./stitches.js";

const DELAY_MS = 80;

/** @param {Studio} studio @returns {() => void} asks anew */
export function startPredictor(studio) {
  const latest = new Latest(DELAY_MS);
  const belonging = predictionOf(studio);
  const ask = () => {
    const { prediction } = studio;
    if (!prediction.value.busy) prediction.value = { ...prediction.value, busy: true };
    latest.run(
      async (signal) => {
        const scope = scopeOf(studio);
        const { basis } = belonging;
        const { problem } = remarksOn(studio, scope);
        if (problem)
          return void (prediction.value = { value: null, busy: false, problem, basis: {}, scope: scope.kind });
        const body = { ...anyClothIn(studio, scope), ...scope.shaped, hand: true };
        const value = await api.run("predict", body, signal);
        if (signal.aborted) return;
        prediction.value = { value, busy: false, problem: null, basis, scope: scope.kind };
        studio.online.value = true;
      },
      ({ offline, problem }) => {
        prediction.value = { value: null, busy: false, problem, basis: {}, scope: scopeOf(studio).kind };
        if (offline) studio.online.value = false;
      },
    );
  };
  studio.document.onChange(ask);
  studio.selection.listen(ask);
  studio.seeing.region.listen(ask);
  studio.gauges.changes.listen(ask);
  studio.materialId.watch(ask);
  return ask;
}
