/**
 * Keeps the design in this browser after every step.
 *
 * @import {Studio} from "../studio.js"
 */

import { saveDesign } from "../core/store.js";

const DELAY_MS = 250;

/** @param {Studio} studio */
export function startAutosave(studio) {
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;
  let warned = false;
  const root = document.documentElement;
  const save = () => {
    clearTimeout(timer);
    timer = undefined;
    delete root.dataset.unsaved;
    const kept = saveDesign(
      { id: studio.designId, ...studio.toDocument() },
      studio.document.history,
    );
    if (!kept && !warned) {
      warned = true;
      studio.tellProblem({
        type: "storage",
        status: 0,
        title: "This browser does not keep the design",
        detail: "Its storage is full or closed to this page.",
        remedy: "Export the chart as text before you leave.",
      });
    }
  };
  const soon = () => {
    root.dataset.unsaved = "";
    timer ??= setTimeout(save, DELAY_MS);
  };
  studio.document.onSettle(soon);
  studio.name.listen(soon);
  studio.materialId.listen(soon);
  const flush = () => {
    if (timer !== undefined) save();
  };
  window.addEventListener("pagehide", flush);
  document.addEventListener("visibilitychange", flush);
  save();
}
