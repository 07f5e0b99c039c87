/**
 * All designs that the service keeps: open, rename, duplicate, delete, and bring back.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {DesignSummary} from "../../types.js"
 * @import {Studio} from "../../state/studio.js"
 */

import { h } from "../../elements/dom.js";
import { icon } from "../../elements/icons.js";
import { designs } from "../../sync/designs.js";
import { DESIGN_NAME } from "../../core/names.js";
import { iconButton, textButton } from "../../widgets/buttons.js";
import { nameField, segmented } from "../../widgets/fields.js";
import { dialog } from "../../widgets/dialog.js";
import { thumbnail } from "../../widgets/thumbnail.js";
import { ago } from "../../core/ago.js";
import { attempt } from "../../widgets/problem.js";

/** @param {Studio} studio @param {ActionContext} context */
export function create(studio, context) {
  const { keeper } = context;
  let deleted = false;
  /** @type {string | null} */ let cursor = null;

  const status = h("div", { class: "dialog-status", role: "status" });
  const list = h("ul", { class: "cards stack", id: "designs-list" });
  const search = h("input", {
    type: "search",
    class: "text-field grows shrinks-x rounded",
    id: "designs-search",
    placeholder: "Find by name",
    "aria-label": "Find a design by its name",
    oninput: () => filter(),
  });
  const more = h("button", { class: "button", onclick: () => void load() }, "Show more");
  const tabs = segmented(
    "Which designs",
    [
      [false, "Designs", { id: "designs-kept" }],
      [true, "Deleted", { id: "designs-deleted" }],
    ],
    deleted,
    (which) => {
      deleted = which;
      void reload();
    },
  );
  const element = dialog(
    "designs-dialog",
    "My designs",
    h(
      "div",
      { class: "dialog-tools wrap gap-10" },
      search,
      tabs.element,
      h("span", { class: "spacer" }),
      textButton("gallery", "Examples", () => leave(() => context.open("gallery")), { id: "designs-gallery" }),
      textButton("plus", "New", () => leave(() => context.open("gallery")), {
        class: "button primary",
        id: "designs-new",
      }),
    ),
    status,
    list,
    more,
  );
  /** @param {() => void} next */
  const leave = (next) => {
    element.close();
    next();
  };

  const pictures = new IntersectionObserver((entries) => {
    for (const { isIntersecting, target } of entries) {
      if (!isIntersecting) continue;
      pictures.unobserve(target);
      void picture(/** @type {HTMLElement} */ (target));
    }
  });
  /** @param {HTMLElement} frame */
  const picture = async (frame) => {
    const { id } = frame.dataset;
    if (!id || deleted) return;
    // A missing picture is not reported: the design's name is enough.
    const kept = await designs.read(id).catch(() => null);
    if (kept) frame.replaceChildren(thumbnail(kept.document));
  };

  const reload = async () => {
    cursor = null;
    list.replaceChildren(...Array.from({ length: 3 }, () => h("li", { class: "card loading", "aria-hidden": "true" })));
    await load();
  };
  const load = async () => {
    const page = await attempt(status, () => designs.list({ cursor, deleted }), load);
    if (cursor === null) list.replaceChildren();
    more.hidden = !page?.next_cursor;
    if (!page) return;
    cursor = page.next_cursor;
    list.append(...page.designs.map(card));
    filter();
  };
  const filter = () => {
    const query = search.value.trim().toLowerCase();
    const items = /** @type {HTMLElement[]} */ ([...list.querySelectorAll(".card")]);
    for (const item of items) item.hidden = !(item.dataset.name ?? "").includes(query);
    const none = items.every(({ hidden }) => hidden);
    list.querySelector(".empty")?.remove();
    if (!none) return;
    const text = query
      ? ["No design has that in its name.", ""]
      : deleted
        ? ["Nothing was deleted.", "Deleted designs stay here for 30 days."]
        : ["No designs yet.", "Paint on the chart and it is saved here automatically, or begin with an example."];
    list.append(h("li", { class: "empty" }, h("strong", {}, text[0]), h("p", { class: "muted" }, text[1])));
  };

  /** @param {DesignSummary} design */
  const card = (design) => {
    const name = h(
      "span",
      { class: "card-name ellipsis", title: design.name, onclick: () => open.click() },
      design.name,
    );
    const here = design.id === keeper.remoteId;
    const frame = h("span", { class: "card-picture centred muted", "data-id": design.id }, deleted && icon("trash"));
    pictures.observe(frame);
    const open = h(
      "button",
      {
        class: "card-open sunken",
        disabled: deleted,
        "aria-label": `Open ${design.name}`,
        "aria-current": here ? "true" : undefined,
        onclick: async () => {
          if (here) return element.close();
          const kept = await attempt(status, () => designs.read(design.id));
          if (kept) leave(() => keeper.openKept(kept));
        },
      },
      frame,
    );
    const facts = h(
      "span",
      { class: "card-facts muted figures" },
      `${design.columns} × ${design.rows} · ${here ? "open now" : ago(design.deleted_at ?? design.changed_at)}`,
    );
    const item = h(
      "li",
      { class: here ? "card here" : "card", "data-name": design.name.toLowerCase() },
      open,
      name,
      facts,
    );
    /** @param {import("../../elements/icons.js").IconName} sign @param {string} label @param {() => void} perform */
    const tool = (sign, label, perform) => iconButton(sign, `${label}: ${design.name}`, perform, { title: label });
    item.append(
      h(
        "span",
        { class: "card-tools flex gap-2" },
        ...(deleted
          ? [textButton("undo", "Bring back", () => void recover(design, item))]
          : [
              tool("pencil", "Rename", () => rename(design, name)),
              tool("copy", "Duplicate", () => void duplicate(design)),
              tool("trash", "Delete", () => void remove(design, item)),
            ]),
      ),
    );
    return item;
  };

  /** @param {DesignSummary} design @param {HTMLElement} name */
  const rename = (design, name) => {
    const field = nameField(
      { class: "text-field card-rename grows shrinks-x rounded", value: design.name, "aria-label": "New name" },
      DESIGN_NAME,
    );
    const done = async () => {
      const newName = field.value.trim();
      field.replaceWith(name);
      if (!newName || newName === design.name) return;
      if (design.id === keeper.remoteId)
        studio.name.value = newName; // the keeper delivers it
      else {
        const kept = await attempt(status, () => designs.rename(design.id, newName, design.revision));
        if (!kept) return;
        design.revision = kept.revision;
      }
      design.name = name.textContent = newName;
    };
    field.addEventListener("keydown", (event) => {
      event.stopPropagation();
      if (event.key === "Enter") field.blur();
      if (event.key === "Escape") {
        event.preventDefault();
        field.value = design.name;
        field.blur();
      }
    });
    field.addEventListener("blur", () => void done(), { once: true });
    name.replaceWith(field);
    field.select();
  };

  /** @param {DesignSummary} design */
  const duplicate = async (design) => {
    if (design.id === keeper.remoteId) await keeper.flush();
    if (await attempt(status, () => designs.duplicate(design.id))) await reload();
  };

  /** @param {DesignSummary} design @param {HTMLElement} item */
  const remove = async (design, item) => {
    if ((await attempt(status, () => designs.remove(design.id).then(() => true))) === null) return;
    const next = /** @type {HTMLElement | null} */ (item.nextElementSibling ?? item.previousElementSibling);
    item.remove();
    filter();
    status.replaceChildren(
      h(
        "div",
        { class: "notice line spread rounded gap-12" },
        h("span", {}, `“${design.name}” was deleted. It stays under Deleted for 30 days.`),
        textButton("undo", "Undo", () => void recover(design, null), { id: "designs-undo" }),
      ),
    );
    /** @type {HTMLElement | null | undefined} */ (next?.querySelector("button"))?.focus();
  };

  /** @param {DesignSummary} design @param {HTMLElement | null} item */
  const recover = async (design, item) => {
    if (!(await attempt(status, () => designs.recover(design.id)))) return;
    item?.remove();
    if (item) filter();
    else await reload();
  };

  return () => {
    search.value = "";
    element.showModal();
    search.focus();
    void keeper.flushChanges().then(reload);
  };
}
