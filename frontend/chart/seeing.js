/**
 * How the fabric and its mechanics are looked at: state of the panels that is no part of the design.
 *
 * @import {Cell} from "../core/raster.js"
 * @import {CurlResult} from "../types.js"
 *
 * @typedef {"chart" | "yarn" | "region" | "fabric" | "phase"} YarnColours of the 3D view: as the chart
 *   has them, or one of its own
 * @typedef {"stitch" | "block" | "region"} Groups what an extensibility rectangle stands for
 */

import { Signal } from "../core/signal.js";
import { loadSettings, saveSettings } from "../core/store.js";

const SETTINGS = {
  yarnColours: /** @type {YarnColours} */ ("chart"),
  groups: /** @type {Groups} */ ("stitch"),
  block: 4,
};

export class Seeing {
  constructor() {
    const settings = loadSettings(SETTINGS);
    this.yarnColours = new Signal(settings.yarnColours);
    this.groups = new Signal(settings.groups);
    /** Stitches on a side of a block. */
    this.block = new Signal(settings.block);
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
    /** Whether the fabric is shown as it lies, curled and folded. */
    this.lying = new Signal(false);
    /** Its shape; null while it is being computed. */
    this.curled = new Signal(/** @type {CurlResult | null} */ (null));
    /** The stitch that was clicked in the 3D view last. */
    this.found = new Signal(/** @type {Cell | null} */ (null));
    this.yarnColours.listen((yarnColours) => saveSettings({ yarnColours }));
    this.groups.listen((groups) => saveSettings({ groups }));
    this.block.listen((block) => saveSettings({ block }));
  }
}
