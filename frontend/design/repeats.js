/**
 * Linked repeats: a motif, and places in the chart that follow it. Painting one copy paints all.
 *
 * @import {PlacementItem, RepeatItem} from "./design.js"
 * @import {Region} from "./regions.js"
 * @import {Grid} from "../grid/grid.js"
 */

import { motifGrid, motifText } from "../grid/grid.js";
import { Brush } from "../grid/stroke.js";

/**
 * @typedef {object} RepeatLook
 * @property {string} name
 * @property {Grid} motif
 * @property {number} edgeColumns stitches beyond whole motifs: "multiple of n + m"
 * @property {number} edgeRows
 * @property {readonly PlacementItem[]} placements later ones lie on top
 */

/** Immutable, except for its motif during a stroke. */
export class Repeat {
  /** @param {string} id @param {RepeatLook} look */
  constructor(id, look) {
    this.id = id;
    this.name = look.name;
    this.motif = look.motif;
    this.edgeColumns = look.edgeColumns;
    this.edgeRows = look.edgeRows;
    this.placements = look.placements;
  }

  /** @param {Partial<RepeatLook>} changes */
  with(changes) {
    return new Repeat(this.id, { ...this, ...changes });
  }

  /** Such as "multiple of 8 + 1 sts, 4 rows". */
  get rule() {
    const { motif, edgeColumns, edgeRows } = this;
    /** @param {number} n @param {number} m */
    const of = (n, m) => (m ? `${n} + ${m}` : String(n));
    return `multiple of ${of(motif.columns, edgeColumns)} sts × ${of(motif.rows, edgeRows)} rows`;
  }

  /**
   * The nearest size that holds whole motifs and the edge.
   *
   * @param {number} rows
   * @param {number} columns
   * @returns {{rows: number, columns: number}}
   */
  snapped(rows, columns) {
    const { motif, edgeColumns, edgeRows } = this;
    /** @param {number} size @param {number} n @param {number} m */
    const snap = (size, n, m) => Math.max(1, Math.round((size - m) / n)) * n + m;
    return { rows: snap(rows, motif.rows, edgeRows), columns: snap(columns, motif.columns, edgeColumns) };
  }

  /** The stitches of a placement. @param {{rows: number, columns: number}} size */
  laid({ rows, columns }) {
    return this.motif.tiled(rows, columns);
  }

  /** @param {RepeatItem} item */
  static read(item) {
    return new Repeat(item.id, {
      name: item.name,
      motif: motifGrid(item.motif),
      edgeColumns: item.edge_columns,
      edgeRows: item.edge_rows,
      placements: item.placements,
    });
  }

  /** @returns {RepeatItem} */
  written() {
    return {
      id: this.id,
      name: this.name,
      motif: motifText(this.motif),
      edge_columns: this.edgeColumns,
      edge_rows: this.edgeRows,
      placements: this.placements.map((place) => ({ ...place })),
    };
  }
}

/** The stitches of a repeat's placements. @param {Repeat} repeat @param {Grid} grid */
export function laying(repeat, grid) {
  const brush = new Brush(grid.purl.length);
  for (const place of repeat.placements) {
    const part = repeat.laid(place);
    part.purl.forEach((p, k) => {
      const row = place.row + Math.floor(k / part.columns);
      const column = place.column + (k % part.columns);
      if (grid.has(row, column)) brush.set(grid.index(row, column), p);
    });
  }
  return brush;
}

/**
 * A repeat's placements and one more, without those that it covers whole.
 *
 * @param {Repeat} repeat
 * @param {PlacementItem} place
 */
export function withPlace({ placements }, place) {
  const { row, column, rows, columns } = place;
  const seen = placements.filter(
    (other) =>
      other.row < row ||
      other.column < column ||
      other.row + other.rows > row + rows ||
      other.column + other.columns > column + columns,
  );
  return [...seen, place];
}

/** Repeats with only those placements that a chart shows. @param {readonly Repeat[]} repeats @param {Grid} grid */
export function matching(repeats, grid) {
  return repeats.map((repeat) => {
    const placements = repeat.placements.filter((place) => {
      const { row: row0, column: column0 } = place;
      const box = { row0, column0, row1: row0 + place.rows, column1: column0 + place.columns };
      const inside = box.row1 <= grid.rows && box.column1 <= grid.columns;
      return inside && grid.region(box).equals(repeat.laid(place));
    });
    return placements.length === repeat.placements.length ? repeat : repeat.with({ placements });
  });
}

/** Which stitches stand for the same stitch of a motif, and which must not be painted. */
export class Links {
  /** Group of each stitch; 0 is none. @type {Int32Array} */ group;
  /** First member of each group in `members`. @type {Uint32Array} */ #starts;
  /** @type {Uint32Array} */ #members;
  /** 1 where a stitch, or one that is linked to it, belongs to a locked region. @type {Uint8Array} */
  locked;
  /** First group of each repeat. @type {number[]} */ #bases = [];

  /** @param {Grid} grid @param {readonly Repeat[]} repeats @param {readonly Region[]} regions */
  constructor({ rows, columns, purl: { length } }, repeats, regions) {
    this.group = new Int32Array(length);
    let groups = 1;
    for (const { motif, placements } of repeats) {
      this.#bases.push(groups);
      for (const place of placements) {
        const top = Math.min(rows, place.row + place.rows);
        const right = Math.min(columns, place.column + place.columns);
        for (let row = place.row; row < top; row++) {
          const base = groups + ((row - place.row) % motif.rows) * motif.columns;
          for (let column = place.column; column < right; column++) {
            this.group[row * columns + column] = base + ((column - place.column) % motif.columns);
          }
        }
      }
      groups += motif.purl.length;
    }
    this.groups = groups;
    this.#starts = new Uint32Array(groups + 1);
    for (const group of this.group) this.#starts[group + 1]++;
    for (let g = 0; g < groups; g++) this.#starts[g + 1] += this.#starts[g];
    const next = this.#starts.slice();
    this.#members = new Uint32Array(length);
    for (let i = 0; i < length; i++) this.#members[next[this.group[i]]++] = i;

    this.locked = new Uint8Array(length);
    for (const region of regions) {
      if (!region.locked) continue;
      for (let i = 0; i < length; i++) this.locked[i] |= region.cells[i];
    }
    for (let g = 1; g < groups; g++) {
      const members = this.members(g);
      if (members.some((i) => this.locked[i])) for (const i of members) this.locked[i] = 1;
    }
  }

  /** Stitches of a group. @param {number} group */
  members(group) {
    return this.#members.subarray(this.#starts[group], this.#starts[group + 1]);
  }

  /**
   * A stitch that shows the motif's stitch `cell`, if any does.
   *
   * @param {number} repeat its place in the list
   * @param {number} cell
   * @returns {number | undefined}
   */
  example(repeat, cell) {
    return this.members(this.#bases[repeat] + cell)[0];
  }
}
