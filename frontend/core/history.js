/**
 * Undo and redo as deltas. A stitch is K or P, so a stroke is the set of stitches that it flipped,
 * and flipping them again takes it back; only a change of size keeps the two charts.
 *
 * @typedef {{label: string, runs: number[]}} FlipStep stitches as [start, length, start, length, …]
 * @typedef {{label: string, before: string, after: string}} ReplaceStep
 * @typedef {FlipStep | ReplaceStep} Step
 */

/** Steps beyond this number are forgotten. */
const MAX_STEPS = 500;

/**
 * @param {Iterable<number>} indices
 * @returns {number[]}
 */
export function toRuns(indices) {
  const sorted = Uint32Array.from(indices).sort();
  /** @type {number[]} */
  const runs = [];
  for (const i of sorted) {
    const end = runs.length && runs[runs.length - 2] + runs[runs.length - 1];
    if (runs.length && i === end) runs[runs.length - 1]++;
    else runs.push(i, 1);
  }
  return runs;
}

/**
 * @param {number[]} runs
 * @returns {Generator<number>}
 */
export function* fromRuns(runs) {
  for (let k = 0; k < runs.length; k += 2) {
    for (let i = runs[k]; i < runs[k] + runs[k + 1]; i++) yield i;
  }
}

export class History {
  /**
   * @param {Step[]} [done]
   * @param {Step[]} [undone]
   */
  constructor(done = [], undone = []) {
    this.done = done;
    this.undone = undone;
  }

  /** @param {Step} step */
  push(step) {
    this.done.push(step);
    if (this.done.length > MAX_STEPS) this.done.shift();
    this.undone.length = 0;
  }

  undo() {
    const step = this.done.pop();
    if (step) this.undone.push(step);
    return step;
  }

  redo() {
    const step = this.undone.pop();
    if (step) this.done.push(step);
    return step;
  }

  /**
   * As JSON of at most `limit` characters: the oldest steps are left out.
   *
   * @param {number} limit
   */
  serialised(limit) {
    const done = [...this.done];
    const undone = [...this.undone];
    let json = JSON.stringify({ done, undone });
    while (json.length > limit && (done.length || undone.length)) {
      if (done.length) done.splice(0, Math.ceil(done.length / 2));
      else undone.splice(0, Math.ceil(undone.length / 2));
      json = JSON.stringify({ done, undone });
    }
    return json;
  }

  /** @param {string | null} json */
  static parse(json) {
    try {
      const { done, undone } = JSON.parse(json ?? "");
      return Array.isArray(done) && Array.isArray(undone) ? new History(done, undone) : new History();
    } catch {
      return new History(); // none kept, or spoilt: the chart itself is kept apart
    }
  }
}
