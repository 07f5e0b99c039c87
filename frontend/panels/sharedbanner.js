/**
 * The banner over somebody else's design.
 *
 * @import {ActionContext} from "../actions/action.js"
 */

import { ApiError } from "../api.js";
import { h } from "../elements/dom.js";
import { icon } from "../elements/icons.js";
import { designs } from "../sync/designs.js";
import { textButton } from "../widgets/buttons.js";

/** @param {HTMLElement} host @param {ActionContext} context */
export function sharedBanner(host, { keeper, studio }) {
  keeper.state.watch((state) => {
    host.hidden = state.kind !== "shared";
    if (state.kind !== "shared") return;
    host.replaceChildren(
      icon("share"),
      h("strong", {}, "Shared with you."),
      "Look, paint and stretch as you like; what you change is not saved.",
      h("span", { class: "spacer" }),
    );
    if (state.mode === "copy") {
      host.append(textButton("copy", "Make my copy", () => void copy(state.token), { id: "shared-copy" }));
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
