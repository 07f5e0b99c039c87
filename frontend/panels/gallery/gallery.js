/**
 * A new design: an empty chart, an example, a garment.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {DesignDocument} from "../../types.js"
 * @import {Studio} from "../../state/studio.js"
 */

import { api } from "../../api.js";
import { plainDesign } from "../../design/design.js";
import { Grid } from "../../grid/grid.js";
import { h, remark } from "../../elements/dom.js";
import { icon } from "../../elements/icons.js";
import { dialog } from "../../widgets/dialog.js";
import { thumbnail } from "../../widgets/thumbnail.js";
import { EXAMPLES, GARMENTS } from "./examples.js";
import { attempt } from "../../widgets/problem.js";

/** @param {Studio} studio @param {ActionContext} context */
export function create(studio, { keeper, open }) {
  const status = h("div", { class: "dialog-status", role: "status" });
  const examples = h("ul", { class: "cards stack", id: "gallery-examples" });
  const garments = h("ul", { class: "cards stack", id: "gallery-garments" });
  const element = dialog(
    "gallery-dialog",
    "New design",
    remark("Begin with one of these and change it. Your present design is saved."),
    status,
    h("h3", {}, "Charts"),
    examples,
    h("h3", {}, "Garments"),
    garments,
  );

  /** @param {DesignDocument} design @param {import("./examples.js").GarmentExample} [example] that it is made from */
  const begin = (design, example) => {
    element.close();
    if (example?.id === "glove") {
      studio.seeing.planned({ garment: { template: "glove" }, material: example.material }, design);
    }
    keeper.openNew(design, { keep: false });
    studio.tell(`${design.name}: paint on it, or pull it below.`);
  };
  /**
   * @param {string} id
   * @param {string} name
   * @param {string} note
   * @param {Node} picture
   * @param {() => void} perform
   */
  const card = (id, name, note, picture, perform) =>
    h(
      "li",
      { class: "card" },
      h(
        "button",
        { class: "card-open whole sunken stack gap-2", id: `gallery-${id}`, onclick: perform },
        h("span", { class: "card-picture centred muted" }, picture),
        h("span", { class: "card-name" }, name),
        h("span", { class: "card-facts muted" }, note),
      ),
    );

  const show = () => {
    examples.replaceChildren(
      card("empty", "Empty chart", "All knit, of any size.", icon("plus"), () => {
        begin(plainDesign("Untitled", new Grid(24, 30).text, studio.materialId.value));
        open("resize");
      }),
      ...EXAMPLES.map(({ id, name, note, chart }) =>
        card(id, name, note, thumbnail({ chart: chart() }), () =>
          begin(plainDesign(name, chart(), studio.materialId.value)),
        ),
      ),
    );
  };

  /** @type {Map<string, DesignDocument>} */
  const fitted = new Map();
  const showGarments = async () => {
    garments.replaceChildren(...GARMENTS.map(() => h("li", { class: "card loading", "aria-hidden": "true" })));
    for (const example of GARMENTS) {
      if (fitted.has(example.id)) continue;
      const { garment, material, name } = example;
      const plan = await attempt(status, () => api.run("garment", { garment, material }));
      if (!plan) continue;
      fitted.set(example.id, { ...plan.design, name, material });
    }
    garments.replaceChildren(
      ...GARMENTS.flatMap((example) => {
        const { id, name, note } = example;
        const design = fitted.get(id);
        return design ? [card(id, name, note, thumbnail(design), () => begin(design, example))] : [];
      }),
      card("measured", "To measure", "A brace, sock, sleeve or glove from your measurements.", icon("yarn"), () => {
        element.close();
        open("garments");
      }),
    );
  };

  return () => {
    show();
    element.showModal();
    void showGarments();
  };
}
