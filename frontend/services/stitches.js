/**
 * The stitches of a part of the chart as the service takes them: codes where there is lace, a cable, a slip or a
 * tuck among them, else lines of K and P; and what to say where only its knits and purls can be sent.
 *
 * @import {Studio} from "../state/studio.js"
 * @import {Problem} from "../types.js"
 * @import {Scope} from "./scope.js"
 *
 * @typedef {{chart: string, note: string, problem: Problem | null}} Stitches
 */

import { balanceWords, imbalances } from "../design/balance.js";
import { Others, codesText, within } from "../design/others.js";

const OUTLINED = "Of its knits and purls: a piece with an outline is predicted from these alone.";
const CUT = "Of its knits and purls: the edge of this part cuts rows of lace or cables.";

/** What is to be said of a part, and what keeps its numbers away; nothing where all its stitches are knits and purls. @param {Pick<Studio, "document">} studio @param {Scope} scope @returns {Pick<Stitches, "note" | "problem">} */
export const remarksOn = (studio, scope) =>
  studio.document.others.size ? stitchesIn(studio, scope) : { note: "", problem: null };

/** @param {Pick<Studio, "document">} studio @param {Scope} scope @returns {Stitches} */
export function stitchesIn({ document: { others, grid } }, { kind, grid: part, box, shaped }) {
  const plain = { chart: part.text, note: "", problem: null };
  if (!others.size || !box) return plain;
  const { entries, cut } = within(others, grid.columns, box);
  if (!entries.length && !cut) return plain;
  if (shaped) return { ...plain, note: OUTLINED };
  const inside = { grid: part, others: Others.of(entries) };
  const [unbalanced] = imbalances(inside);
  if (kind !== "chart")
    return cut || unbalanced ? { ...plain, note: CUT } : { ...plain, chart: codesText(part, inside.others) };
  return {
    chart: codesText(part, inside.others),
    note: "",
    problem: unbalanced ? unbalancedProblem(unbalanced, grid.columns) : null,
  };
}

/** @param {import("../design/balance.js").Imbalance} imbalance @param {number} columns @returns {Problem} */
const unbalancedProblem = (imbalance, columns) => ({
  type: "input",
  status: 422,
  title: "This chart cannot be knitted yet",
  detail: balanceWords(imbalance, columns),
  remedy: "Mend the row with the buttons at the foot of the chart: the numbers come back at once.",
});

/**
 * The cloth of a scope, of any stitches, with its gauge if that is known.
 *
 * @param {Pick<Studio, "document" | "gauges" | "materialId">} studio
 * @param {Scope} scope
 */
export function anyClothIn(studio, scope) {
  const cloth = { chart: stitchesIn(studio, scope).chart, material: studio.materialId.value };
  return { ...cloth, gauge: studio.gauges.of(cloth) };
}

/** What is said beside a result that knows knits and purls alone; "" where the chart has no others. @param {Studio} studio @param {string} what the result's name */
export const plainWords = ({ document: { others } }, what) =>
  others.size ? `${what} is of this chart's knits and purls: it does not know lace, cables, slips and tucks yet.` : "";
