/**
 * Other windows that show the same design: how many there are, and when the design has changed.
 */

import { Signal } from "../core/signal.js";
import { newIdentifier } from "../design/store.js";
import { Follower } from "./follower.js";

/** How often the others are asked whether they are still there, and how long they have to answer. */
const ASK_MS = 4000;
const ANSWER_MS = 1000;

/**
 * @typedef {{kind: "here" | "gone" | "who", window: string, design: string | null}
 *   | {kind: "named", window: string, design: string, before: string}
 *   | {kind: "changed", window: string, design: string, revision: number}
 *   | {kind: "elsewhere", window: string, design: string, others: number}} Word
 */

export class Windows {
  /** Number of other windows with the design. */
  others = new Signal(0);
  /** Called when there is a new revision of the design, perhaps this window's own. @type {(revision: number) => void} */
  onChanged = () => {};
  /** Called when another window has the service's name of a design that had none. @type {(before: string, design: string) => void} */
  onNamed = () => {};
  #channel = new BroadcastChannel("knitcore-windows");
  #name = newIdentifier();
  /** @type {string | null} */ #design = null;
  /** @type {(name: string) => void} */ #answered = () => {};
  /** Design of each other window. @type {Map<string, string | null>} */ #seen = new Map();
  /** Number of other browsers with the design, and whether this window is the one that knows. */
  #elsewhere = 0;
  #follows = false;
  #follower = new Follower({
    others: (count) => {
      this.#follows = true;
      this.#elsewhere = count;
      this.#tellElsewhere();
      this.#count();
    },
    changed: (revision) => {
      this.delivered(revision);
      this.onChanged(revision);
    },
  });

  constructor() {
    this.#channel.onmessage = (event) => this.#heard(/** @type {Word} */ (event.data));
    window.addEventListener("pagehide", () => this.#say({ kind: "gone", window: this.#name, design: null }));
    // A window that was closed by force says nothing any more.
    setInterval(() => document.visibilityState === "visible" && this.#seen.size && this.#ask(), ASK_MS);
    window.addEventListener("pageshow", () => this.#say({ kind: "who", window: this.#name, design: this.#design }));
  }

  /** This window shows a design; null while the service does not know it. @param {string | null} design */
  show(design) {
    if (design === this.#design) return;
    this.#design = design;
    this.#elsewhere = 0;
    this.#follows = false;
    this.#follower.follow(design);
    this.#say({ kind: "who", window: this.#name, design });
    this.#count();
  }

  /** This window has delivered a design for the first time. @param {string} before @param {string} design */
  named(before, design) {
    this.#say({ kind: "named", window: this.#name, design, before });
  }

  /** This window has delivered a revision. @param {number} revision */
  delivered(revision) {
    if (this.#design) this.#say({ kind: "changed", window: this.#name, design: this.#design, revision });
  }

  #tellElsewhere() {
    if (this.#design && this.#follows) {
      this.#say({ kind: "elsewhere", window: this.#name, design: this.#design, others: this.#elsewhere });
    }
  }

  #ask() {
    const silent = new Set(this.#seen.keys());
    this.#answered = (name) => silent.delete(name);
    this.#say({ kind: "who", window: this.#name, design: this.#design });
    setTimeout(() => {
      for (const name of silent) this.#seen.delete(name);
      this.#count();
    }, ANSWER_MS);
  }

  /** @param {Word} word */
  #say(word) {
    this.#channel.postMessage(word);
  }

  /** @param {Word} word */
  #heard(word) {
    this.#answered(word.window);
    if (word.kind === "gone") this.#seen.delete(word.window);
    else this.#seen.set(word.window, word.design);
    if (word.kind === "who") {
      this.#say({ kind: "here", window: this.#name, design: this.#design });
      this.#tellElsewhere();
    }
    if (word.kind === "elsewhere" && word.design === this.#design) {
      this.#elsewhere = word.others;
      this.#follows = false;
    }
    if (word.kind === "named") this.onNamed(word.before, word.design);
    if (word.kind === "changed" && word.design === this.#design) this.onChanged(word.revision);
    this.#count();
  }

  #count() {
    const design = this.#design;
    const here = [...this.#seen.values()].filter((shown) => design && shown === design);
    this.others.value = here.length + this.#elsewhere;
  }
}
