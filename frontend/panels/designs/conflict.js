/**
 * The same parts of a design were changed here and elsewhere: which one stays?
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {Studio} from "../../state/studio.js"
 */

import { h } from "../../elements/dom.js";
import { dialog } from "../../widgets/dialog.js";
import { thumbnail } from "../../widgets/thumbnail.js";
import { attempt } from "../../widgets/problem.js";

/** @param {Studio} studio @param {ActionContext} context */
export function create(studio, { keeper }) {
  const status = h("div", { class: "dialog-status", role: "status" });
  const text = h("p", {});
  const sides = h("div", { class: "sides stack" });
  const element = dialog("conflict-dialog", "This design was changed elsewhere, too", text, sides, status);

  /** @param {"mine" | "theirs" | "both"} choice @param {string} label @param {string} note @param {string} style */
  const option = (choice, label, note, style = "button") =>
    h(
      "div",
      { class: "option stack gap-12" },
      h(
        "button",
        {
          class: style,
          id: `conflict-${choice}`,
          onclick: async () => {
            if ((await attempt(status, () => keeper.resolve(choice).then(() => true))) !== null) element.close();
          },
        },
        label,
      ),
      h("span", { class: "muted" }, note),
    );
  element.append(
    h(
      "div",
      { class: "options stack gap-8" },
      option("both", "Keep both", "Mine becomes a design of its own.", "button primary"),
      option("mine", "Keep mine", "Theirs stays as a version."),
      option("theirs", "Take theirs", "Mine can be brought back from Deleted for 30 days."),
    ),
  );
  return () => {
    const { value } = keeper.state;
    if (value.kind !== "conflict") return;
    const { theirs, parts } = value.conflict;
    text.textContent = `Both changed the ${parts.join(", the ")} in ways that cannot be merged. Whatever you choose, nothing is lost.`;
    sides.replaceChildren(side("Mine", studio.toDocument()), side("Theirs", theirs.document));
    status.replaceChildren();
    if (!element.open) element.showModal();
  };
}

/** @param {string} title @param {import("../../types.js").DesignDocument} design */
const side = (title, design) =>
  h(
    "figure",
    { class: "side-picture stack sunken gap-8" },
    thumbnail(design, { side: 150, label: `${title}: ${design.name}` }),
    h("figcaption", {}, h("strong", {}, title), h("span", { class: "muted" }, ` ${design.name}`)),
  );
