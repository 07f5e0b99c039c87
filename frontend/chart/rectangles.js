/**
 * Extensibility rectangles: as wide as the fabric yields along the course, as high as along the wale
 * (its principal directions), all on one scale. For single stitches, blocks of them, or regions.
 *
 * @import {Box} from "../grid/grid.js"
 * @import {Studio} from "../state/studio.js"
 * @import {StitchKind} from "../types.js"
 * @import {Viewport} from "./viewport.js"
 *
 * @typedef {{box: Box, cells: Iterable<number>, count: number}} Group
 */

/** Smaller ones cannot be read, so stitches are averaged in blocks of this many pixels. */
const SMALLEST = 12;
/** No rectangle has room of more than this many stitches. */
const LARGEST = 12;

/**
 * @param {CanvasRenderingContext2D} context
 * @param {Viewport} viewport
 * @param {Studio} studio
 * @param {Box} box stitches to draw
 */
export function drawRectangles(context, viewport, studio, box) {
  const kinds = studio.kinds();
  const { grid, codes } = studio.document;
  const { cellWidth: w, cellHeight: h } = viewport;
  const largest = largestExtensibility(kinds);
  // The same for all, so that they compare.
  const room = 0.94 * roomInStitches(studio, viewport) * Math.min(w, h);
  const path = new Path2D();
  for (const { box: place, cells, count } of groups(studio, box, sideOfBlocks(studio, viewport))) {
    const { course, wale } = meanExtensibility(kinds, codes, cells, count);
    // The square root keeps stiff fabrics visible beside ribs that give fifty times as much.
    const wide = Math.sqrt(course / largest) * room;
    const high = Math.sqrt(wale / largest) * room;
    const x = viewport.x + (w * (place.column0 + place.column1)) / 2;
    const y = viewport.y + h * (grid.rows - (place.row0 + place.row1) / 2);
    path.rect(x - wide / 2, y - high / 2, wide, high);
  }
  context.fillStyle = "rgb(255 252 246 / 0.5)";
  context.fill(path);
  context.lineWidth = Math.max(1, Math.min(1.6, w / 14));
  context.strokeStyle = "rgb(24 18 14 / 0.85)";
  context.stroke(path);
}

/** Stitches on a side of the blocks that rectangles stand for, as drawn. @param {Studio} studio @param {Viewport} viewport */
export function sideOfBlocks({ seeing }, { cellWidth, cellHeight }) {
  const readable = Math.max(1, Math.ceil(SMALLEST / Math.min(cellWidth, cellHeight)));
  return seeing.groups.value === "block" ? Math.max(seeing.block.value, readable) : readable;
}

/** Stitches on a side of the square that the largest rectangle fills. @param {Studio} studio @param {Viewport} viewport */
export function roomInStitches(studio, viewport) {
  const { document: chart, seeing } = studio;
  const side =
    seeing.groups.value === "region"
      ? Math.sqrt(Math.max(1, ...chart.regions.filter(({ hidden }) => !hidden).map(({ count }) => count)))
      : sideOfBlocks(studio, viewport);
  return Math.min(Math.round(side), LARGEST);
}

/** What the side of a rectangle that fills its room stands for, mm/N. @param {StitchKind[]} kinds */
export const largestExtensibility = (kinds) =>
  Math.max(...kinds.flatMap((k) => [k.extensibility_course_mm_per_n, k.extensibility_wale_mm_per_n]));

/**
 * The group of stitches that one rectangle stands for, at a stitch; null where there is none.
 *
 * @param {Studio} studio
 * @param {number} row
 * @param {number} column
 * @param {number} size of the blocks
 * @returns {Group | null}
 */
export function groupAt(studio, row, column, size) {
  const { document: chart, seeing } = studio;
  if (seeing.groups.value === "region") {
    const region = chart.regionAt(chart.grid.index(row, column));
    return region ? regionGroup(studio, region) : null;
  }
  return blockGroup(studio, row - (row % size), column - (column % size), size);
}

/**
 * @param {StitchKind[]} kinds by code
 * @param {Uint8Array} codes
 * @param {Iterable<number>} cells
 * @param {number} count
 */
export function meanExtensibility(kinds, codes, cells, count) {
  let course = 0;
  let wale = 0;
  for (const i of cells) {
    const kind = kinds[codes[i]];
    course += kind.extensibility_course_mm_per_n;
    wale += kind.extensibility_wale_mm_per_n;
  }
  return { course: course / count, wale: wale / count };
}

/**
 * @param {Studio} studio
 * @param {Box} box
 * @param {number} size of the blocks
 * @returns {Iterable<Group>}
 */
function* groups(studio, box, size) {
  const { document: chart, seeing } = studio;
  if (seeing.groups.value === "region") {
    for (const region of chart.regions) {
      const group = region.hidden ? null : regionGroup(studio, region);
      if (group) yield group;
    }
    return;
  }
  for (let row = box.row0 - (box.row0 % size); row < box.row1; row += size) {
    for (let column = box.column0 - (box.column0 % size); column < box.column1; column += size) {
      const group = blockGroup(studio, row, column, size);
      if (group) yield group;
    }
  }
}

/**
 * The stitches of a block, without those outside the outline; null if it has none.
 *
 * @param {Studio} studio
 * @param {number} row0
 * @param {number} column0
 * @param {number} size
 * @returns {Group | null}
 */
function blockGroup({ document: { grid, shaped, outline } }, row0, column0, size) {
  const box = {
    row0,
    column0,
    row1: Math.min(row0 + size, grid.rows),
    column1: Math.min(column0 + size, grid.columns),
  };
  const cells = [];
  for (let row = row0; row < box.row1; row++) {
    for (let column = column0; column < box.column1; column++) {
      const i = grid.index(row, column);
      if (!shaped || outline[i]) cells.push(i);
    }
  }
  return cells.length ? { box, cells, count: cells.length } : null;
}

/** @param {Studio} studio @param {import("../design/regions.js").Region} region @returns {Group | null} */
function regionGroup({ document: { grid, shaped, outline } }, region) {
  const cells = shaped ? region.stitches.filter((i) => outline[i]) : region.stitches;
  const count = cells.length;
  if (!count) return null;
  let row = 0;
  let column = 0;
  for (const i of cells) {
    row += Math.floor(i / grid.columns) / count;
    column += (i % grid.columns) / count;
  }
  return { box: { row0: row, column0: column, row1: row + 1, column1: column + 1 }, cells, count };
}
