/**
 * Yarns of one's own: a list of them, a file of one, or what is known of one, from which it is made.
 *
 * @import {Studio} from "../../state/studio.js"
 * @import {MaterialSummary} from "../../types.js"
 */

import { h, remark } from "../../elements/dom.js";
import { download } from "../../services/exporter.js";
import { OWN, adopt, evidenceOf, isYarnFile, refresh, yarns } from "../../services/yarns.js";
import { iconButton, textButton } from "../../widgets/buttons.js";
import { dialog } from "../../widgets/dialog.js";
import { listRow } from "../../widgets/listrow.js";
import { swatchWay } from "./swatchway.js";
import { yarnMaker } from "./yarnmaker.js";
import { attempt, problemBox } from "../../widgets/problem.js";

/** @param {Studio} studio */
export function create(studio) {
  const status = h("div", { class: "dialog-status", role: "status" });
  const list = h("ul", { class: "rows-list", id: "yarns-list" });
  const file = h("input", {
    type: "file",
    id: "yarn-file",
    accept: ".json,application/json",
    class: "visually-hidden",
    onchange: async () => {
      const chosen = file.files?.[0];
      if (!chosen) return;
      file.value = "";
      const document = read(await chosen.text());
      if (!isYarnFile(document)) return say("This is not a yarn", `${chosen.name} is not a material file of Knitcore.`);
      if (await attempt(status, () => adopt(studio, document))) element.close();
    },
  });
  const maker = yarnMaker(studio, () => element.close());
  const way = swatchWay(studio, () => element.close());
  /** Show one of the two forms. @param {typeof maker | typeof way} form */
  const alone = (form) => {
    for (const { element: other } of [maker, way]) other.hidden = other !== form.element;
  };

  const element = dialog(
    "yarns-dialog",
    "Own yarns",
    remark(
      "Everybody who uses this service can knit with them; only the person who added a yarn can change or remove it.",
    ),
    status,
    list,
    h(
      "div",
      { class: "dialog-tools wrap gap-10" },
      textButton("camera", "Measure it at home …", () => (alone(way), way.open()), { id: "yarn-swatch" }),
      textButton("plus", "From stretch tests …", () => (alone(maker), maker.open(null)), { id: "yarn-new" }),
      h("label", { class: "button", for: "yarn-file" }, "From a yarn file …"),
      file,
    ),
    maker.element,
    way.element,
  );

  /** @param {string} title @param {string} detail */
  const say = (title, detail) => status.replaceChildren(problemBox({ title, detail }));
  const show = () => {
    const own = studio.materials.value.filter(({ id }) => id.startsWith(OWN));
    list.replaceChildren(...own.map((yarn) => item(yarn)));
    if (!own.length) list.append(h("li", { class: "muted" }, "None yet."));
  };
  /** @param {MaterialSummary} yarn */
  const item = ({ id, name: label, description, fabrics, added_by_you: mine }) =>
    listRow(
      null,
      label,
      [description, `${Object.keys(fabrics).length} of 4 fabrics`].filter(Boolean).join(" · "),
      evidence(id),
      mine &&
        textButton(
          "pencil",
          "Change",
          async () => {
            const document = await attempt(status, () => yarns.file(id));
            if (document) (alone(maker), maker.open(document));
          },
          { "aria-label": `Change ${label}` },
        ),
      textButton(
        "export",
        "Save",
        async () => {
          const document = await attempt(status, () => yarns.file(id));
          if (!document) return;
          const text = `${JSON.stringify(document, null, 1)}\n`;
          download(`${document.identifier}.json`, new Blob([text], { type: "application/json" }));
        },
        { "aria-label": `Save ${label} as a file` },
      ),
      mine &&
        iconButton("trash", `Remove ${label}`, async () => {
          const gone = await attempt(status, () => yarns.remove(id).then(() => true));
          if (gone) await refresh(studio);
        }),
    );
  /** What a yarn's figures rest on, asked for when it is opened. @param {string} id */
  const evidence = (id) => {
    const notes = h("ul", { class: "notes" });
    return h(
      "details",
      {
        class: "row-more small",
        ontoggle: async () => {
          if (notes.hasChildNodes()) return;
          const document = await attempt(status, () => yarns.file(id));
          if (document) notes.replaceChildren(...evidenceOf(document).map((line) => h("li", {}, line)));
        },
      },
      h("summary", {}, "Evidence"),
      notes,
    );
  };
  studio.materials.watch(show);
  return () => {
    status.replaceChildren();
    const { droppedTest } = studio;
    studio.droppedTest = null;
    if (!element.open) element.showModal();
    if (!droppedTest) return;
    if (maker.element.hidden) (alone(maker), maker.open(null));
    maker.offer(droppedTest);
  };
}

/** @param {string} text @returns {unknown} null if it is not JSON */
function read(text) {
  try {
    return JSON.parse(text);
  } catch (error) {
    if (error instanceof SyntaxError) return null;
    throw error;
  }
}
