/**
 * Says whether the design is kept, and leads to what is to be done if it is not.
 *
 * @import {ActionContext} from "../actions/action.js"
 * @import {KeepState} from "../keeping/keeper.js"
 * @import {IconName} from "../icons.js"
 */

import { ApiError } from "../api.js";
import { h } from "../dom.js";
import { icon } from "../icons.js";
import { designs } from "../keeping/designs.js";

/** @type {Record<KeepState["kind"], {label: string, icon: IconName, title: string}>} */
const LOOKS = {
  new: { label: "", icon: "check", title: "" },
  waiting: { label: "Saving …", icon: "saving", title: "Kept in this browser; on its way to the service" },
  sending: { label: "Saving …", icon: "saving", title: "Kept in this browser; on its way to the service" },
  kept: { label: "Saved", icon: "check", title: "Kept at the service. Click for versions." },
  offline: {
    label: "Kept here",
    icon: "offline",
    title: "The service cannot be reached: kept in this browser, and delivered when it is back",
  },
  refused: { label: "Not saved", icon: "warning", title: "The service does not keep this; it is kept in this browser" },
  conflict: { label: "Choose …", icon: "warning", title: "Changed elsewhere, too: choose what stays" },
  shared: { label: "Shared", icon: "share", title: "Opened by a link; changes are not kept" },
};

/** @param {ActionContext} context */
export function keptchip(context) {
  const { keeper } = context;
  const chip = h("button", {
    class: "kept quiet",
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
  return chip;
}

/**
 * The banner over somebody else's design.
 *
 * @param {HTMLElement} host
 * @param {ActionContext} context
 */
export function sharedbanner(host, { keeper, studio }) {
  keeper.state.watch((state) => {
    host.hidden = state.kind !== "shared";
    if (state.kind !== "shared") return;
    host.replaceChildren(
      icon("share"),
      h("strong", {}, "Shared with you."),
      "Look, paint and stretch as you like; what you change is not kept.",
      h("span", { class: "spacer" }),
    );
    if (state.mode === "copy") {
      host.append(
        h(
          "button",
          { class: "button", id: "shared-copy", onclick: () => void copy(state.token) },
          icon("copy"),
          "Make my copy",
        ),
      );
    }
  });

  /** @param {string} token */
  const copy = async (token) => {
    const tried = studio.toDocument();
    try {
      const kept = await designs.copyShared(token);
      keeper.openKept(kept);
      studio.follow({ ...tried, name: kept.document.name });
      studio.tell("It is yours now, with what you have changed in it.");
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      studio.tellProblem(error.problem);
    }
  };
}
