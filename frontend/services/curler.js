/**
 * Keeps the shape of the piece as it lies, while somebody looks at it: computed a moment after each
 * change, and given up when the next one comes.
 *
 * @import {Studio} from "../studio.js"
 */

import { ApiError, api, isAbort } from "../api.js";
import { Latest } from "../core/latest.js";
import { REST } from "../studio.js";

const DELAY_MS = 500;
/** CPU time after which a preview is shown. */
const PATIENCE_S = 20;

/** @param {Studio} studio */
export function startCurler(studio) {
  const latest = new Latest(DELAY_MS);
  const { lying, curled } = studio.seeing;
  const ask = () => {
    latest.cancel();
    curled.value = null;
    if (!lying.value) return;
    latest.run(async (signal) => {
      try {
        const found = await api.curl({ ...studio.request, time_limit_s: PATIENCE_S }, signal);
        if (signal.aborted) return;
        curled.value = found;
      } catch (error) {
        if (isAbort(error) || signal.aborted) return;
        if (!(error instanceof ApiError)) throw error;
        if (error.offline) studio.online.value = false;
        studio.tellProblem(error.problem);
        lying.value = false;
      }
    });
  };
  lying.listen(ask);
  studio.step.listen((step) => {
    if (step !== REST) lying.value = false; // it is pulled
  });
  studio.document.onChange(() => lying.value && ask());
  studio.materialId.listen(() => lying.value && ask());
}
