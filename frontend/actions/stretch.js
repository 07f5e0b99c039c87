/**
 * The stretch test by keyboard.
 *
 * @import {Action} from "./action.js"
 */

import { byId } from "../elements/dom.js";
import { REST } from "../state/studio.js";

/** @type {Action[]} */
export const STRETCH = [
  {
    id: "stretch",
    label: "Stretch the chart, or cancel",
    group: "Stretch test",
    icon: "wale",
    keys: ["J"],
    perform: () => byId("stretch-run").click(),
  },
  {
    id: "play",
    label: "Play or pause the stretch",
    group: "Stretch test",
    icon: "play",
    keys: ["Shift+J"],
    enabled: (studio) => studio.currentStretch() !== null,
    perform: () => byId("stretch-play").click(),
  },
  {
    id: "save-stretch",
    label: "Save the stretch test as a table (CSV)",
    group: "Stretch test",
    icon: "export",
    keys: [],
    enabled: (studio) => studio.currentStretch() !== null,
    perform: () => byId("stretch-save").click(),
  },
  {
    id: "step-back",
    label: "One step of the stretch back",
    group: "Stretch test",
    keys: [","],
    enabled: (studio) => studio.currentStretch() !== null,
    perform: ({ studio }) => (studio.step.value = Math.max(REST, studio.step.value - 1)),
  },
  {
    id: "step-on",
    label: "One step of the stretch on",
    group: "Stretch test",
    keys: ["."],
    enabled: (studio) => studio.currentStretch() !== null,
    perform: ({ studio }) => {
      const last = (studio.currentStretch()?.strain.length ?? 1) - 1;
      studio.step.value = Math.min(last, studio.step.value + 1);
    },
  },
];
