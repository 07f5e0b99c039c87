/**
 * Yarns of one's own: a list of them, a file of one, or stretch tests from which one is made.
 *
 * @import {Studio} from "../../studio.js"
 * @import {Fabric, FitResult, MaterialSummary} from "../../types.js"
 * @import {Tests} from "../../services/yarns.js"
 */

import { FABRICS } from "../../core/segments.js";
import { h } from "../../dom.js";
import { download } from "../../services/exporter.js";
import { OWN, adopt, fitRequest, isYarnFile, refresh, yarnOf, yarns } from "../../services/yarns.js";
import { attempt } from "../../widgets/attempt.js";
import { iconButton, textButton } from "../../widgets/buttons.js";
import { dialog } from "../../widgets/dialog.js";
import { numberField } from "../../widgets/fields.js";
import { Run } from "../../widgets/jobrun.js";

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
      if (!isYarnFile(document)) return say("This is no yarn", `${chosen.name} is not a material file of Knitcore.`);
      if (await attempt(status, () => adopt(studio, document))) element.close();
    },
  });
  const name = h("input", {
    type: "text",
    class: "text-field",
    id: "yarn-name",
    maxLength: 80,
    placeholder: "Name of the yarn",
    "aria-label": "Name of the yarn",
  });
  const rows = FABRICS.map(testRow);
  const run = new Run();
  const make = textButton("yarn", "Make the yarn", () => void fitted(), { class: "button primary", id: "yarn-make" });

  /** @param {string} title @param {string} detail */
  const say = (title, detail) => run.say({ title, detail, remedy: null });
  const fitted = async () => {
    if (!name.value.trim()) return say("The yarn has no name", "Give it one.");
    const given = rows.flatMap(({ fabric, tests }) => {
      const found = tests();
      return found ? [/** @type {const} */ ([fabric, found])] : [];
    });
    if (!given.length) {
      return say("There are no tests yet", "Give at least one fabric two tests and its gauge; a chart needs all four.");
    }
    /** @type {Map<Fabric, {tests: Tests, fit: FitResult}>} */
    const fabrics = new Map();
    for (const [fabric, tests] of given) {
      /** @type {FitResult | null} */
      const fit = await run.run("fit", await fitRequest(tests), `Fitting ${fabric} …`);
      if (!fit) return;
      fabrics.set(fabric, { tests, fit });
    }
    if (await attempt(status, () => adopt(studio, yarnOf(name.value.trim(), fabrics)))) element.close();
  };

  const element = dialog(
    "yarns-dialog",
    "Own yarns",
    h("p", { class: "muted" }, "They are offered to everybody who uses this service, and are part of its backups."),
    status,
    list,
    h(
      "div",
      { class: "dialog-tools" },
      h("label", { class: "button", for: "yarn-file" }, "Add a yarn file …"),
      file,
      h("span", { class: "muted" }, "A material file (.json): saved here, or by the library."),
    ),
    h(
      "details",
      { class: "yarn-tests", id: "yarn-tests" },
      h("summary", {}, "Make one from stretch tests"),
      h(
        "p",
        { class: "muted" },
        "For each fabric two tests, CSV or HDF5: a swatch pulled along its rows, and one pulled along its columns; and its gauge at rest.",
      ),
      name,
      h(
        "table",
        { class: "yarn-table" },
        h(
          "thead",
          {},
          h(
            "tr",
            {},
            ...[
              "Fabric",
              "Pulled along the rows",
              "Pulled along the columns",
              "Stitches per 10 cm",
              "Rows per 10 cm",
            ].map((text) => h("th", { scope: "col" }, text)),
          ),
        ),
        h("tbody", {}, ...rows.map((row) => row.element)),
      ),
      run.element,
      h("div", { class: "dialog-buttons" }, make),
    ),
  );

  const show = () => {
    const own = studio.materials.value.filter(({ id }) => id.startsWith(OWN));
    list.replaceChildren(...own.map((yarn) => item(yarn)));
    if (!own.length) list.append(h("li", { class: "muted" }, "None yet."));
  };
  /** @param {MaterialSummary} yarn */
  const item = ({ id, name: label, description, fabrics }) =>
    h(
      "li",
      { class: "row" },
      h(
        "span",
        { class: "row-text" },
        h("span", { class: "ellipsis" }, label),
        h(
          "span",
          { class: "muted" },
          [description, `${Object.keys(fabrics).length} of 4 fabrics`].filter(Boolean).join(" · "),
        ),
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
      iconButton("trash", `Remove ${label}`, async () => {
        const gone = await attempt(status, () => yarns.remove(id).then(() => true));
        if (gone) await refresh(studio);
      }),
    );
  studio.materials.watch(show);
  return () => {
    status.replaceChildren();
    element.showModal();
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

/** @param {Fabric} fabric */
function testRow(fabric) {
  /** @param {string} way */
  const pick = (way) =>
    h("input", {
      type: "file",
      accept: ".csv,.h5,.hdf5",
      id: `yarn-${fabric}-${way}`,
      "aria-label": `${fabric}, pulled along the ${way}`,
    });
  const course = pick("rows");
  const wale = pick("columns");
  /** @param {string} of */
  const gauge = (of) =>
    numberField({ min: "1", max: "400", step: "any", id: `yarn-${fabric}-${of}`, "aria-label": `${of} of ${fabric}` });
  const stitches = gauge("stitches per 10 cm");
  const rows = gauge("rows per 10 cm");
  /** @returns {Tests | null} null until all is given */
  const tests = () => {
    const [along, across] = [course.files?.[0], wale.files?.[0]];
    const sizes = { stitches: stitches.valueAsNumber, rows: rows.valueAsNumber };
    return along && across && sizes.stitches > 0 && sizes.rows > 0 ? { course: along, wale: across, ...sizes } : null;
  };
  const element = h(
    "tr",
    {},
    h("th", { scope: "row" }, fabric),
    ...[course, wale, stitches, rows].map((field) => h("td", {}, field)),
  );
  return { fabric, tests, element };
}
