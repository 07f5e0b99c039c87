/**
 * Runs stretch tests and plays them.
 *
 * @import {Studio} from "../studio.js"
 * @import {Direction, StretchResult, StretchRequest} from "../types.js"
 *
 * @typedef {Partial<Pick<StretchRequest, "clamps" | "model" | "shear_modulus_n_per_mm">>} StretchOptions
 */

import { ApiError, api, isAbort } from "../api.js";
import { OVERLAYS } from "../chart/overlays.js";
import { Signal } from "../core/signal.js";
import { outlineText } from "../core/snapshot.js";
import { runJob } from "./jobs.js";

const STEPS = 20;
const FRAME_MS = 140;

export class Stretcher {
  /** @type {AbortController | null} */ #running = null;
  /** @type {ReturnType<typeof setInterval> | undefined} */ #timer;
  /** @type {StretchRequest | null} */ #request = null;
  /** @type {Set<() => void>} */ #played = new Set();
  /** Share of the test that is done; null while it waits for its turn. */
  progress = new Signal(/** @type {number | null} */ (null));

  /** @param {Studio} studio */
  constructor(studio) {
    this.studio = studio;
    const outdate = () => {
      this.cancel();
      const { stretch } = studio;
      if (stretch.value.value && !stretch.value.stale) {
        this.pause();
        stretch.value = { ...stretch.value, stale: true };
      }
    };
    studio.document.onSettle(outdate);
    studio.materialId.listen(outdate);
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
   * @param {number} strain
   * @param {StretchOptions} [options]
   */
  async run(direction, strain, options = {}) {
    const { studio } = this;
    this.cancel();
    this.pause();
    const controller = new AbortController();
    this.#running = controller;
    this.progress.value = null;
    const { document: chart } = studio;
    const outline = chart.shaped ? outlineText(chart.outline, chart.grid.columns) : null;
    const request = { ...studio.request, outline, direction, strain, steps: STEPS, ...options };
    studio.stretch.value = { ...studio.stretch.value, busy: true, problem: null };
    try {
      /** @type {StretchResult} */
      const value = await runJob("stretch", request, {
        signal: controller.signal,
        onProgress: ({ state, progress }) => {
          this.progress.value = state === "waiting" ? null : progress;
        },
      });
      if (controller.signal.aborted) return;
      this.#request = request;
      studio.stretch.value = { value, direction, busy: false, stale: false, problem: null };
      studio.online.value = true;
      studio.step.value = value.strain.length - 1;
      const overlay = OVERLAYS.find(({ id }) => id === "strain");
      if (overlay) studio.overlay.value = overlay;
    } catch (error) {
      if (isAbort(error) || controller.signal.aborted) return;
      if (!(error instanceof ApiError)) throw error;
      studio.stretch.value = { ...studio.stretch.value, busy: false, problem: error.problem };
      if (error.offline) studio.online.value = false;
    } finally {
      if (this.#running === controller) this.#running = null;
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
      await api.stretch(this.#request);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error; // the view, asked again, says what is wrong
    }
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
