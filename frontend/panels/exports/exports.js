/**
 * The export panel: all formats with their options, and what was checked of the file that came out.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {Studio} from "../../state/studio.js"
 * @import {ExportRequest, ExportResult, Extensions, ProgramReportRequest} from "../../types.js"
 * @import {ExportKind, Option} from "./kinds.js"
 */

import { ApiError, api, fetched } from "../../api.js";
import { base64 } from "../../grid/bits.js";
import { h } from "../../elements/dom.js";
import { icon } from "../../elements/icons.js";
import { resume } from "../../services/along.js";
import { download } from "../../services/exporter.js";
import { knownMachines } from "../../services/machines.js";
import { pieceOf } from "../../services/scope.js";
import { dialog } from "../../widgets/dialog.js";
import { choice, labelled, numberField } from "../../widgets/fields.js";
import { isKnitted, viewPicture } from "../fabric/share.js";
import { viewRequest } from "../fabric/fabricview.js";
import { KINDS, hindrance, isPattern, ofExtensions } from "./kinds.js";
import { machineField } from "./machines.js";
import { reportTable } from "./programreport.js";
import { swatchFields } from "./swatches.js";
import { textButton } from "../../widgets/buttons.js";
import { attempt } from "../../widgets/problem.js";

/** Characters of a text file that are shown. */
const MAX_SHOWN = 6000;

/** What is added to the name of a file that ends like another of the design. @type {Record<string, string>} */
const SORTS = {
  report: " report",
  pattern: " pattern",
  "pattern-svg": " pattern",
  "hand-plan": " plan",
  "hand-plan-text": " plan",
  ayab: " AYAB",
  "punch-card": " card",
  "punch-card-text": " card",
};

/** Size of the picture in a pattern; one of the view has the proportions of that. */
const PHOTO_PX = { width: 1400, height: 800 };

