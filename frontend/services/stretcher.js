/**
 * Runs stretch tests and plays them.
 *
 * @import {Studio} from "../state/studio.js"
 * @import {Direction, StretchResult, StretchRequest} from "../types.js"
 *
 * @typedef {Pick<StretchRequest, "strain" | "force_n">} Pull how far, or how hard
 * @typedef {Partial<Pick<StretchRequest, "clamps" | "model" | "shear_modulus_n_per_mm">>} StretchOptions
 */

import { ApiError, api, isAbort } from "../api.js";
import { Belonging } from "./belonging.js";
import { OVERLAYS } from "../state/overlays.js";
import { Signal } from "../core/signal.js";
import { pieceOf } from "./scope.js";
import { runJob } from "./jobs.js";

const STEPS = 20;
const FRAME_MS = 140;
/** Tests that took no longer than this are repeated automatically after a change. */
const FAST_S = 3;
const AGAIN_MS = 900;

export class Stretcher {
  /** @type {AbortController | null} */ #running = null;
  /** @type {ReturnType<typeof setInterval> | undefined} */ #timer;
  /** @type {StretchRequest | null} */ #request = null;
  /** Of which design the last test was. */ #design = "";
  /** @type {ReturnType<typeof setTimeout> | undefined} */ #soon;
  /** @type {Set<() => void>} */ #played = new Set();
  /** Share of the test that is done; null while it waits for its turn. */
  progress = new Signal(/** @type {number | null} */ (null));

  /** @param {Studio} studio */
  constructor(studio) {
    this.studio = studio;
    const { stretch } = studio;
    this.belonging = new Belonging(studio, () => {
      const { chart, outline, material: yarn, gauge } = pieceOf(studio);
      return { chart: [chart, outline], yarn, gauge };
    });
    const pullSoon = () => {
      clearTimeout(this.#soon);
      if (stretch.value.stale && (stretch.value.value?.seconds ?? Infinity) < FAST_S) {
        this.#soon = setTimeout(() => void this.#pullAgain(), AGAIN_MS);
      }
    };
    this.belonging.stale.listen((stale) => {
      if (stale) this.pause();
      stretch.value = { ...stretch.value, stale };
      pullSoon();
    });
    stretch.listen(({ value }) => value || this.belonging.clear());
    const outdate = () => {
      this.cancel();
      pullSoon();
    };
    studio.document.onSettle(outdate);
    studio.materialId.listen(outdate);
    studio.gauges.changes.listen(outdate);
    studio.seeing.pose.listen((pose) => pose !== "flat" && this.playing && this.pause());
    studio.seeing.forgotten.listen((id) => void this.#again(id));
  }

  get playing() {
    return this.#timer !== undefined;
  }

  /** @param {() => void} listener hears when playing starts or stops */
  onPlay(listener) {
    this.#played.add(listener);
  }

  /**
   * @param {Direction} direction
   * @param {Pull} pull
   * @param {StretchOptions} [options]
   * @returns {Promise<StretchResult | null>} null if it was given up or refused
   */
  async run(direction, pull, options = {}) {
    const { studio } = this;
    this.cancel();
    this.pause();
    const controller = new AbortController();
    this.#running = controller;
    this.progress.value = null;
    const { basis } = this.belonging;
    const request = { ...pieceOf(studio), direction, ...pull, steps: STEPS, ...options };
    studio.stretch.value = { ...studio.stretch.value, busy: true, problem: null };
    try {
      /** @type {StretchResult} */
      const value = await runJob("stretch", request, {
        signal: controller.signal,
        onProgress: ({ state, progress }) => {
          this.progress.value = state === "waiting" ? null : progress;
        },
      });
      if (controller.signal.aborted) return null;
      this.#request = request;
      this.#design = studio.designId;
      studio.stretch.value = { value, direction, busy: false, stale: "", problem: null };
      this.belonging.show(basis);
      studio.online.value = true;
      studio.step.value = value.strain.length - 1;
      const overlay = OVERLAYS.find(({ id }) => id === "strain");
      if (overlay) studio.overlay.value = overlay;
      return value;
    } catch (error) {
      if (isAbort(error) || controller.signal.aborted) return null;
      if (!(error instanceof ApiError)) throw error;
      studio.stretch.value = { ...studio.stretch.value, busy: false, problem: error.problem };
      if (error.offline) studio.online.value = false;
      return null;
    } finally {
      if (this.#running === controller) this.#running = null;
    }
  }

  /** The test on show with the chart as it is now, at the same step. */
  async #pullAgain() {
    const { studio } = this;
    const { stale, busy, value } = studio.stretch.value;
    if (!stale || busy || !value || !this.#request || this.#design !== studio.designId) return;
    const { direction, strain, force_n, clamps, model, shear_modulus_n_per_mm } = this.#request;
    const [step, overlay] = [studio.step.value, studio.overlay.value];
    if (studio.document.painting) this.#soon = setTimeout(() => void this.#pullAgain(), AGAIN_MS);
    else if (await this.run(direction, { strain, force_n }, { clamps, model, shear_modulus_n_per_mm })) {
      studio.step.value = step;
      studio.overlay.value = overlay;
    }
  }

  /**
   * The numbers of a test outlive a restart of the service, what the 3D view needs of it does not:
   * have it run once more.
   *
   * @param {string | null} id
   */
  async #again(id) {
    const { studio } = this;
    if (!this.#request || id === null || studio.currentStretch()?.id !== id) return;
    try {
      await api.run("stretch", this.#request);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      studio.tellProblem(error.problem);
      return; // the view stays at rest
    }
    studio.seeing.forgotten.value = null;
    const { stretch } = studio;
    if (stretch.value.value?.id === id) stretch.value = { ...stretch.value };
  }

  /** Give up the test under way; the service stops it too. */
  cancel() {
    if (!this.#running) return;
    this.#running.abort();
    this.#running = null;
    this.studio.stretch.value = { ...this.studio.stretch.value, busy: false };
  }

  play() {
    const { studio } = this;
    const steps = studio.currentStretch()?.strain.length ?? 0;
    if (steps < 2) return;
    if (studio.step.value >= steps - 1) studio.step.value = 0;
    clearInterval(this.#timer);
    this.#timer = setInterval(() => {
      if (studio.step.value >= steps - 1) this.pause();
      else studio.step.value += 1;
    }, FRAME_MS);
    for (const listener of this.#played) listener();
  }

  pause() {
    clearInterval(this.#timer);
    this.#timer = undefined;
    for (const listener of this.#played) listener();
  }
}
