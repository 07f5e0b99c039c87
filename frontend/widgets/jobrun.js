/**
 * A long computation of the panel: progress, cancel, and problems in words.
 *
 * @import {Studio} from "../state/studio.js"
 * @import {Problem} from "../types.js"
 */

import { ApiError, isAbort } from "../api.js";
import { h } from "../elements/dom.js";
import { icon } from "../elements/icons.js";
import { runJob } from "../services/jobs.js";
import { problemText } from "./problem.js";
import { textButton } from "./buttons.js";

export class Run {
  /** @type {AbortController | null} */ #running = null;
  #bar = h("progress", { max: 1, "aria-label": "Progress" });
  #text = h("span", { class: "figures" });
  #busy = h(
    "div",
    { class: "inverse-run line gap-10", hidden: true },
    this.#bar,
    this.#text,
    textButton("stop", "Cancel", () => this.cancel()),
  );
  #problem = h("div", { class: "problem", role: "alert", hidden: true });
  element = h("div", { class: "inverse-status", "aria-live": "polite" }, this.#busy, this.#problem);

  /** @param {Studio} [studio] if the computation is of its design: it is given up when another one is opened */
  constructor(studio) {
    if (!studio) return;
    let design = studio.designId;
    studio.document.onSettle(() => {
      if (design !== studio.designId) this.cancel();
      design = studio.designId;
    });
  }

  /**
   * Say that something is under way, until it is done or given up.
   *
   * @template T
   * @param {string} doing in words
   * @param {(signal: AbortSignal) => Promise<T>} work
   * @returns {Promise<T | null>} null if it was given up
   */
  async during(doing, work) {
    this.cancel();
    const controller = new AbortController();
    this.#running = controller;
    this.#busy.hidden = false;
    this.#bar.removeAttribute("value");
    this.#text.textContent = doing;
    try {
      const result = await work(controller.signal);
      return controller.signal.aborted ? null : result;
    } finally {
      if (this.#running === controller) {
        this.#running = null;
        this.#busy.hidden = true;
      }
    }
  }

  /**
   * @template T
   * @param {string} kind
   * @param {unknown} request
   * @param {string} doing in words
   * @returns {Promise<T | null>} null if it was given up or failed, which is then on show
   */
  run(kind, request, doing) {
    /** @param {AbortSignal} signal @returns {Promise<T | null>} */
    const work = async (signal) => {
      try {
        return await runJob(kind, request, {
          signal,
          onProgress: ({ state, progress }) => {
            if (state === "waiting") this.#text.textContent = "Waiting for its turn …";
            else {
              if (progress > 0) this.#bar.value = progress;
              this.#text.textContent = progress > 0 ? `${doing} ${Math.round(100 * progress)} %` : doing;
            }
          },
        });
      } catch (error) {
        if (isAbort(error) || signal.aborted) return null;
        if (!(error instanceof ApiError)) throw error;
        this.say(error.problem);
        return null;
      }
    };
    return this.during(doing, work);
  }

  /** @param {Pick<Problem, "title" | "detail" | "remedy">} problem */
  say(problem) {
    this.#problem.hidden = false;
    this.#problem.replaceChildren(icon("warning"), problemText(problem));
    this.#problem.scrollIntoView({ block: "nearest" }); // it may lie below a long form
  }

  /** Give it up; the service stops it too. */
  cancel() {
    this.#running?.abort();
    this.#running = null;
    this.#busy.hidden = this.#problem.hidden = true;
  }
}
