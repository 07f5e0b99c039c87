/**
 * How the chart is looked at and what is in the hand: state of the editor that is not part of the
 * design.
 *
 * @import {ChartDocument} from "../design/document.js"
 * @import {Clip, Floating} from "../design/floating.js"
 * @import {Selection} from "../design/selection.js"
 *
 * @typedef {"both" | "colours" | "symbols" | "loops"} Look colours with symbols, either, or stitches as
 *   they look in the cloth
 * @typedef {"dots" | "dashes" | "japanese"} Symbols of knits and purls, on the page and in print
 */

import { Signal } from "../core/signal.js";
import { loadSettings, saveSettings } from "../design/store.js";

const SETTINGS = {
  look: /** @type {Look} */ ("both"),
  symbols: /** @type {Symbols} */ ("dots"),
  back: false,
  round: false,
};

export class Editing {
  /** @type {{floating: Floating, selection: Selection, step: unknown} | null} */ #held = null;
  #document;
  #selection;

  /** @param {ChartDocument} document @param {Signal<Selection | null>} selection */
  constructor(document, selection) {
    const settings = loadSettings(SETTINGS);
    this.#document = document;
    this.#selection = selection;
    /** @type {Signal<Look>} */
    this.look = new Signal(settings.look);
    this.symbols = new Signal(settings.symbols);
    /** Whether the cloth's back is seen. */
    this.back = new Signal(settings.back);
    /** Knitted in the round: every row is a right-side row. */
    this.round = new Signal(settings.round);
    /** What was copied last. @type {Clip | null} */
    this.clip = null;
    /** Id of the repeat that is placed next. */
    this.repeatId = new Signal(/** @type {string | null} */ (null));
    /** Which panel is open beside the chart. */
    this.panel = new Signal(/** @type {string | null} */ (null));
    this.look.listen((look) => saveSettings({ look }));
    this.symbols.listen((symbols) => saveSettings({ symbols }));
    this.back.listen((back) => saveSettings({ back }));
    this.round.listen((round) => saveSettings({ round }));
  }

  /** The repeat that the tool places: the one chosen, or the latest. */
  get repeat() {
    const { repeats } = this.#document;
    return repeats.find(({ id }) => id === this.repeatId.value) ?? repeats.at(-1) ?? null;
  }

  /** What was moved or pasted last, as long as nothing else happened. */
  get floating() {
    const held = this.#held;
    const still = held?.selection === this.#selection.value && held.step === this.#document.history.done.at(-1);
    return still ? held.floating : null;
  }

  /** Select what was just put down, so that it can be moved on. @param {Floating} floating */
  hold(floating) {
    const selection = floating.selection(this.#document.grid, floating.place);
    this.#selection.value = selection;
    this.#held = selection && { floating, selection, step: this.#document.history.done.at(-1) };
  }
}
