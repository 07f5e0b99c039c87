/**
 * The state that the panels share: the chart, how it is shown and painted, what the service says of
 * it. Panels watch the signals and change them; none knows another.
 *
 * @import {ChartDocument} from "../design/document.js"
 * @import {Selection} from "../design/selection.js"
 * @import {History} from "../design/history.js"
 * @import {Ink, Symmetry} from "../design/ink.js"
 * @import {Overlay} from "./overlays.js"
 * @import {Tool} from "../tools/tool.js"
 * @import {DesignDocument, Direction, MaterialDetail, MaterialSummary, PredictResult, Problem, StitchKind,
 *   StretchResult} from "../types.js"
 *
 * @typedef {{value: PredictResult | null, busy: boolean, problem: Problem | null, basis: Record<string, string>,
 *   scope: string}} PredictionState `basis` is what the value was predicted for, and `scope` its kind
 * @typedef {{value: StretchResult | null, direction: Direction, busy: boolean, stale: string,
 *   problem: Problem | null}} StretchState `stale` says why the test does not count any more; "" if it does
 * @typedef {{kind: "info" | "error", title: string, detail?: string, remedy?: string | null}} Message
 */

import { thousands } from "../core/format.js";
import { paced } from "../core/paced.js";
import { atStitches } from "../core/striptest.js";
import { Grid } from "../grid/grid.js";
import { imbalances } from "../design/balance.js";
import { PURL } from "../design/ink.js";
import { entriesOf } from "../design/others.js";
import { Signal } from "../core/signal.js";
import { loadSettings, saveSettings } from "../design/store.js";
import { Editing } from "./editing.js";
import { OVERLAYS } from "./overlays.js";
import { Seeing } from "./seeing.js";
import { Gauges } from "./gauges.js";
import { TOOLS, pencil } from "../tools/tools.js";

const SETTINGS = { overlay: "fabrics", rectangles: false, tool: "pencil", size: 1, weight: 0.5 };

/** @param {Pick<MaterialSummary, "fabrics">} yarn */
export const isComplete = ({ fabrics }) => Object.keys(fabrics).length === 4;

/** Number of the step before the first: the cloth lies between its clamps, not pulled yet. */
export const REST = -1;

export class Studio {
  /** @param {ChartDocument} document @param {{id: string, name: string, material: string, note?: string, machine?: string | null}} design */
  constructor(document, design) {
    const settings = loadSettings(SETTINGS);
    this.document = document;
    this.designId = design.id;
    this.name = new Signal(design.name);
    this.note = new Signal(design.note ?? "");
    /** The machine that programs are for: its name, or the text of a profile; null for the usual one. */
    this.machine = new Signal(/** @type {string | null} */ (design.machine ?? null));

    /** @type {Signal<string>} */
    this.materialId = new Signal(design.material);
    this.material = new Signal(/** @type {MaterialDetail | null} */ (null));
    this.materials = new Signal(/** @type {MaterialSummary[]} */ ([]));
    /** Stitches of the largest chart that an operation takes, where it has a limit. */
    this.largest = new Signal(/** @type {Record<string, number>} */ ({}));

    /** @type {Signal<Tool>} */
    this.tool = new Signal(TOOLS.find(({ id }) => id === settings.tool) ?? TOOLS[0]);
    this.ink = new Signal(/** @type {Ink} */ (PURL));
    this.shelf = new Signal(/** @type {Ink[]} */ ([]));
    this.size = new Signal(settings.size);
    this.symmetry = new Signal(/** @type {Symmetry} */ ("none"));
    this.selection = new Signal(/** @type {Selection | null} */ (null));
    this.editing = new Editing(document, this.selection);

    /** @type {Signal<Overlay>} */
    this.overlay = new Signal(OVERLAYS.find(({ id }) => id === settings.overlay) ?? OVERLAYS[1]);
    this.rectangles = new Signal(settings.rectangles);
    this.seeing = new Seeing();
    this.gauges = new Gauges();
    /** Of the yarn, g/m. */
    this.weight = new Signal(settings.weight);

    /** Whether the repeat on show is being relaxed at the yarn level. */
    this.relaxing = new Signal(false);
    this.prediction = new Signal(
      /** @type {PredictionState} */ ({ value: null, busy: false, problem: null, basis: {}, scope: "chart" }),
    );
    this.stretch = new Signal(
      /** @type {StretchState} */ ({
        value: null,
        direction: "wale",
        busy: false,
        stale: "",
        problem: null,
      }),
    );
    /** Rows that take more or fewer stitches than the row below has. */
    this.balance = new Signal(/** @type {import("../design/balance.js").Imbalance[]} */ (imbalances(document)));
    const weigh = paced(() => {
      const rows = imbalances(document);
      if (rows.length || this.balance.value.length) this.balance.value = rows;
    }, 0);
    document.onChange(weigh);
    this.step = new Signal(0);
    this.online = new Signal(true);
    /** Who is signed in with this browser, if anybody is. */
    this.user = new Signal(/** @type {string | null} */ (null));
    this.message = new Signal(/** @type {Message | null} */ (null));
    /** A table that was dropped on the page, for the panel of yarns. */
    this.droppedTest = /** @type {File | null} */ (null);

    this.overlay.listen(({ id }) => {
      // A stretch is gone after a reload, so its overlays are not remembered.
      if (id !== "strain" && id !== "utilisation") saveSettings({ overlay: id });
    });
    this.rectangles.listen((rectangles) => saveSettings({ rectangles }));
    this.tool.listen(({ id }) => saveSettings({ tool: id }));
    this.weight.listen((weight) => saveSettings({ weight }));
    this.size.listen((size) => saveSettings({ size }));
  }

