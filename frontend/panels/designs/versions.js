/**
 * States of the design that were kept under a name: keep another one, look at them, go back.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {VersionSummary} from "../../types.js"
 * @import {Studio} from "../../state/studio.js"
 */

import { h, remark } from "../../elements/dom.js";
import { icon } from "../../elements/icons.js";
import { designs } from "../../sync/designs.js";
import { textButton } from "../../widgets/buttons.js";
import { nameField } from "../../widgets/fields.js";
import { dialog } from "../../widgets/dialog.js";
import { thumbnail } from "../../widgets/thumbnail.js";
import { listRow } from "../../widgets/listrow.js";
import { keptName } from "./kept.js";
import { ago } from "../../core/ago.js";
import { attempt } from "../../widgets/problem.js";

/** @param {Studio} studio @param {ActionContext} context */
export function create(studio, { keeper, open }) {
  const status = h("div", { class: "dialog-status", role: "status" });
  const list = h("ol", { class: "rows-list", id: "versions-list" });
  const name = nameField({
    class: "text-field grows shrinks-x rounded",
    id: "version-name",
    placeholder: "Name of this state, such as “before the cuff”",
    "aria-label": "Name of this state",
  });
  const form = h(
    "form",
    {
      class: "dialog-tools wrap gap-10",
      onsubmit: async (/** @type {SubmitEvent} */ event) => {
        event.preventDefault();
        const id = await remote();
        const versionName =
          name.value.trim() || new Date().toLocaleString("en", { dateStyle: "medium", timeStyle: "short" });
        if (id && (await attempt(status, () => designs.keepVersion(id, versionName)))) {
          name.value = "";
          await load();
        }
      },
    },
    name,
    h("button", { class: "button primary", type: "submit", id: "version-keep" }, icon("pin"), "Save version"),
  );
  const element = dialog(
    "versions-dialog",
    "Versions",
    remark(
      "Every stroke is saved automatically. A version is a state that you can come back to; restoring one also saves the present state.",
    ),
    form,
    status,
    list,
  );

  const remote = () => keptName(keeper, status, "; versions are saved there.");
  const load = async () => {
    const id = keeper.remoteId;
    const listed = id ? await attempt(status, () => designs.versions(id), load) : { versions: [] };
    if (!listed) return;
    const { versions } = listed;
    list.replaceChildren(...versions.reverse().map(row));
    if (!versions.length) list.append(h("li", { class: "empty" }, h("strong", {}, "No versions yet.")));
  };

  /** @param {VersionSummary} version */
  const row = (version) => {
    const picture = h("span", { class: "row-picture centred sunken" });
    const id = keeper.remoteId ?? "";
    void designs.version(id, version.number).then(
      ({ document }) => picture.replaceChildren(thumbnail(document, { side: 44 })),
      () => {}, // the name is enough
    );
    return listRow(
      picture,
      version.name,
      `${ago(version.created_at)}${version.automatic ? " · saved automatically" : ""}`,
      textButton(
        "compare",
        "Compare",
        () => {
          studio.seeing.against.value = `version ${version.number}`;
          element.close();
          open("compare");
        },
        { "aria-label": `Compare with ${version.name}` },
      ),
      textButton(
        null,
        "Restore",
        async () => {
          const known = await remote();
          const kept = known && (await attempt(status, () => designs.restore(known, version.number, keeper.revision)));
          if (!kept) return;
          keeper.takeOver(kept);
          element.close();
          studio.tell(`“${version.name}” is restored. The state before it is a version, too.`);
        },
        { "aria-label": `Restore ${version.name}` },
      ),
    );
  };

  return () => {
    status.replaceChildren();
    element.showModal();
    name.focus();
    void load();
  };
}
