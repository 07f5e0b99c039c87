/**
 * Keeps the shape of the piece as it lies, while somebody looks at it: a first shape a moment after
 * each change, then the shape at rest, both given up when the next change comes. Until the first
 * shape is there, the old one is shown, if the piece has kept its size.
 *
 * @import {Studio} from "../studio.js"
 */

import { ApiError, api, isAbort } from "../api.js";
import { Latest } from "../core/latest.js";
import { REST } from "../studio.js";

const DELAY_MS = 150;
/** CPU time of the first shape, and that after which the second is shown as a preview, too. */
const PATIENCE_S = [0.15, 40];

/** @param {Studio} studio */
export function startCurler(studio) {
  const latest = new Latest(DELAY_MS);
  const { lying, curled } = studio.seeing;
  const ask = () => {
    latest.cancel();
    const { rows, columns } = studio.document.grid;
    const old = curled.value;
    const fits = lying.value && old?.rows === rows && old.columns === columns;
    curled.value = fits && old ? { ...old, converged: false } : null;
    if (!lying.value) return;
    latest.run(async (signal) => {
      try {
        for (const time_limit_s of PATIENCE_S) {
          const found = await api.curl({ ...studio.request, time_limit_s }, signal);
          if (signal.aborted) return;
          curled.value = found;
          if (found.converged) return;
        }
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
