/**
 * Files of instructions: written rows, KnitSpeak and knitout. The service reads them, with their outline
 * and yarns, and they are opened as a design of their own.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {Problem} from "../../types.js"
 */

import { ApiError, api } from "../../api.js";
import { base64 } from "../../grid/bits.js";
import { readDesign } from "../../design/design.js";

const WRITTEN = /^\s*(cast on|rows?|rounds?|rnds?)\s+\d/i;

/** @param {string} text which may begin with a byte order mark */
const isKnitout = (text) => /^\ufeff?\s*;!knitout/.test(text);

/**
 * Whether a text is to be knitted rather than lines of K and P.
 *
 * @param {string} name of the file
 * @param {string} text
 */
export const isKnitting = (name, text) => /\.(k|ks|knitout)$/i.test(name) || isKnitout(text) || WRITTEN.test(text);

/**
 * @param {ActionContext} context
 * @param {string} name
 * @param {string} text
 * @returns {Promise<Problem | null>}
 */
export async function importKnitting({ studio, keeper }, name, text) {
  const content = base64(new TextEncoder().encode(text));
  const suffixed = isKnitout(text) && !/\.(k|knitout)$/i.test(name) ? `${name}.k` : name;
  try {
    const imported = await api.run("import", { file: { name: suffixed, content } });
    const design = readDesign({
      format: "knitcore-design",
      version: 2,
      name: name.replace(/\.\w+$/, "") || "Imported",
      material: studio.materialId.value,
      chart: imported.chart,
      outline: imported.outline,
      regions: imported.regions,
    });
    keeper.openNew(design);
    studio.tell(
      [
        `Opened ${imported.columns} stitches × ${imported.rows} rows from ${name}.`,
        ...imported.notes,
        "The design before it is still among your designs.",
      ].join(" "),
    );
    return null;
  } catch (error) {
    if (!(error instanceof ApiError)) throw error;
    return { ...error.problem, title: "This file cannot be read" };
  }
}
