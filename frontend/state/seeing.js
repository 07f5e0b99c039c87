/**
 * How the fabric and its mechanics are looked at: state of the panels that is not part of the design.
 *
 * @import {Cell} from "../grid/raster.js"
 * @import {Direction, GaugeInput} from "../types.js"
 *
 * @typedef {"chart" | "yarn" | "region" | "fabric" | "phase"} YarnColours of the 3D view: as the chart
 *   has them, or one of its own
 * @typedef {"flat" | "lying" | "worn" | "hung" | "tested"} Pose of the fabric in 3D: held flat, as it lies, on
 *   the body, hanging from its top edge, a piece of it over an edge or a disc
 * @typedef {{pose: Pose | "pulled", id: string, rows: number, columns: number, converged: boolean, words: string,
 *   note: string, piece?: {chart: string, outline: string, gauge: GaugeInput | null}, pressure?: {most: number, limit: number, warning: string}}} Posed a
 *   shape that was computed, and what to say of it; the piece is another than the chart; the most pressure, mmHg,
 *   is that of its brightest stitches, and above the limit it can stop the blood
 * @typedef {{at_mm: number, girth_mm: number}} GirthAt of a limb
 * @typedef {{request: import("../types.js").GloveRequest, outline: string, chart: string}} PlannedGlove the hand
 *   for which a glove was made, and the glove's outline and stitches
 * @typedef {"light" | "hand" | "firm"} HandPull how hard a hand pulls
 * @typedef {"stitch" | "block" | "region"} Groups what an extensibility rectangle stands for
 */

import { Signal } from "../core/signal.js";
import { loadSettings, saveSettings } from "../design/store.js";
import { Grid } from "../grid/grid.js";

/** Names of the poses. @type {Record<Pose, string>} */
export const POSES = { flat: "Flat", lying: "Unpinned", worn: "On the body", hung: "Hanging", tested: "In a test" };

/** What the service computes for a pose, and what that is for a knitter. @type {Record<string, [string, string]>} */
const OPERATIONS = {
  lying: ["curl", "its shape unpinned"],
  worn: ["limb", "its shape on the body"],
  pulled: ["curl", "its curling edges"],
  hung: ["hang", "its shape as it hangs"],
};

/** Say why the piece cannot be shown in a pose; "" if it can. @param {import("./studio.js").Studio} studio @param {string} pose */
export const hindrance = (studio, pose) => (pose in OPERATIONS ? studio.tooLarge(...OPERATIONS[pose]) : "");

/** What to say of a shape: one that is not at rest, or of a chart that was changed, is a preview. @param {Posed} posed */
export function wordsOf({ words, converged }) {
  return converged ? words : `${words}: a preview, not yet at rest`;
}

const SETTINGS = {
  yarnColours: /** @type {YarnColours} */ ("chart"),
  groups: /** @type {Groups} */ ("stitch"),
  block: 4,
  handPull: /** @type {HandPull} */ ("hand"),
  details: false,
  limbAround: /** @type {Direction} */ ("course"),
  girths: /** @type {GirthAt[] | null} */ (null),
  glove: /** @type {PlannedGlove | null} */ (null),
};

export class Seeing {
  constructor() {
    const settings = loadSettings(SETTINGS);
    this.yarnColours = new Signal(settings.yarnColours);
    this.groups = new Signal(settings.groups);
    /** Stitches on a side of a block. */
    this.block = new Signal(settings.block);
    /** At which the inspector tells the stretch. */
    this.handPull = new Signal(settings.handPull);
    /** Whether the inspector shows moduli and segments, too. */
    this.details = new Signal(settings.details);
    /** Whether strain crosses are drawn over the chart. */
    this.crosses = new Signal(false);
    /** Id of the region that the inspector describes; null for the whole chart. */
    this.region = new Signal(/** @type {string | null} */ (null));
    /** Of the curves in the inspector; follows the stretch test. */
    this.pull = new Signal(/** @type {import("../types.js").Direction} */ ("wale"));
    /** What the design is to be compared with when the comparison is opened next, such as "version 3". */
    this.against = new Signal(/** @type {string | null} */ (null));
    /** Id of a stretch test that the service has forgotten. */
    this.forgotten = new Signal(/** @type {string | null} */ (null));
    /** Whether the free edges of a stretched fabric curl. */
    this.curling = new Signal(false);
    this.pose = new Signal(/** @type {Pose} */ ("flat"));
    /** The shape of that pose; null while it is being computed, and if the fabric is flat. */
    this.posed = new Signal(/** @type {Posed | null} */ (null));
    /** The limb that the fabric is worn on, and what runs around it; no girths: those that fit. */
    this.limb = new Signal(
      /** @type {{direction: Direction, girths: GirthAt[] | null}} */ ({
        direction: settings.limbAround,
        girths: settings.girths,
      }),
    );
    /** The glove that was planned last: designs with its outline and stitches are worn on its hand. */
    this.glove = new Signal(settings.glove);
    /** The stitch that was clicked in the 3D view last. */
    this.clickedStitch = new Signal(/** @type {Cell | null} */ (null));
    this.yarnColours.listen((yarnColours) => saveSettings({ yarnColours }));
    this.handPull.listen((handPull) => saveSettings({ handPull }));
    this.details.listen((details) => saveSettings({ details }));
    this.groups.listen((groups) => saveSettings({ groups }));
    this.glove.listen((glove) => saveSettings({ glove }));
    this.limb.listen(({ direction, girths }) => saveSettings({ limbAround: direction, girths }));
    this.block.listen((block) => saveSettings({ block }));
  }

  /**
   * A glove was planned.
   *
   * @param {import("../types.js").GloveRequest} request
   * @param {Pick<import("../types.js").DesignDocument, "chart" | "outline">} design
   */
  planned(request, { chart, outline }) {
    if (outline) this.glove.value = { request, outline, chart: Grid.fromText(chart).text };
  }
}
