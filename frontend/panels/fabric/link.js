/**
 * Ties the chart and the 3D view together: what is pointed at or selected in the chart is outlined
 * on the fabric, and a stitch that is clicked on the fabric is shown in the chart.
 *
 * @import {ChartView} from "../../chart/view.js"
 * @import {MarkRequest} from "../../types.js"
 * @import {Studio} from "../../state/studio.js"
 */

import { ApiError, api } from "../../api.js";
import { paced } from "../../core/paced.js";
import { selectedLines } from "../../design/selection.js";

/** How often outlines follow the pointer. */
const PERIOD_MS = 150;
/** A view that is gone is looked for again after this time. */
const RETRY_MS = 2500;

export class ViewLink {
  /** @type {EventSource | null} */ #events = null;
  #marked = "";
  #sending = false;

  /**
   * @param {Studio} studio
   * @param {ChartView} view
   * @param {{lost: () => void, slow: () => boolean}} hooks called when the view is gone; whether drawing
   *   takes too long for the pointer
   */
  constructor(studio, view, hooks) {
    this.studio = studio;
    this.view = view;
    this.hooks = hooks;
    const later = paced(() => void this.mark(), PERIOD_MS);
    view.hover.listen(later);
    studio.selection.listen(later);
    studio.step.listen(later);
  }

  /** Listen to the clicks in a view that is open now. */
  connect() {
    if (this.#events && this.#events.readyState !== EventSource.CLOSED) return;
    const events = new EventSource(`/api/v1/views/${encodeURIComponent(this.studio.designId)}/events`);
    this.#events = events;
    events.addEventListener("stitch", ({ data }) => {
      const { row, column } = JSON.parse(data);
      this.#find(row, column);
    });
    events.onerror = () => {
      // While the service is unreachable the browser reconnects by itself; a refusal is final.
      if (events.readyState === EventSource.CLOSED) setTimeout(this.hooks.lost, RETRY_MS);
    };
  }

  /** The design is another one now. */
  disconnect() {
    this.#events?.close();
    this.#events = null;
    this.#marked = "";
  }

  /** Outline what is pointed at or selected. */
  async mark() {
    const { studio } = this;
    if (studio.document.painting || this.#sending || !this.#events) return;
    const mark = this.#mark();
    const key = this.#keyOf(mark);
    if (key === this.#marked) return;
    this.#sending = true;
    try {
      await api.mark(studio.designId, mark);
      this.#marked = key;
    } catch (error) {
      if (!(error instanceof ApiError)) throw error; // the next change tries again
    } finally {
      this.#sending = false;
    }
    if (this.#keyOf(this.#mark()) !== key) void this.mark();
  }

  /** @param {MarkRequest} mark */
  #keyOf(mark) {
    return JSON.stringify(mark.box && [mark, this.studio.step.value]);
  }

  /** What is to be outlined. @returns {MarkRequest} */
  #mark() {
    const { studio, view } = this;
    const { grid } = studio.document;
    const cell = this.hooks.slow() && studio.seeing.clickedStitch.value !== view.hover.value ? null : view.hover.value;
    if (cell && grid.has(...cell)) {
      const [row, column] = cell;
      return { box: { row0: row, column0: column, row1: row + 1, column1: column + 1 } };
    }
    const selection = studio.selection.value;
    if (!selection) return { box: null };
    const { row0, column0, row1, column1 } = selection;
    return { box: { row0, column0, row1, column1 }, part: selectedLines(selection) };
  }

  /** @param {number} row @param {number} column */
  #find(row, column) {
    const { studio, view } = this;
    if (!studio.document.grid.has(row, column)) return;
    /** @type {import("../../grid/raster.js").Cell} */
    const cell = [row, column];
    studio.seeing.clickedStitch.value = cell;
    this.#reveal(row, column);
    view.hover.value = cell;
  }

  /** Move the chart so that a stitch is seen. @param {number} row @param {number} column */
  #reveal(row, column) {
    const { view, studio } = this;
    const { viewport } = view;
    const { grid } = studio.document;
    const seen = viewport.visible(grid);
    if (row > seen.row0 && row < seen.row1 - 1 && column > seen.column0 && column < seen.column1 - 1) return;
    if (viewport.fitted) return;
    const place = viewport.place({ row0: row, column0: column, row1: row + 1, column1: column + 1 }, grid);
    view.pan(viewport.width / 2 - place.x, viewport.height / 2 - place.y);
  }
}
