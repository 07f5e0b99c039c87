/**
 * The design's name, undo and redo, size, material, import, export, theme, help.
 *
 * @import {ActionContext} from "../actions/action.js"
 * @import {Studio} from "../state/studio.js"
 * @import {MaterialSummary} from "../types.js"
 */

import { shown, withKey } from "../core/pointing.js";
import { action } from "../actions/registry.js";
import { DESIGN_NAME, shortName } from "../core/names.js";
import { h } from "../elements/dom.js";
import { icon } from "../elements/icons.js";
import { actionButton, iconButton } from "../widgets/buttons.js";
import { isComplete } from "../state/studio.js";
import { saveState } from "./savestate.js";
import { menu } from "../widgets/menu.js";

/** @param {HTMLElement} host @param {Studio} studio @param {ActionContext} context */
export function topbar(host, studio, context) {
  const name = h("input", {
    class: "design-name rounded",
    type: "text",
    value: studio.name.value,
    size: 18,
    spellcheck: false,
    "aria-label": "Name of the design",
    onchange: () => {
      studio.name.value = keptName(studio, name.value) || "Untitled";
      name.value = studio.name.value;
    },
    onkeydown: (/** @type {KeyboardEvent} */ { key }) => {
      if (key === "Enter" || key === "Escape") name.blur();
    },
  });

  studio.name.watch((value) => {
    name.value = value;
    name.title = value; // a long one does not fit
  });

  /** @param {string} id @param {string} [text] */
  const button = (id, text) => {
    const described = action(id);
    const { label, enabled } = described;
    const look = text ? "button quiet" : "button quiet icon-only";
    const words = text && h("span", { class: "label" }, text);
    const element = actionButton(described, context, look, { "aria-label": text ?? label }, words);
    if (enabled) {
      const update = () => (element.disabled = !enabled(studio));
      studio.document.onSettle(update);
      update();
    }
    return element;
  };

  const size = h("button", {
    class: "button quiet figures",
    id: "chart-size",
    title: withKey("Size and new chart", "N"),
    onclick: () => context.open("resize"),
  });
  const showSize = () => {
    const { columns, rows } = studio.document.grid;
    size.replaceChildren(
      icon("resize"),
      h("span", { title: "Stitches × rows" }, `${columns} × ${rows}`),
      h("span", { class: "visually-hidden" }, "change size"),
    );
  };
  studio.document.onChange(({ resized }) => resized && showSize());
  showSize();

  host.append(
    designsMenu(context),
    name,
    saveState(context),
    h("div", { class: "group flex gap-2" }, button("undo"), button("redo")),
    size,
    h("div", { class: "spacer" }),
    materialMenu(studio, context),
    button("import", "Import"),
    button("share", "Share"),
    exportMenu(studio, context),
    h("div", { class: "group flex gap-2" }, button("theme"), button("help")),
    accountButton(studio, context),
  );
}

/** A name as the service keeps it; what is cut off is said. @param {Studio} studio @param {string} text */
function keptName(studio, text) {
  const name = shortName(text, DESIGN_NAME);
  if (name !== text.trim()) studio.tell(`The name is cut to ${DESIGN_NAME} characters: “${name}”.`);
  return name;
}

/**
 * Who is signed in; nothing where the service asks for no login.
 *
 * @param {Studio} studio
 * @param {ActionContext} context
 */
function accountButton({ user }, context) {
  const name = h("span", { class: "ellipsis" });
  const element = h(
    "button",
    {
      class: "button quiet",
      id: "action-account",
      title: "Your account",
      onclick: () => context.open("account"),
    },
    icon("person"),
    h("span", { class: "visually-hidden" }, "Account:"),
    name,
  );
  user.watch((known) => {
    element.hidden = known === null;
    name.textContent = known;
  });
  return element;
}

/**
 * On a first visit, in the free middle of the bar, where it covers nothing.
 *
 * @param {HTMLElement} host
 * @param {ActionContext} context
 */
export function offerTour(host, { open }) {
  const offer = h(
    "div",
    { class: "tour-offer flex rounded gap-2", id: "tour-offer" },
    h(
      "button",
      { class: "button quiet", onclick: () => (offer.remove(), open("tour")) },
      icon("tour"),
      h("span", { class: "wide" }, "New here?"),
      "Take the tour",
    ),
    iconButton("close", "Dismiss", () => offer.remove()),
  );
  host.querySelector(".spacer")?.before(offer);
}