/** @param {Studio} studio @param {ActionContext} context */
export function create(studio, { view }) {
  let kind = KINDS[0];
  const chosen = { construction: "flat", first_side: "RS", finish: "waste" };
  const machine = machineField(studio, () => void swatches.show());
  const swatches = swatchFields(studio, () => machine.value);
  const stitch = numberField({ min: "0", step: "any", placeholder: "–", "aria-label": "Stitch number" });
  /** @param {string} label */
  const price = (label) => numberField({ min: "0", step: "any", placeholder: "–", "aria-label": label });
  const perKg = price("Price of a kilogram of yarn");
  const perHour = price("Price of an hour at the machine");
  const tex = numberField({ min: "1", step: "any", placeholder: "–", "aria-label": "Yarn in tex" });
  const sides = choice(
    "export-side",
    "Side of row 1",
    { RS: "row 1 is a right side", WS: "row 1 is a wrong side" },
    "RS",
    (value) => (chosen.first_side = value),
  );
  const from = numberField({ min: "1", step: "1", value: "1", "aria-label": "From row" });
  const note = h("p", { class: "muted" });
  /** @type {Record<Option, HTMLElement>} */
  const options = {
    worked: h(
      "div",
      { class: "exports-options gap-12 shrinks-x" },
      choice("export-worked", "Worked", { flat: "worked flat", round: "in the round" }, "flat", (value) => {
        chosen.construction = value;
        sides.hidden = value === "round";
      }),
      sides,
    ),
    machine: machine.element,
    dial: h(
      "div",
      { class: "stack gap-8" },
      labelled("Stitch number", stitch, "that of the yarn's loops if left empty"),
      swatches.element,
    ),
    finish: choice(
      "export-finish",
      "The last row",
      { waste: "ends in waste yarn", "bind-off": "last row bound off" },
      "waste",
      (value) => (chosen.finish = value),
    ),
    from: labelled("From row", from, "to go on after a break or a jam"),
    tex: labelled("Yarn, tex (g/km)", tex, "for its mass"),
    price: h("div", { class: "line gap-8" }, "Price of yarn, per kg", perKg, "per hour", perHour),
    note,
  };
  const status = h("div", { class: "dialog-status", role: "status" });
  const outcome = h("div", { class: "exports-options gap-12 shrinks-x", id: "export-outcome", "aria-live": "polite" });
  const make = textButton("export", "Make the file", () => void run(), { class: "button primary", id: "export-make" });

  /** @param {ExportKind} format */
  const choose = (format) => {
    kind = format;
    for (const [name, row] of Object.entries(options))
      row.hidden = !format.options.includes(/** @type {Option} */ (name));
    if (format.options.includes("machine")) machine.showFor(format.to === "knitout" ? "programs" : "plans");
    outcome.replaceChildren();
    status.replaceChildren();
  };
  /** @param {ExportKind} format */
  const entry = (format) => ({
    format,
    input: h("input", {
      type: "radio",
      name: "export-kind",
      value: format.to,
      checked: format === kind,
      onchange: () => choose(format),
    }),
    note: h("span", { class: "muted small" }),
  });
  const entries = KINDS.map(entry);
  /** @param {ReturnType<typeof entry>[]} some */
  const fieldsets = (some) =>
    [...new Set(some.map(({ format }) => format.group))].map((group) =>
      h(
        "fieldset",
        { class: "exports-kinds stack gap-2" },
        h("legend", { class: "muted small" }, group),
        ...some
          .filter(({ format }) => format.group === group)
          .map(({ format, input, note }) =>
            h("label", { class: "exports-kind stack gap-8" }, input, h("span", {}, format.name, note)),
          ),
      ),
    );
  const formats = h("div", {}, ...fieldsets(entries));
  const element = dialog(
    "export-dialog",
    "Export",
    h(
      "div",
      { class: "exports stack" },
      formats,
      h(
        "section",
        { class: "exports-options gap-12 shrinks-x", "aria-label": "Options and file", tabIndex: 0 },
        ...Object.values(options),
        status,
        outcome,
      ),
    ),
    h("div", { class: "dialog-buttons" }, make),
  );

  /** What the service exports: formats of extensions, and how large a chart may be. @type {Extensions | null} */
  let offered = null;
  async function askOffered() {
    offered = await attempt(status, api.extensions, askOffered);
    if (!offered) return;
    const added = ofExtensions(offered.extensions).map(entry);
    entries.push(...added);
    formats.append(...fieldsets(added));
    machine.offer((await attempt(status, knownMachines, askOffered)) ?? []);
    showHindrances();
  }

  function showHindrances() {
    const { shaped, grid } = studio.document;
    for (const { format, input, note: words } of entries) {
      const why = hindrance(format.to, { shaped, stitches: grid.purl.length }, offered?.largest_exports ?? {});
      input.disabled = why !== "";
      words.textContent = why || format.note;
    }
    if (entries.some(({ input }) => input.checked && input.disabled)) {
      entries[0].input.checked = true;
      choose(entries[0].format);
    }
  }

  async function run() {
    const format = kind;
    make.disabled = true;
    outcome.replaceChildren(
      h("p", { class: "muted" }, kind.to === "knitout" ? "Checking it on a simulated machine …" : "One moment …"),
    );
    const { other_stitches: others, ...design } = studio.toDocument();
    // The project file has knits and purls, and the others beside them; the rest has all in one chart.
    const stitches = kind.to === "design" ? { other_stitches: others } : { chart: studio.document.text };
    const body = {
      ...design,
      ...stitches,
      format: undefined,
      version: undefined,
      ...chosen,
      to: kind.to,
      symbols: studio.editing.symbols.value,
      gauge: pieceOf(studio).gauge,
      linear_density_tex: Number.isFinite(tex.valueAsNumber) ? tex.valueAsNumber : null,
      photo: isPattern(kind.to) ? await photo() : null,
      ...(kind.options.includes("machine") && { machine: machine.value }),
      stitch_number:
        kind.options.includes("dial") && Number.isFinite(stitch.valueAsNumber) ? stitch.valueAsNumber : null,
      from_row: kind.options.includes("from") && Number.isInteger(from.valueAsNumber) ? from.valueAsNumber : 1,
    };
    const bare = isPattern(kind.to) && body.photo === null;
    const file = await attempt(status, () => api.run("export", /** @type {ExportRequest} */ (body)));
    make.disabled = false;
    outcome.replaceChildren();
    const notes = bare ? ["without a picture: none could be made"] : [];
    if (!file) return;
    show({ ...file, notes: [...file.notes, ...notes] }, format);
    if (format.options.includes("price")) await explain(/** @type {ExportRequest} */ (body));
  }

  /** Time, yarn and tension of a program, below the file. @param {Partial<ExportRequest>} request of the file */
  async function explain(request) {
    const { chart, outline, regions, material, machine, finish, gauge, linear_density_tex, stitch_number, from_row } =
      request;
    const design = {
      chart,
      outline,
      regions,
      material,
      machine,
      finish,
      gauge,
      linear_density_tex,
      stitch_number,
    };
    const [price_per_kg, price_per_hour] = [perKg, perHour].map(({ valueAsNumber: n }) => (n > 0 ? n : null));
    const body = { ...design, from_row, price_per_kg, price_per_hour };
    const report = await attempt(status, () => api.run("program-report", /** @type {ProgramReportRequest} */ (body)));
    if (report) outcome.children[0]?.after(reportTable(report));
  }

  /** What the 3D view shows, or else what the service draws of it, base64; null where neither can be had. */
  async function photo() {
    const { width, height } = PHOTO_PX;
    const ways = [
      ...(isKnitted() ? [() => viewPicture(studio, width)] : []),
      async () => {
        const address = `/views/still?width=${width}&height=${height}`;
        return (await fetched(address, { method: "POST", body: viewRequest(studio, view) })).blob();
      },
    ];
    for (const picture of ways) {
      try {
        return base64(new Uint8Array(await (await picture()).arrayBuffer()));
      } catch (error) {
        if (!(error instanceof ApiError)) throw error;
      }
    }
    return null;
  }

  /** @param {ExportResult} file @param {ExportKind} format of which it is: another may be chosen by now */
  function show(file, { to, text: isText }) {
    const bytes = Uint8Array.from(atob(file.content), (c) => c.charCodeAt(0));
    const name = file.name.replace(/(\.\w+)$/, `${SORTS[to] ?? ""}$1`);
    const save = () => download(name, new Blob([bytes], { type: file.media_type }));
    const facts = [
      `${name}, ${(file.bytes / 1000).toFixed(1)} kB`,
      ...(file.transfers === null
        ? []
        : [
            `${file.transfers} transfers between the beds, ${file.carriers} ${file.carriers === 1 ? "carrier" : "carriers"} without waste yarn`,
          ]),
      ...file.notes,
    ];
    const text =
      isText || file.media_type.startsWith("text/") ? new TextDecoder().decode(bytes.slice(0, MAX_SHOWN)) : "";
    outcome.replaceChildren(
      h(
        "ul",
        { class: "planner-notes plain-list stack gap-5 small" },
        ...facts.map((words, i) => h("li", {}, icon(i ? "info" : "check"), words)),
      ),
      text && !to.endsWith("svg")
        ? h("pre", { class: "exports-text rounded sunken", tabIndex: 0, "aria-label": "The file" }, text)
        : "",
      h("div", { class: "dialog-buttons" }, h("button", { class: "button", onclick: save }, "Save it again")),
    );
    outcome.scrollIntoView({ block: "nearest" });
    save();
  }

  choose(kind);
  return () => {
    const { regions, outline } = studio.toDocument();
    showHindrances();
    const yarns = new Set(regions.flatMap(({ yarn }) => yarn ?? []));
    note.textContent = [
      studio.note.value ? "The design's note goes with it." : "",
      outline ? "The chart has an outline." : "",
      yarns.size ? `Its yarns: ${[...yarns].join(", ")}.` : "",
    ]
      .filter(Boolean)
      .join(" ");
    from.value = String(resume.row);
    resume.row = 1;
    choose(kind);
    element.showModal();
    if (!offered) void askOffered();
  };
}
