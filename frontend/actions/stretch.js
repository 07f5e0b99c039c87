/** The stretch test by keyboard. @import {Studio} from "../state/studio.js" */

import { byId } from "../elements/dom.js";
import { REST } from "../state/studio.js";
import { actionsOf } from "./action.js";

const action = actionsOf("Stretch test");
const enabled = (/** @type {Studio} */ studio) => studio.currentStretch() !== null;

export const STRETCH = [
  action("stretch", "Stretch the chart, or cancel", ["J"], { icon: "wale" }, () => byId("stretch-run").click()),
  action("play", "Play or pause the stretch", ["Shift+J"], { icon: "play", enabled }, () =>
    byId("stretch-play").click(),
  ),
  action("save-stretch", "Save the stretch test as a table (CSV)", [], { icon: "export", enabled }, () =>
    byId("stretch-save").click(),
  ),
  action("step-back", "One step of the stretch back", [","], { enabled }, ({ studio }) => {
    studio.step.value = Math.max(REST, studio.step.value - 1);
  }),
  action("step-on", "One step of the stretch on", ["."], { enabled }, ({ studio }) => {
    const last = (studio.currentStretch()?.strain.length ?? 1) - 1;
    studio.step.value = Math.min(last, studio.step.value + 1);
  }),
];
