/**
 * Says whether the design is kept, and leads to what is to be done if it is not.
 *
 * @import {ActionContext} from "../actions/action.js"
 * @import {KeepState} from "../sync/keeper.js"
 * @import {IconName} from "../elements/icons.js"
 */

import { h } from "../elements/dom.js";
import { icon } from "../elements/icons.js";

/** @type {Record<KeepState["kind"], {label: string, icon: IconName, title: string}>} */
const LOOKS = {
  new: { label: "", icon: "check", title: "" },
  waiting: { label: "Saving …", icon: "saving", title: "Saved in this browser; on its way to the service" },
  sending: { label: "Saving …", icon: "saving", title: "Saved in this browser; on its way to the service" },
  kept: { label: "Saved", icon: "check", title: "Saved by the service. Click for versions." },
  offline: {
    label: "Saved here only",
    icon: "offline",
    title: "The service cannot be reached: saved in this browser, and delivered when it is back",
  },
  refused: {
    label: "Not saved",
    icon: "warning",
    title: "The service does not save this; it is saved in this browser only",
  },
  conflict: { label: "Choose …", icon: "warning", title: "Also changed elsewhere: choose which to use" },
  shared: { label: "Shared", icon: "share", title: "Opened by a link; changes are not saved" },
};

/** @param {ActionContext} context */
export function saveState(context) {
  const { keeper } = context;
  const chip = h("button", {
    class: "kept quiet bare inline small nowrap muted gap-5",
    id: "kept",
    onclick: () => {
      const { value } = keeper.state;
      if (value.kind === "conflict") context.open("conflict");
      else if (value.kind === "refused") context.studio.tellProblem(value.problem);
      else context.open("versions");
    },
  });
  let shown = "";
  keeper.state.watch(({ kind }) => {
    const { label, icon: sign, title } = LOOKS[kind];
    chip.hidden = !label;
    chip.dataset.state = kind;
    if (shown !== label) chip.replaceChildren(icon(sign), h("span", {}, label));
    shown = label;
    chip.title = title;
    if (kind === "conflict") context.open("conflict");
  });
  const others = h("span", { class: "others inline small nowrap muted gap-5", id: "others", role: "status" });
  keeper.windows.others.watch((count) => {
    others.hidden = count === 0;
    const words = count === 1 ? "open in another window" : `open in ${count} other windows`;
    others.replaceChildren(icon("copy"), h("span", { class: "label" }, words));
    others.title = `This design is ${words}: strokes there come here at once`;
  });
  return h("span", { class: "inline gap-4" }, chip, others);
}
