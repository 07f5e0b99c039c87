/**
 * Relaxes the repeat on show at the yarn level while painting pauses, if the service says that its
 * numbers would be more certain by it. The gauge that comes of it is kept beside the counted ones.
 *
 * @import {Studio} from "../state/studio.js"
 * @import {RelaxResult} from "../types.js"
 */

import { Latest } from "./latest.js";
import { runJob } from "./jobs.js";
import { scopeOf } from "./scope.js";

const PAUSE_MS = 1500;

/** @param {Studio} studio */
export function startRelaxer(studio) {
  const { gauges, prediction, relaxing, stretch } = studio;
  const latest = new Latest(PAUSE_MS);
  /** Repeats that could not be relaxed: they are not tried again. @type {Set<string>} */
  const refused = new Set();
  const consider = () => {
    latest.cancel();
    relaxing.value = false;
    const { value, busy } = prediction.value;
    // A stretch test that somebody waits for comes first.
    const chart = busy || stretch.value.busy || value?.other_stitches ? null : value?.worth_relaxing;
    const material = studio.materialId.value;
    if (!chart || refused.has(`${material}\n${chart}`)) return;
    const cloth = { chart: scopeOf(studio).grid.text, material };
    latest.run(
      async (signal) => {
        relaxing.value = true;
        /** @type {RelaxResult} */
        const { gauge } = await runJob("relax", { chart, material, branch: "mirrored" }, { signal });
        if (signal.aborted) return;
        if (gauge) gauges.keep(cloth, gauge);
        else refused.add(`${material}\n${chart}`);
        relaxing.value = false;
      },
      ({ offline }) => {
        // The learned numbers stand as they are, with their wider intervals.
        if (offline) studio.online.value = false;
        else refused.add(`${material}\n${chart}`);
        relaxing.value = false;
      },
    );
  };
  prediction.watch(consider);
  stretch.listen(consider);
}
