/** Says beside a result that it knows the knits and purls of the chart alone, while the chart has other stitches. */

import { plainWords } from "../services/stitches.js";
import { h } from "../elements/dom.js";

/** @param {import("../state/studio.js").Studio} studio @param {string} what the result's name */
export function plainNote(studio, what) {
  const note = h("p", { class: "plain-note small muted" });
  const show = () => {
    const words = plainWords(studio, what);
    note.hidden = !words;
    if (note.textContent !== words) note.textContent = words;
  };
  studio.document.onSettle(show);
  show();
  return note;
}
