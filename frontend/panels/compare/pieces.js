/**
 * What can be put side by side: the design in hand and its regions, its versions, other designs; each
 * in its own yarn or in another one.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {Studio} from "../../state/studio.js"
 * @import {CurveResult, DesignDocument, Direction, PredictResult} from "../../types.js"
 * @import {Scope} from "../../services/scope.js"
 *
 * @typedef {{value: string, group: string, label: string}} Choice
 * @typedef {{scope: Scope, stitches: string, material: string, chart: string, outline: string | null}} Piece
 *   `stitches` are those of the scope, of any kind
 * @typedef {{predicted: PredictResult, curves: Record<Direction, CurveResult>}} Answers
 */

import { api } from "../../api.js";
import { ago } from "../../core/ago.js";
import { ChartDocument } from "../../design/document.js";
import { Grid } from "../../grid/grid.js";
import { designs } from "../../sync/designs.js";
import { scopeIn } from "../../services/scope.js";
import { stitchesIn } from "../../services/stitches.js";

/** The design in hand, as it is now. */
export const NOW = "now";

/** @param {Studio} studio @param {ActionContext["keeper"]} keeper @returns {Promise<Choice[]>} */
export async function choices(studio, keeper) {
  const id = keeper.remoteId;
  const [{ versions }, { designs: others }] = await Promise.all([
    id ? designs.versions(id) : { versions: [] },
    designs.list(),
  ]);
  return [
    { value: NOW, group: "This design", label: "Whole chart" },
    ...studio.document.regions.map(({ id: region, name }) => ({
      value: `region ${region}`,
      group: "This design",
      label: `Region ${name}`,
    })),
    ...versions.toReversed().map(({ number, name, created_at: made }) => ({
      value: `version ${number}`,
      group: "Versions",
      label: `${number}. ${name} (${ago(made)})`,
    })),
    ...others
      .filter((design) => design.id !== id)
      .map(({ id: design, name, columns, rows, changed_at: changed }) => ({
        value: `design ${design}`,
        group: "My designs",
        label: `${name} (${columns} × ${rows}, ${ago(changed)})`,
      })),
  ];
}

/**
 * @param {Studio} studio
 * @param {ActionContext["keeper"]} keeper
 * @param {string} value of a choice
 * @returns {Promise<Piece>}
 */
export async function piece(studio, keeper, value) {
  const [kind, id = ""] = value.split(" ");
  if (kind === NOW || kind === "region") {
    const scope = scopeIn(studio.document, kind === NOW ? null : id);
    const { outlineText, grid } = studio.document;
    const whole = kind === NOW;
    return {
      scope,
      stitches: stitchesIn(studio, scope).chart,
      material: studio.materialId.value,
      chart: whole ? grid.text : scope.counted.grid.text,
      outline: whole ? outlineText : null,
    };
  }
  if (kind === "version") return opened((await designs.version(keeper.remoteId ?? "", Number(id))).document);
  return opened((await designs.read(id)).document);
}

/** @param {DesignDocument} design @returns {Piece} */
function opened(design) {
  const chart = new ChartDocument(Grid.fromText(design.chart));
  chart.open(design);
  const scope = scopeIn(chart, null);
  const stitches = stitchesIn({ document: chart }, scope).chart;
  return { scope, stitches, material: design.material, chart: design.chart, outline: design.outline };
}

/**
 * @param {Piece} piece
 * @param {string} material
 * @param {Studio["gauges"]} gauges
 * @param {AbortSignal} signal
 * @returns {Promise<Answers>}
 */
export async function answers({ scope: { shaped }, stitches }, material, gauges, signal) {
  const cloth = { chart: stitches, material };
  const body = { ...cloth, gauge: gauges.of(cloth) };
  const [predicted, course, wale] = await Promise.all([
    api.run("predict", { ...body, ...shaped, hand: true }, signal),
    api.run("curve", { ...body, direction: "course" }, signal),
    api.run("curve", { ...body, direction: "wale" }, signal),
  ]);
  return { predicted, curves: { course, wale } };
}
