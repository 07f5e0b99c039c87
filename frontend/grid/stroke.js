/**
 * What a gesture wants of the stitches, and what it has flipped so far.
 *
 * @import {Box} from "./grid.js"
 */

import { toRuns } from "./bits.js";

/** A stitch that a brush does not touch. */
const UNTOUCHED = 2;

/** The values that stitches (or groups of them) shall have: 0, 1 or unchanged. */
export class Brush {
  /** @type {Uint32Array} */ #list;
  count = 0;

  /** @param {number} length */
  constructor(length) {
    this.values = new Uint8Array(length).fill(UNTOUCHED);
    this.#list = new Uint32Array(length);
  }

  /** @param {number} length @param {Iterable<readonly [number, number]>} cells stitch and its value */
  static of(length, cells) {
    const brush = new Brush(length);
    for (const [i, value] of cells) brush.set(i, value);
    return brush;
  }

  /** @param {number} i @param {number} value */
  set(i, value) {
    if (this.values[i] === UNTOUCHED) this.#list[this.count++] = i;
    this.values[i] = value;
  }

  /** Whether it changes a stitch. @param {number} i */
  has(i) {
    return this.values[i] !== UNTOUCHED;
  }

  clear() {
    for (let k = 0; k < this.count; k++) this.values[this.#list[k]] = UNTOUCHED;
    this.count = 0;
  }

  /** Those touched, in the order in which they first were. */
  get touched() {
    return this.#list.subarray(0, this.count);
  }
}

/** A bitmap during a stroke: knows which of its stitches the stroke has flipped. */
export class Layer {
  /** @type {Uint8Array} */ #flipped;
  /** Holds all that was flipped. @type {Box | null} */ #reach = null;

  /** @param {Uint8Array} bitmap changed in place @param {number} columns */
  constructor(bitmap, columns) {
    this.bitmap = bitmap;
    this.columns = columns;
    this.#flipped = new Uint8Array(bitmap.length);
  }

  /** Whether the stroke has flipped this stitch. @param {number} i */
  has(i) {
    return this.#flipped[i] === 1;
  }

  /** @returns {Box | null} where the stroke has been */
  get reach() {
    return this.#reach;
  }

  /**
   * Make stitches what is wanted.
   *
   * @param {Brush} brush
   * @param {boolean} fresh whether the stroke is only this: what it flipped before goes back
   * @returns {Box | null} what changed
   */
  apply(brush, fresh) {
    const { bitmap, columns } = this;
    const flipped = this.#flipped;
    const box = { row0: Infinity, column0: Infinity, row1: 0, column1: 0 };
    /** @param {number} i @param {number} row @param {number} column */
    const toggle = (i, row, column) => {
      bitmap[i] ^= 1;
      flipped[i] ^= 1;
      if (row < box.row0) box.row0 = row;
      if (row >= box.row1) box.row1 = row + 1;
      if (column < box.column0) box.column0 = column;
      if (column >= box.column1) box.column1 = column + 1;
    };
    if (fresh && this.#reach) {
      const { row0, column0, row1, column1 } = this.#reach;
      for (let row = row0; row < row1; row++) {
        for (let column = column0; column < column1; column++) {
          const i = row * columns + column;
          if (flipped[i] && brush.values[i] === UNTOUCHED) toggle(i, row, column);
        }
      }
    }
    for (const i of brush.touched) {
      if (bitmap[i] === brush.values[i]) continue;
      const row = Math.floor(i / columns);
      toggle(i, row, i - row * columns);
    }
    if (box.row1 === 0) return null;
    this.#reach = this.#reach ? union(this.#reach, box) : box;
    return box;
  }

  /** Take everything back. @returns {Box | null} what changed */
  revert() {
    return this.apply(new Brush(this.bitmap.length), true);
  }

  /** What was flipped. @returns {number[]} as runs */
  get runs() {
    if (!this.#reach) return [];
    const { columns } = this;
    return toRuns(this.#flipped, this.#reach.row0 * columns, this.#reach.row1 * columns);
  }
}

/** @param {Box} a @param {Box} b @returns {Box} */
function union(a, b) {
  return {
    row0: Math.min(a.row0, b.row0),
    column0: Math.min(a.column0, b.column0),
    row1: Math.max(a.row1, b.row1),
    column1: Math.max(a.column1, b.column1),
  };
}
