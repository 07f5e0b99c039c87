/**
 * The rows of a piece for whoever knits it, and where they are in it.
 *
 * @import {Studio} from "../state/studio.js"
 * @import {KnittingPlace} from "../design/store.js"
 * @import {KnitAlongRequest, KnitAlongResult} from "../types.js"
 * @import {Machine} from "./machines.js"
 */

import { ApiError, api } from "../api.js";
import { loadPlace, loadRows, savePlace, saveRows } from "../design/store.js";
import { ownMachine } from "./machines.js";

/** The row from which the next program or plan begins, after a jam. */
export const resume = { row: 1 };

/**
 * Ways to knit a piece: by hand, on the home machines of the service, and on one of the user's own.
 *
 * @param {readonly Machine[]} machines
 * @param {string | null} chosen the machine of the design
 * @returns {Record<string, string>} their words
 */
export function waysOf(machines, chosen) {
  const own = ownMachine(chosen);
  const home = [...machines, ...(own ? [own] : [])].filter(({ reads_programs }) => !reads_programs);
  return {
    flat: "By hand, flat",
    round: "By hand, in the round",
    ...Object.fromEntries(home.map(({ identifier, name }) => [identifier, name])),
  };
}

/** @param {Pick<Studio, "document" | "machine" | "materialId">} studio @param {string} way @returns {KnitAlongRequest} */
export function alongRequest({ document: chart, machine: { value: chosen }, materialId }, way) {
  const { chart: plain, other_stitches: others, outline, regions, repeats, shelf } = chart.content;
  const parts = { chart: others?.length ? chart.text : plain, outline, regions, repeats, shelf };
  const byHand = way === "flat" || way === "round";
  const machine = byHand ? null : ownMachine(chosen)?.identifier === way ? chosen : way;
  const construction = way === "round" ? "round" : "flat";
  return { ...parts, machine, construction, material: materialId.value };
}

/**
 * The rows; where the service is away, those that were seen of this very piece before.
 *
 * @param {KnitAlongRequest} request
 * @returns {Promise<KnitAlongResult>}
 */
export async function alongRows(request) {
  const key = JSON.stringify(request);
  try {
    const rows = await api.run("knit-along", request);
    saveRows(key, rows);
    return rows;
  } catch (error) {
    const kept = error instanceof ApiError && error.offline ? loadRows(key) : null;
    if (!kept) throw error;
    return /** @type {KnitAlongResult} */ (kept);
  }
}

/**
 * Which repeat of the pattern a row is in; "" where there is only one.
 *
 * @param {number} row from 1
 * @param {number} rows
 * @param {number} period rows of the repeat
 */
export function repeatWords(row, rows, period) {
  if (period >= rows || period < 2) return "";
  const times = Math.ceil(rows / period);
  return `Repeat ${Math.ceil(row / period)} of ${times}, row ${((row - 1) % period) + 1} of ${period}`;
}

/** A step that a key asks for: to the next row, to the one before, to the first or to the last. @param {string} key */
export const stepOf = (key) =>
  ({
    ArrowRight: 1,
    PageDown: 1,
    " ": 1,
    Enter: 1,
    ArrowLeft: -1,
    PageUp: -1,
    Backspace: -1,
    Home: -Infinity,
    End: Infinity,
  })[key] ?? 0;

/**
 * The place in a piece: with the design at the service, so that another device goes on there, and in the browser
 * while there is no service.
 */
export class Places {
  #sending = false;

  /**
   * @param {() => string | null} design the service's name for the design, if it has one
   * @param {(state: "design" | "browser" | "nowhere") => void} kept says where it is kept
   */
  constructor(design, kept) {
    this.design = design;
    this.kept = kept;
  }

  /** The way in which the piece was knitted last; "" where that is not known. @returns {Promise<string>} */
  async lastWay() {
    return (await this.#ofDesign())[0]?.way ?? "";
  }

  /** @param {string} piece its name in the browser @param {string} way @returns {Promise<KnittingPlace>} */
  async load(piece, way) {
    const here = loadPlace(piece);
    if (here.unsent) return (this.#send(piece, way), here);
    const there = (await this.#ofDesign()).find((place) => place.way === way);
    this.kept(this.design() ? "design" : "browser");
    return there ? { row: there.row, count: there.count } : here;
  }

  /** @param {string} piece @param {string} way @param {KnittingPlace} place */
  save(piece, way, { row, count }) {
    const isKept = savePlace(piece, { row, count, unsent: true });
    if (this.design()) this.#send(piece, way, { row, count });
    else this.kept(isKept ? "browser" : "nowhere");
  }

  /** @returns {Promise<import("../types.js").KnittingPlaces["places"]>} */
  async #ofDesign() {
    const design = this.design();
    if (!design) return [];
    try {
      return (await api.places(design)).places;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      return []; // the browser's own is the best there is
    }
  }

  /** Send the latest place, one at a time. @param {string} piece @param {string} way @param {KnittingPlace} [latest] */
  async #send(piece, way, latest = loadPlace(piece)) {
    const design = this.design();
    this.waiting = { design, piece, way, latest };
    if (this.#sending || !design) return;
    this.#sending = true;
    try {
      while (this.waiting) {
        const { design: name, piece: of, way: how, latest: place } = this.waiting;
        this.waiting = null;
        if (!name) continue;
        await api.keepPlace(name, how, { row: place.row, count: place.count });
        if (!this.waiting) savePlace(of, { row: place.row, count: place.count });
        this.kept("design");
      }
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      this.kept("browser");
    } finally {
      this.#sending = false;
    }
  }
}
