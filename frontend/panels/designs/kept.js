/**
 * The service's name for the design in hand.
 *
 * @import {Keeper} from "../../sync/keeper.js"
 */

import { h } from "../../elements/dom.js";
import { icon } from "../../elements/icons.js";

/**
 * The name; the service gets the design now if it has not.
 *
 * @param {Keeper} keeper
 * @param {HTMLElement} status where it is said that the service cannot be reached
 * @param {string} unable what cannot be done until then
 * @returns {Promise<string | null>}
 */
export async function keptName(keeper, status, unable) {
  if (await keeper.flush()) return keeper.remoteId;
  status.replaceChildren(
    h("div", { class: "problem", role: "alert" }, icon("warning"), `The design is not at the service yet${unable}`),
  );
  return null;
}
