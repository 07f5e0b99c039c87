/** Fields for numbers, names, choices, and lengths, which are kept in mm and shown in mm or inches. */

import { h } from "../elements/dom.js";

const MM_PER_INCH = 25.4;

/** @param {Record<string, unknown>} more its properties */
export const numberField = (more) => h("input", { type: "number", class: "number figures", ...more });

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
    { class: "line-field" },
    h("span", {}, label),
    h("input", {
      type: "text",
      class: "text",
      value,
      maxLength: 80,
      onchange: (/** @type {Event} */ { target }) => changed(/** @type {HTMLInputElement} */ (target).value.trim()),
      ...more,
    }),
  );

/** A field for a length that can change its unit. */
export class LengthField {
  /**
   * @param {string} label
   * @param {number} mm
   * @param {() => void} changed
   */
  constructor(label, mm, changed) {
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
 * @param {[string, string][]} choices value and words
 * @param {string} chosen
 * @param {(value: string) => void} changed
 */
export function choice(name, label, choices, chosen, changed) {
  return h(
    "fieldset",
    { class: "planner-choice" },
    h("legend", { class: "visually-hidden" }, label),
    ...choices.map(([value, words]) =>
      h(
        "label",
        { class: "planner-choice-item" },
        h("input", { type: "radio", name, value, checked: value === chosen, onchange: () => changed(value) }),
        h("span", {}, words),
      ),
    ),
  );
}

/**
 * @param {string} label
 * @param {Node} field
 * @param {string} [hint]
 */
export const labelled = (label, field, hint) =>
  h(
    "label",
    { class: "planner-field" },
    h("span", {}, label, hint && h("span", { class: "muted" }, ` ${hint}`)),
    field,
  );
