/**
 * Who is signed in, in which browsers, and how much of the limits of one user is used.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {SessionSummary, SignedIn} from "../../types.js"
 * @import {Studio} from "../../state/studio.js"
 */

import { api } from "../../api.js";
import { ago } from "../../core/ago.js";
import { thousands } from "../../core/format.js";
import { h } from "../../elements/dom.js";
import { nameOf } from "../../services/account.js";
import { dialog } from "../../widgets/dialog.js";
import { listRow } from "../../widgets/listrow.js";
import { textButton } from "../../widgets/buttons.js";
import { table, tableRow } from "../../widgets/table.js";
import { attempt } from "../../widgets/problem.js";

/** @param {number} unit @returns {(n: number) => string} */
const decimal = (unit) => (n) => thousands(n / unit);
/** Limits that are shown, in words, and how their numbers are written. */
const LIMITS = /** @type {const} */ ([
  ["designs", "Designs, with those deleted in the last 30 days", thousands],
  ["kept_bytes", "Designs and their versions, MB", decimal(1e6)],
  ["versions", "Versions of one design, at most", thousands],
  ["links", "Links to one design, at most", thousands],
  ["materials", "Own yarns", thousands],
  ["job_bytes", "Requests of jobs, MB", decimal(1e6)],
  ["cpu_s", "Computing time per day, hours", decimal(3600)],
  ["memory_bytes", "Memory of running computations, GB", decimal(1e9)],
  ["jobs", "Jobs that wait", thousands],
  ["views", "3D views", thousands],
  ["view_stitches", "Stitches in 3D views", thousands],
  ["streams", "Jobs and views that are followed", thousands],
  ["connections", "Requests at once, with this one", thousands],
]);

/** @param {Studio} _studio @param {ActionContext} context */
export function create(_studio, { keeper }) {
  const status = h("div", { class: "dialog-status", role: "status" });
  const who = h("p", {});
  const list = h("ol", { class: "rows-list", id: "sessions" });
  const used = h("tbody", {});
  const element = dialog(
    "account-dialog",
    "Your account",
    who,
    status,
    h("h3", {}, "Browsers that are signed in"),
    list,
    h("h3", {}, "What you use"),
    table({ class: "figures use full-width" }, ["", "used", "of"], used),
    h(
      "div",
      { class: "dialog-buttons" },
      h("button", { class: "button primary", id: "sign-out", onclick: () => void signOut() }, "Sign out"),
    ),
  );

  const load = async () => {
    const signedIn = await attempt(status, api.session, load);
    if (signedIn) show(signedIn);
  };

  /** @param {SignedIn} signedIn */
  const show = (signedIn) => {
    who.replaceChildren(
      "You are signed in",
      ...(signedIn.user === "local" ? [] : [" as ", h("strong", {}, nameOf(signedIn))]),
      ".",
    );
    list.replaceChildren(...signedIn.sessions.map(row));
    used.replaceChildren(
      ...LIMITS.filter(([name]) => name in signedIn.use).map(([name, text, written]) =>
        tableRow(text, written(signedIn.use[name].used), written(signedIn.use[name].most)),
      ),
    );
  };

  /** @param {SessionSummary} session */
  const row = ({ id, created_at, is_this }) =>
    listRow(
      null,
      is_this ? "This browser" : "Another browser",
      `signed in ${ago(created_at)}`,
      !is_this &&
        textButton(
          null,
          "End",
          async () => {
            await attempt(status, () => api.endSession(id));
            await load();
          },
          { "aria-label": `End the session of the browser that signed in ${ago(created_at)}` },
        ),
    );

  const signOut = async () => {
    await keeper.flushChanges();
    const done = await attempt(status, async () => {
      await api.signOut();
      return true;
    });
    if (!done) return;
    keeper.end();
    location.replace("/");
  };

  return () => {
    element.showModal();
    void load();
  };
}
