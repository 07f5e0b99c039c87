/**
 * Putting a repeat into the chart: where it goes, and in which words that is said.
 *
 * @import {ChartView} from "../../chart/view.js"
 * @import {Studio} from "../../state/studio.js"
 *
 * @typedef {{cells: number[], name: string}} Place
 */

import { UNDO } from "../../core/pointing.js";
import { motifGrid } from "../../grid/grid.js";
import { selectedCells, selects } from "../../design/selection.js";
import { byId, h } from "../../elements/dom.js";
import { thumbnail } from "../../widgets/thumbnail.js";

/** @type {Record<string, string>} */
const NAMES = {
  K: "stockinette",
  "P/K": "garter",
  "K/P": "garter",
  KP: "1×1 rib",
  PK: "1×1 rib",
  "PK/KP": "seed",
  "KP/PK": "seed",
};
/** Pixels of movement after which a press is a drag. */
const DRAG_PX = 5;

/** @param {string} key */
export function nameOf(key) {
  const rows = key.split("/");
  return NAMES[key] ?? (key.length <= 14 ? key : `${rows[0].length} × ${rows.length} repeat`);
}

/** @param {string} key @param {number} side */
export function repeatPicture(key, side) {
  const motif = motifGrid(key);
  const times = (/** @type {number} */ length) => length * Math.max(1, Math.round(8 / length));
  return thumbnail({ chart: motif.tiled(times(motif.rows), times(motif.columns)).text }, { side });
}

/** The selection, or the whole chart if nothing is selected. @param {Studio} studio @returns {Place} */
export function chosenPlace({ document: { grid }, selection }) {
  return {
    cells: selectedCells(selection.value ?? grid.box, grid),
    name: selection.value ? "the selection" : "the whole chart",
  };
}

/**
 * What lies under a point of the chart: the selection, a region, or else the whole chart.
 *
 * @param {Studio} studio
 * @param {number} row
 * @param {number} column
 * @returns {Place}
 */
function placeAt(studio, row, column) {
  const { document: chart, selection } = studio;
  const { grid } = chart;
  if (selection.value && selects(selection.value, row, column)) return chosenPlace(studio);
  const region = grid.has(row, column) ? chart.regionAt(grid.index(row, column)) : null;
  if (!region || region.hidden) return { cells: selectedCells(grid.box, grid), name: "the whole chart" };
  return { cells: region.stitches, name: region.name };
}

/**
 * Fill a place with a repeat, as one step.
 *
 * @param {Studio} studio
 * @param {string} key
 * @param {Place} place
 * @param {string} [material] of which yarn it was predicted
 */
export function fillWith(studio, key, place, material) {
  const motif = motifGrid(key);
  const { document: chart } = studio;
  const { columns } = chart.grid;
  chart.set(
    place.cells.map((i) => {
      const row = Math.floor(i / columns) % motif.rows;
      return [i, motif.purl[motif.index(row, (i % columns) % motif.columns)]];
    }),
    `Fill with ${nameOf(key)}`,
  );
  const other = material && material !== studio.materialId.value;
  if (other) studio.materialId.value = material;
  studio.tell(`${nameOf(key)} fills ${place.name}${other ? ", and the yarn is changed" : ""}. ${UNDO}`);
}

/**
 * Drag a repeat onto the chart, from a press on it.
 *
 * @param {PointerEvent} down
 * @param {Studio} studio
 * @param {ChartView} view
 * @param {string} key
 * @param {() => void} [clicked] if it was let go where it was pressed
 * @param {string} [material]
 */
export function carry(down, studio, view, key, clicked = () => {}, material) {
  if (down.button !== 0) return;
  const canvas = byId("chart");
  const hint = h("span", {});
  const ghost = h("div", { class: "inverse-ghost line gap-8", "aria-hidden": "true" }, repeatPicture(key, 56), hint);
  const release = new AbortController();
  /** @type {Place | null} */
  let place = null;
  const end = () => {
    release.abort();
    ghost.remove();
    delete document.documentElement.dataset.carrying;
  };
  /** @param {PointerEvent} event */
  const move = ({ clientX, clientY }) => {
    const far = Math.hypot(clientX - down.clientX, clientY - down.clientY) > DRAG_PX;
    if (!ghost.isConnected && !far) return;
    if (!ghost.isConnected) {
      document.body.append(ghost);
      document.documentElement.dataset.carrying = "";
    }
    const box = canvas.getBoundingClientRect();
    const inside = clientX > box.left && clientX < box.right && clientY > box.top && clientY < box.bottom;
    place = null;
    if (inside) {
      const [row, column] = view.cellAt({ offsetX: clientX - box.left, offsetY: clientY - box.top });
      place = placeAt(studio, row, column);
    }
    hint.textContent = place ? `Fill ${place.name}` : "Drop on the chart";
    ghost.style.translate = `${clientX + 12}px ${clientY + 12}px`;
  };
  window.addEventListener("pointermove", move, { signal: release.signal });
  window.addEventListener(
    "pointerup",
    () => {
      const dragged = ghost.isConnected;
      const onto = place;
      end();
      if (!dragged) clicked();
      else if (onto) fillWith(studio, key, onto, material);
    },
    { signal: release.signal },
  );
  window.addEventListener("pointercancel", end, { signal: release.signal });
  window.addEventListener(
    "keydown",
    (event) => {
      if (event.key !== "Escape" || !ghost.isConnected) return;
      event.preventDefault();
      event.stopPropagation();
      end();
    },
    { signal: release.signal, capture: true },
  );
  down.preventDefault();
}
