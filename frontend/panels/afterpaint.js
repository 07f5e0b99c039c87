/**
 * What the page has once it is painted: the numbers, and what answers gestures that come later.
 *
 * @import {ActionContext} from "../actions/action.js"
 */

import { byId, isTyping, nextTask } from "../elements/dom.js";
import { startPoser } from "../services/poser.js";
import { startRelaxer } from "../services/relaxer.js";
import { tips } from "../widgets/tips.js";
import { selectionbar } from "./chart/selectionbar.js";
import { listenToImports } from "./dialogs/importer.js";
import { inspector } from "./inspector/inspector.js";
import { sharedBanner } from "./sharedbanner.js";

/** @param {ActionContext} context @returns {() => void} draws the numbers again in other colours */
export function afterPaint(context) {
  const { studio } = context;
  const redraw = inspector(byId("inspector"), studio);
  void nextTask().then(() => {
    startPoser(studio);
    startRelaxer(studio);
    selectionbar(byId("chart-host"), context);
    sharedBanner(byId("shared"), context);
    tips();
    listenToImports(context, isTyping);
  });
  return redraw;
}
