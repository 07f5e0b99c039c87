/** Fields for numbers, names, choices, and lengths, which are kept in mm and shown in mm or inches. */

import { h } from "../elements/dom.js";
import { shortName } from "../core/names.js";

/** @import {Child} from "../elements/dom.js" */

const MM_PER_INCH = 25.4;

/** @param {Record<string, unknown>} more its properties */
export const numberField = (more) => h("input", { type: "number", class: "number figures framed rounded", ...more });

/** What is wrong with a field for a number, by the name that it has on the page; "" if nothing is. @param {HTMLInputElement} field */
export function numberFault(field) {
  const { rangeOverflow, rangeUnderflow, badInput, valueMissing } = field.validity;
  if (!(rangeOverflow || rangeUnderflow || badInput || valueMissing)) return "";
  const name = field.ariaLabel ?? field.closest("label")?.firstElementChild?.firstChild?.textContent;
  return `${name}: enter ${field.min}${field.max ? ` to ${field.max}` : " or more"}.`;
}

/** A field for a name. @param {Record<string, unknown>} more properties @param {number} [most] characters */
export function nameField(more, most) {
  const field = h("input", { type: "text", ...more });
  field.addEventListener("change", () => (field.value = shortName(field.value, most)));
  return field;
}

/**
 * A field for a short text, with its label in the same line.
 *
 * @param {string} label
 * @param {string} value
 * @param {(value: string) => void} changed called with the new text, without blanks around it
 * @param {Record<string, unknown>} more properties
 */
export const textLine = (label, value, changed, more) =>
  h(
    "label",
    { class: "line-field stack gap-8" },
    h("span", {}, label),
    nameField({
      class: "text full-width",
      value,
      onchange: (/** @type {Event} */ { target }) => changed(shortName(/** @type {HTMLInputElement} */ (target).value)),
      ...more,
    }),
  );

/**
 * Fields for a chart's size.
 *
 * @param {string} prefix of their ids
 * @param {number} most a side
 * @param {(side: "columns" | "rows") => void} changed called with the side that was typed
 */
export function sizeFields(prefix, most, changed) {
  /** @param {string} label @param {"columns" | "rows"} id */
  const field = (label, id) => {
    const oninput = () => changed(id);
    const input = numberField({ id: `${prefix}-${id}`, min: 1, max: most, required: true, oninput });
    return { input, row: h("label", { class: "field stack gap-4" }, h("span", {}, label), input) };
  };
  const columns = field("Stitches", "columns");
  const rows = field("Rows", "rows");
  const problem = h("p", { class: "problem-text", role: "alert" });
  return {
    columns: columns.input,
    rows: rows.input,
    problem,
    elements: [columns.row, rows.row],
    /** @param {{rows: number, columns: number}} size */
    show: (size) => {
      columns.input.value = String(size.columns);
      rows.input.value = String(size.rows);
    },
    /** Null, and a problem on show, where it is no size. @returns {{rows: number, columns: number} | null} */
    read: () => {
      const size = { rows: rows.input.valueAsNumber, columns: columns.input.valueAsNumber };
      const well = Object.values(size).every((n) => Number.isInteger(n) && n >= 1 && n <= most);
      problem.textContent = well ? "" : `Use whole numbers from 1 to ${most}.`;
      return well ? size : null;
    },
  };
}

/** A field for a length that can change its unit. */
export class LengthField {
  /** @param {string} label @param {number} mm @param {[least: number, most: number]} bounds mm @param {() => void} changed */
  constructor(label, mm, bounds, changed) {
    this.label = label;
    this.bounds = bounds;
    this.mm = mm;
    this.unit = "mm";
    this.input = numberField({
      min: "0",
      step: "any",
      required: true,
      "aria-label": label,
      oninput: () => {
        const value = this.input.valueAsNumber;
        this.mm = this.unit === "mm" ? value : value * MM_PER_INCH;
        changed();
      },
    });
    this.#show();
  }

  /** What is wrong with it, in its own unit; "" if nothing is. */
  get fault() {
    const [least, most] = this.bounds;
    if (this.mm >= least && this.mm <= most) return "";
    const shown = this.bounds.map((mm) => (this.unit === "in" ? (mm / MM_PER_INCH).toFixed(1) : String(mm)));
    return `${this.label}: enter ${shown[0]} to ${shown[1]} ${this.unit === "in" ? "inches" : "mm"}.`;
  }

  /** @param {string} unit */
  show(unit) {
    this.unit = unit;
    this.#show();
  }

  #show() {
    const inches = this.unit === "in";
    this.input.step = inches ? "0.125" : "1";
    const shown = inches ? (this.mm / MM_PER_INCH).toFixed(2) : this.mm.toFixed(0);
    this.input.value = Number.isFinite(this.mm) ? String(Number(shown)) : "";
  }
}

/**
 * A row of choices of which one holds.
 *
 * @param {string} name
 * @param {string} label
 * @param {Record<string, string>} choices values and their words
 * @param {string} chosen
 * @param {(value: string) => void} changed
 */
export function choice(name, label, choices, chosen, changed) {
  return h(
    "fieldset",
    { class: "planner-choice flex wrap gap-6" },
    h("legend", { class: "visually-hidden" }, label),
    ...Object.entries(choices).map(([value, words]) =>
      h(
        "label",
        { class: "planner-choice-item relative" },
        h("input", { type: "radio", name, value, checked: value === chosen, onchange: () => changed(value) }),
        h("span", {}, words),
      ),
    ),
  );
}

/** @param {Child} label @param {Node} field @param {string} [hint] */
export const labelled = (label, field, hint) =>
  h(
    "label",
    { class: "planner-field line spread gap-12" },
    h("span", {}, label, hint && h("span", { class: "muted" }, ` ${hint}`)),
    field,
  );

/**
 * @param {Record<string, unknown>} more its properties
 * @param {Record<string, string>} options values and their words
 */
export const selectField = (more, options) =>
  h("select", more, ...Object.entries(options).map(([value, words]) => h("option", { value }, words)));

/** Options whose values are their words. @param {readonly string[]} words */
export const sameWords = (words) => Object.fromEntries(words.map((word) => [word, word]));

/**
 * Segments side by side of which one is chosen.
 *
 * @template T
 * @param {string} label
 * @param {readonly (readonly [value: T, content: Child | Child[], properties?: Record<string, unknown>])[]} choices
 * @param {T} chosen
 * @param {(value: T) => void} changed
 * @param {Record<string, unknown>} [more] properties of all of it
 */
export function segmented(label, choices, chosen, changed, more = {}) {
  const segments = choices.map(([value, content, properties]) =>
    h(
      "button",
      { class: "segment", role: "radio", onclick: () => (show(value), changed(value)), ...properties },
      ...[content].flat(),
    ),
  );
  const show = (/** @type {T} */ value) =>
    segments.forEach((segment, i) => segment.setAttribute("aria-checked", String(choices[i][0] === value)));
  show(chosen);
  const element = h("div", { class: "segmented", role: "radiogroup", "aria-label": label, ...more }, ...segments);
  return { element, show };
}
