/**
 * What a yarn serves for, and what is missing for the rest.
 *
 * @import {UseResult} from "../../types.js"
 * @import {IconName} from "../../elements/icons.js"
 */

import { h } from "../../elements/dom.js";
import { icon } from "../../elements/icons.js";
import { inKnittersWords } from "../../services/swatches.js";

/** @type {Record<UseResult["serves"], [IconName, string]>} */
const SERVES = { yes: ["check", "Yes"], roughly: ["minus", "Roughly"], no: ["close", "No"] };

/** @param {readonly UseResult[]} uses */
export const usesList = (uses) =>
  h(
    "ul",
    { class: "yarn-uses", "aria-label": "What it serves for" },
    ...uses.map(({ name, serves, missing }) => {
      const [sign, words] = SERVES[serves];
      return h(
        "li",
        { class: `yarn-use line gap-6 ${serves}` },
        icon(sign),
        h(
          "span",
          {},
          h("strong", {}, words),
          `: ${name}`,
          missing &&
            h(
              "span",
              { class: "muted" },
              ` (${serves === "no" ? "missing" : "better with"}: ${inKnittersWords(missing)})`,
            ),
        ),
      );
    }),
  );