/** @param {Studio} studio @param {ActionContext} context */
function materialMenu(studio, context) {
  const label = h("span", { class: "ellipsis" }, "Yarn");
  const { root, setItems } = menu({
    id: "material",
    label: "Yarn",
    content: [h("span", { class: "muted label" }, "Yarn"), label, icon("down")],
    class: "button material-button",
  });
  const show = () => {
    const all = studio.materials.value;
    label.textContent = studio.yarn?.name ?? studio.materialId.value;
    label.title = label.textContent;
    setItems([
      item(action("yarns"), context), // first: the list is longer than a small screen
      null,
      ...all.map((material) => ({
        id: `material-${material.id}`,
        content: materialItem(material),
        checked: material.id === studio.materialId.value,
        disabled: !isComplete(material),
        perform: () => (studio.materialId.value = material.id),
      })),
    ]);
  };
  studio.materials.watch(show);
  studio.materialId.listen(show);
  return root;
}

/** @param {MaterialSummary} material */
function materialItem({ name, description, fabrics }) {
  const gauge = fabrics.stockinette;
  const stitches =
    gauge?.stitch_course_mm && gauge.stitch_wale_mm
      ? `${(100 / gauge.stitch_course_mm).toFixed(0)} sts × ${(100 / gauge.stitch_wale_mm).toFixed(0)} rows per 10 cm`
      : "";
  return h(
    "span",
    { class: "menu-lines stack" },
    h("span", {}, name),
    h(
      "span",
      { class: "muted figures" },
      isComplete({ fabrics })
        ? [description, stitches].filter(Boolean).join(" · ")
        : `Only ${Object.keys(fabrics).join(", ")} known: open Own yarns and add bending stiffness and yarn per stitch, or tests of the other fabrics`,
    ),
  );
}

/** @param {Studio} studio @param {ActionContext} context */
function exportMenu(studio, context) {
  const { root, setItems } = menu({
    id: "export",
    label: "Export",
    content: [icon("export"), h("span", { class: "label" }, "Export")],
    class: "button primary",
  });
  const files = () => import("../services/exporter.js");
  setItems([
    item(action("project-file"), context, "Project file (.json)"),
    {
      id: "export-text",
      content: "Chart as text (.txt)",
      perform: () => void files().then(({ exportText }) => exportText(studio)),
    },
    {
      id: "export-copy",
      content: "Copy the text",
      perform: () =>
        void navigator.clipboard.writeText(studio.document.text).then(
          () => studio.tell("The chart's text is on the clipboard."),
          () => studio.tell("The browser does not allow copying; export as a file instead."),
        ),
    },
    {
      id: "export-image",
      content: "Picture, one pixel per stitch (.png)",
      perform: () => void files().then(({ exportPixels }) => exportPixels(studio)),
    },
    null,
    item(action("exports"), context, "Written rows, PDF, knitout, 3D …"),
  ]);
  return root;
}

/**
 * An action as an item of a menu.
 *
 * @param {import("../actions/action.js").Action} action
 * @param {ActionContext} context
 * @param {string} [label]
 */
const item = ({ id, label: own, keys, perform }, context, label = own) => ({
  id: `menu-${id}`,
  content: h("span", { class: "menu-line line spread grows" }, label, keys[0] && h("kbd", {}, shown(keys[0]))),
  perform: () => perform(context),
});

/** @param {ActionContext} context */
function designsMenu(context) {
  const { root, setItems } = menu({
    id: "designs",
    label: "Designs",
    content: [
      h("img", { src: "/static/icon.svg", alt: "", width: 26, height: 26 }),
      h("span", { class: "visually-hidden" }, "Knitcore: designs and help"),
      icon("down"),
    ],
    class: "button quiet brand flex",
  });
  /** @param {string} id */
  const menuItem = (id) => item(action(id), context);
  setItems([
    ...["gallery", "garments", "open-find", "open-atlas"].map(menuItem),
    null,
    ...["designs", "duplicate"].map(menuItem),
    null,
    ...["knit-along", "versions", "compare", "share"].map(menuItem),
    null,
    ...["import", "project-file"].map(menuItem),
    null,
    ...["palette", "tour", "help"].map(menuItem),
  ]);
  return root;
}
