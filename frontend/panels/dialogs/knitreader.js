/**
 * Charts that the service reads: drawn with letters or signs, written rows, KnitSpeak, knitout, and
 * pictures of this program. Instructions, outlines and yarns are opened as a design of their own.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {Problem} from "../../types.js"
 */

import { ApiError, api, refusal } from "../../api.js";
import { base64 } from "../../grid/bits.js";
import { readDesign } from "../../design/design.js";
import { Grid, MAX_SIDE, isChartText } from "../../grid/grid.js";
import { readCodes } from "../../grid/kinds.js";
import { Others, entriesOf, written } from "../../design/others.js";

const WRITTEN = /^\s*(cast on|co|rows?|rounds?|rnds?|r)[\s:]*\d/im;

/** @param {string} text which may begin with a byte order mark */
const isKnitout = (text) => /^\ufeff?\s*;!knitout/.test(text);

/**
 * Whether a text is to be knitted rather than lines of K and P.
 *
 * @param {string} name of the file
 * @param {string} text
 */
const isKnitting = (name, text) => /\.(k|ks|knitout)$/i.test(name) || isKnitout(text) || WRITTEN.test(text);

/**
 * @param {ActionContext} context
 * @param {string} name
 * @param {string | Uint8Array} content a text, or the bytes of a picture
 * @returns {Promise<Problem | null>}
 */
export async function importRead({ studio, keeper }, name, content) {
  const text = typeof content === "string" ? content : null;
  const bytes = typeof content === "string" ? new TextEncoder().encode(content) : content;
  const { designId } = studio;
  const suffixed = text && isKnitout(text) && !/\.(k|knitout)$/i.test(name) ? `${name}.k` : name;
  try {
    const imported = await api.run("import", { file: { name: suffixed, content: base64(bytes) } });
    await studio.document.rested();
    if (designId !== studio.designId) {
      return refusal("Another design was opened before the chart was read.", "Import it again where it belongs.");
    }
    const { rows, columns, outline, regions, notes } = imported;
    const read = imported.other_stitches.length ? null : readCodes(imported.chart);
    const chart = read?.chart ?? imported.chart;
    const put = read
      ? read.others.map(([row, column, code]) => /** @type {[number, string]} */ ([row * columns + column, code]))
      : entriesOf(imported.other_stitches, columns);
    const size = `${columns} stitches × ${rows} rows`;
    if (!isChartText(chart)) {
      return refusal(
        `${size} is more than this page paints.`,
        `Use at most ${MAX_SIDE} × ${MAX_SIDE}; the command line takes more.`,
      );
    }
    if (text && !isKnitting(name, text) && !outline && !regions?.length) {
      studio.document.replace(Grid.fromText(chart), "Import", put);
      studio.tell([`Imported ${size}.`, ...notes, "Undo brings the old chart back."].join(" "));
      return null;
    }
    const design = readDesign({
      format: "knitcore-design",
      version: 2,
      name: name.replace(/\.\w+$/, "") || "Imported",
      material: studio.materialId.value,
      chart,
      other_stitches: written(Others.of(put), columns),
      outline,
      regions,
    });
    keeper.openNew(design);
    studio.tell(
      [`Opened ${size} from ${name}.`, ...notes, "The design before it is still among your designs."].join(" "),
    );
    return null;
  } catch (error) {
    if (!(error instanceof ApiError)) throw error;
    return refusal(error.problem.detail ?? "", error.problem.remedy);
  }
}
