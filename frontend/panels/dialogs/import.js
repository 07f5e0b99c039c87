/**
 * A chart from outside.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {Studio} from "../../state/studio.js"
 */

import { h, remark } from "../../elements/dom.js";
import { icon } from "../../elements/icons.js";
import { importFile, importText } from "./importer.js";
import { dialog } from "../../widgets/dialog.js";
import { problemText } from "../../widgets/problem.js";

/** @param {Studio} _ @param {ActionContext} context */
export function create(_, context) {
  const text = h("textarea", {
    id: "import-text",
    class: "import-text framed rounded full-width",
    rows: 10,
    spellcheck: false,
    placeholder: "KPKPKP\nPKPKPK",
    "aria-label": "Chart as lines of K and P, top row first",
  });
  const problem = h("div", { class: "problem", role: "alert", id: "import-problem", hidden: true });
  /** @param {Promise<import("../../types.js").Problem | null>} outcome */
  const settle = async (outcome) => {
    const wrong = await outcome;
    problem.hidden = wrong === null;
    if (wrong) return problem.replaceChildren(icon("warning"), problemText(wrong));
    text.value = "";
    element.close();
  };
  const file = h("input", {
    type: "file",
    id: "import-file",
    accept: ".txt,.json,.k,.ks,.knitout,.csv,.tsv,.xlsx,.xls,.h5,.hdf5,text/plain,application/json,image/*",
    class: "visually-hidden",
    onchange: () => file.files?.[0] && void settle(importFile(context, file.files[0])),
  });
  const element = dialog(
    "import-dialog",
    "Import a chart",
    remark(
      "Paste lines of K and P (or | and •), the top row first, as seen from the face; or written rows, KnitSpeak or knitout. Or choose a file, or drop it anywhere on the page: a text, a picture, a project file, or the table of a stretch test, for a yarn of your own.",
    ),
    text,
    problem,
    h(
      "div",
      { class: "dialog-buttons" },
      h("label", { class: "button", for: "import-file" }, "Choose a file …"),
      file,
      h(
        "button",
        { class: "button primary", id: "import-apply", onclick: () => void settle(importText(context, text.value)) },
        "Import",
      ),
    ),
  );
  return () => {
    problem.hidden = true;
    element.showModal();
    text.focus();
  };
}