  /** The design as a project file holds it. @returns {DesignDocument} */
  toDocument() {
    return {
      format: "knitcore-design",
      version: 2,
      name: this.name.value,
      material: this.materialId.value,
      note: this.note.value,
      machine: this.machine.value,
      ...this.document.content,
    };
  }

  /**
   * Show another design in place of this one.
   *
   * @param {DesignDocument} design
   * @param {string} id
   * @param {History} [history] a new one if left out
   */
  open(design, id, history) {
    this.designId = id;
    this.name.value = design.name;
    this.note.value = design.note;
    this.machine.value = design.machine ?? null;
    this.selection.value = null;
    this.materialId.value = design.material;
    this.document.open(design, history);
    this.stretch.value = { ...this.stretch.value, value: null, stale: "", problem: null };
  }

  /**
   * Take over what somebody else changed in this design, as a step that can be undone.
   *
   * @param {DesignDocument} design
   */
  follow(design) {
    const { content } = this.document;
    this.name.value = design.name;
    this.note.value = design.note;
    this.machine.value = design.machine ?? null;
    this.materialId.value = design.material;
    const label = "Changes from elsewhere";
    /** @param {Partial<DesignDocument>} part */
    const rest = ({ outline, regions, repeats, shelf }) => JSON.stringify([outline, regions, repeats, shelf]);
    const grid = Grid.fromText(design.chart);
    const put = entriesOf(design.other_stitches ?? [], grid.columns);
    if (rest(content) === rest(design)) this.document.replace(grid, label, put);
    else this.document.load(design, label);
  }

  /** The yarns whose four fabrics were all measured or estimated: they can be mixed in a chart. */
  get completeYarns() {
    return this.materials.value.filter(isComplete);
  }

  /** What is known of the design's yarn; nothing until it is loaded. */
  get yarn() {
    return this.materials.value.find(({ id }) => id === this.materialId.value);
  }

  /** The 16 kinds of stitch in the chosen material; none until it is loaded. @returns {StitchKind[]} */
  kinds() {
    return this.material.value?.stitch_table?.codes ?? [];
  }

  /** The stretch on show, if it is of this very chart. @returns {StretchResult | null} */
  currentStretch() {
    const { value, stale } = this.stretch.value;
    const { rows, columns } = this.document.grid;
    return value && !stale && value.rows === rows && value.columns === columns ? value : null;
  }

  /** @returns {Direction} */
  stretchDirection() {
    return this.stretch.value.direction;
  }

  /** The strain of the step on show: 0 at rest; null without a test. */
  currentStrain() {
    const test = this.currentStretch();
    if (!test) return null;
    return this.step.value === REST ? 0 : test.strain[this.step.value];
  }

  /**
   * Values of all stitches at the step on show.
   *
   * @param {"strain" | "utilisation"} name strain is the one along the pull
   * @returns {number[] | null}
   */
  field(name) {
    return this.#atStitches(this.#steps(name));
  }

  /** Smallest and largest strain of a stitch along the pull in the whole test; rest is among them. */
  strainRange() {
    const range = { low: 0, high: 0 };
    for (const step of this.#steps("strain") ?? []) {
      for (const value of step) {
        if (value < range.low) range.low = value;
        if (value > range.high) range.high = value;
      }
    }
    return range;
  }

  /** Largest size of strain along the pull in the whole test. */
  largestStrain() {
    const { low, high } = this.strainRange();
    return Math.max(high, -low);
  }

  /** @param {"strain" | "utilisation"} name */
  #steps(name) {
    const fields = this.currentStretch()?.stitch_fields;
    if (name === "utilisation") return fields?.utilisation;
    return this.stretchDirection() === "course" ? fields?.strain_course : fields?.strain_wale;
  }

  /** Low and high ends of a stitch's value at the step on show. @param {"strain" | "utilisation"} name @param {number} i */
  interval(name, i) {
    const fields = this.currentStretch()?.stitch_fields;
    const along = this.stretchDirection() === "course" ? fields?.strain_course_interval : fields?.strain_wale_interval;
    return (name === "utilisation" ? fields?.utilisation_interval : along)?.map((end) => this.#atStitches(end)?.[i]);
  }

  /** Strains of all stitches at the step on show, along rows and along columns; null without a test. */
  strains() {
    const fields = this.currentStretch()?.stitch_fields;
    const [course, wale] = [fields?.strain_course, fields?.strain_wale].map((steps) => this.#atStitches(steps));
    return course && wale ? { course, wale } : null;
  }

  /** @param {number[][] | undefined} steps @returns {number[] | null} */
  #atStitches(steps) {
    const [test, values] = [this.currentStretch(), steps?.[this.step.value]];
    return test && values ? atStitches(test, values) : null;
  }

  /** Paint with an ink; with the pencil if the tool does not paint. @param {Ink} ink */
  paintWith(ink) {
    this.ink.value = ink;
    if (!["stroke", "shape", "once"].includes(this.tool.value.mode)) this.tool.value = pencil;
  }

  /**
   * Say why an operation does not take the chart; "" if it does.
   *
   * @param {string} operation
   * @param {string} what it is for a knitter
   */
  tooLarge(operation, what) {
    const { rows, columns } = this.document.grid;
    const most = this.largest.value[operation] ?? Infinity;
    if (rows * columns <= most) return "";
    const side = Math.floor(Math.sqrt(most));
    return (
      `This chart is too large for ${what}, which takes up to ${thousands(most)} stitches, ` +
      `such as ${side} × ${side}. Try a part of it as a design of its own.`
    );
  }

  /** Show a message to the user. @param {Problem} problem */
  tellProblem(problem) {
    this.message.value = { kind: "error", ...problem };
  }

  /** @param {string} title */
  tell(title) {
    this.message.value = { kind: "info", title };
  }
}
