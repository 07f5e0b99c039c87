/**
 * Links to the design for others: to look at it, or to copy it.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {Share, ShareMode} from "../../types.js"
 * @import {Studio} from "../../state/studio.js"
 */

import { h } from "../../elements/dom.js";
import { icon } from "../../elements/icons.js";
import { linkTo } from "../../sync/address.js";
import { designs } from "../../sync/designs.js";
import { dialog } from "../../widgets/dialog.js";
import { listRow } from "../../widgets/listrow.js";
import { keptName } from "./kept.js";
import { ago } from "../../core/ago.js";
import { textButton } from "../../widgets/buttons.js";
import { attempt } from "../../widgets/problem.js";

/** @type {Record<ShareMode, [string, string]>} */
const MODES = {
  read: ["To look", "Anyone with the link sees the design as it is then, and can try changes that are not saved."],
  copy: ["To copy", "Anyone with the link can also make a copy of their own. Yours stays as it is."],
};

/** @param {Studio} _studio @param {ActionContext} context */
export function create(_studio, { keeper }) {
  /** @type {ShareMode} */ let mode = "read";
  const status = h("div", { class: "dialog-status", role: "status" });
  const list = h("ul", { class: "rows-list", id: "share-list" });
  const link = h("input", {
    class: "text-field grows shrinks-x rounded",
    id: "share-link",
    readOnly: true,
    "aria-label": "The link",
    onfocus: () => link.select(),
  });
  const copy = textButton(
    "copy",
    "Copy",
    () =>
      void navigator.clipboard?.writeText(link.value).then(
        () => (copied.textContent = "The link is on the clipboard."),
        () => link.select(),
      ),
  );
  const copied = h("p", { class: "muted" });
  const result = h(
    "div",
    { class: "stack gap-6", hidden: true },
    h("div", { class: "dialog-tools wrap gap-10" }, link, copy),
    copied,
  );

  const choices = h(
    "div",
    { class: "choices stack gap-8", role: "radiogroup", "aria-label": "What the link allows" },
    .../** @type {ShareMode[]} */ (["read", "copy"]).map((which) =>
      h(
        "label",
        { class: "choice flex gap-10 rounded" },
        h("input", {
          type: "radio",
          name: "share-mode",
          value: which,
          checked: which === mode,
          id: `share-${which}`,
          onchange: () => (mode = which),
        }),
        h("span", {}, h("strong", {}, MODES[which][0]), h("span", { class: "muted" }, MODES[which][1])),
      ),
    ),
  );
  const make = textButton(
    "share",
    "Make a link",
    async () => {
      const id = await remote();
      const share = id && (await attempt(status, () => designs.share(id, mode)));
      if (!share) return;
      link.value = linkTo(share.token);
      copied.textContent = "Copy it now: for safety, the link itself is shown only this once.";
      result.hidden = false;
      link.focus();
      await load();
    },
    { class: "button primary", id: "share-make" },
  );
  const element = dialog(
    "share-dialog",
    "Share this design",
    choices,
    h("div", { class: "dialog-buttons" }, make),
    result,
    status,
    list,
  );

  const remote = () => keptName(keeper, status, ", so it cannot be shared now.");
  const load = async () => {
    const id = keeper.remoteId;
    const listed = id ? await attempt(status, () => designs.shares(id), load) : { shares: [] };
    list.replaceChildren(...(listed?.shares ?? []).map(row));
  };
  /** @param {Share} share */
  const row = (share) =>
    listRow(
      icon("share"),
      MODES[share.mode][0],
      `made ${ago(share.created_at)}`,
      textButton(null, "Revoke", async () => {
        const id = keeper.remoteId;
        if (id && (await attempt(status, () => designs.unshare(id, share.id).then(() => true)))) await load();
      }),
    );

  return () => {
    status.replaceChildren();
    result.hidden = true;
    element.showModal();
    make.focus();
    void load();
  };
}
