/**
 * A picture of the cloth that the service draws in a tenth of the time that the live view needs to
 * start: on show until that is there, and all the time in browsers that draw nothing in 3D.
 *
 * @import {ViewRequest} from "../../types.js"
 */

import { ApiError, fetched } from "../../api.js";
import { h } from "../../elements/dom.js";

/** Pixels that the service draws at most. */
const WIDEST = 1600;
const HIGHEST = 1200;

export class Still {
  /** @param {HTMLElement} frame of the live view, in whose place it stands */
  constructor(frame) {
    this.frame = frame;
  }

  root = h("img", { class: "fabric-still full-width shrinks-y", alt: "", hidden: true });
  /** What was asked for last. */
  #lastRequest = "";
  #busy = false;
  /** Grows with each design: a picture of the one before is not shown any more. */
  #design = 0;

  /** At most one is being drawn; of the requests meanwhile only the last is. @param {ViewRequest} request @param {() => void} shown */
  async draw(request, shown) {
    const requestText = JSON.stringify(request);
    if (requestText === this.#lastRequest) return;
    this.#lastRequest = requestText;
    if (this.#busy) return;
    this.#busy = true;
    const design = this.#design;
    try {
      const content = await this.#drawn(request);
      if (design === this.#design) {
        URL.revokeObjectURL(this.root.src);
        this.root.src = URL.createObjectURL(content);
        this.root.hidden = false;
        shown();
      }
    } catch (error) {
      if (!(error instanceof ApiError)) throw error; // the live view asks for the same, and reports it
    } finally {
      this.#busy = false;
    }
    if (this.#lastRequest && (this.#lastRequest !== requestText || design !== this.#design)) {
      const next = JSON.parse(this.#lastRequest);
      this.#lastRequest = "";
      await this.draw(next, shown);
    }
  }

  /** The live view is there, or another design. */
  clear() {
    this.#design++;
    this.#lastRequest = "";
    this.root.hidden = true;
  }

  /** @param {ViewRequest} request */
  async #drawn(request) {
    const { clientWidth, clientHeight } = this.frame;
    const width = Math.max(16, Math.min(WIDEST, clientWidth));
    const height = Math.max(16, Math.min(HIGHEST, clientHeight));
    const answer = await fetched(`/views/still?width=${width}&height=${height}`, { method: "POST", body: request });
    return answer.blob();
  }
}
