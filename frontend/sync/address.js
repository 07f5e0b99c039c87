/**
 * What the page's address asks for: `#design/…` one's own design, `#shared/…` a link that somebody
 * gave away. Neither reaches the service's logs, which matters for a link: whoever has it is let in.
 *
 * @import {Studio} from "../state/studio.js"
 * @import {Keeper} from "./keeper.js"
 */

import { ApiError } from "../api.js";
import { designs } from "./designs.js";

/**
 * Open what the address asks for, now and whenever it changes.
 *
 * @param {Studio} studio
 * @param {Keeper} keeper
 * @returns {boolean} whether it asks for something else than what is on show
 */
export function openAddressed(studio, keeper) {
  const open = () => {
    const [, kind, name] = location.hash.match(/^#(design|shared)\/([\w-]+)$/) ?? [];
    if (!name || (kind === "design" && name === keeper.remoteId)) return false;
    void (kind === "design" ? openDesign(name) : openLink(name));
    return true;
  };
  /** @param {string} id */
  const openDesign = (id) =>
    opening(async () => keeper.openKept(await designs.read(id)), "This design cannot be opened");
  /** @param {string} token */
  const openLink = (token) =>
    opening(async () => keeper.openShared(token, await designs.shared(token)), "This link does not work");

  /** @param {() => Promise<void>} work @param {string} title */
  const opening = async (work, title) => {
    const root = document.documentElement;
    root.dataset.opening = "";
    try {
      await work();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      keeper.showAddress();
      studio.tellProblem({ ...error.problem, title });
    } finally {
      delete root.dataset.opening;
    }
  };
  window.addEventListener("hashchange", open);
  const elsewhere = open();
  if (!elsewhere) keeper.showAddress();
  return elsewhere;
}

/** The address of a link to give away. @param {string} token */
export const linkTo = (token) => `${location.origin}${location.pathname}#shared/${token}`;
