/** The chart: knits and purls seen from the face side. Row 0 is the bottom row, column 0 at the left. */

/** Charts on the page have at most this many rows and columns. */
export const MAX_SIDE = 400;

/** Half-open rectangle of stitches. @typedef {{row0: number, column0: number, row1: number, column1: number}} Box */

export class Grid {
  /**
   * @param {number} rows
   * @param {number} columns
   * @param {Uint8Array} [purl] 1 where the stitch is a purl, row by row from the bottom
   */
  constructor(rows, columns, purl = new Uint8Array(rows * columns)) {
    this.rows = rows;
    this.columns = columns;
    this.purl = purl;
  }

  /** From K/P lines, top row first. @param {string} text well-formed: {@link isChartText} holds */
  static fromText(text) {
    const lines = text.trim().split("\n").reverse();
    const grid = new Grid(lines.length, lines[0].length);
    lines.forEach((line, row) => {
      for (let column = 0; column < grid.columns; column++) {
        grid.purl[row * grid.columns + column] = line[column] === "P" ? 1 : 0;
      }
    });
    return grid;
  }

  /** The chart as K/P lines, top row first. */
  get text() {
    const { rows, columns, purl } = this;
    const bytes = new Uint8Array(rows * (columns + 1) - 1);
    for (let row = rows - 1, k = 0; row >= 0; row--, k++) {
      const end = (row + 1) * columns;
      for (let i = end - columns; i < end; i++) bytes[k++] = purl[i] ? 80 : 75; // P, K
      if (row) bytes[k] = 10;
    }
    return new TextDecoder().decode(bytes);
  }

  /** @returns {Box} */
  get box() {
    return { row0: 0, column0: 0, row1: this.rows, column1: this.columns };
  }

  /** @param {number} row @param {number} column */
  index(row, column) {
    return row * this.columns + column;
  }

  /** @param {number} row @param {number} column */
  has(row, column) {
    return row >= 0 && column >= 0 && row < this.rows && column < this.columns;
  }

  /**
   * A grid of the given size whose stitches come from a rule.
   *
   * @param {number} rows
   * @param {number} columns
   * @param {(row: number, column: number) => number | boolean} rule
   */
  static build(rows, columns, rule) {
    const grid = new Grid(rows, columns);
    for (let row = 0, i = 0; row < rows; row++) {
      for (let column = 0; column < columns; column++, i++) grid.purl[i] = rule(row, column) ? 1 : 0;
    }
    return grid;
  }

  /** @param {Box} box */
  region({ row0, column0, row1, column1 }) {
    return Grid.build(
      row1 - row0,
      column1 - column0,
      (row, column) => this.purl[this.index(row0 + row, column0 + column)],
    );
  }

  /**
   * Overwrite a part, which must fit.
   *
   * @param {Grid} part
   * @param {number} row of its lower left corner
   * @param {number} column
   */
  put(part, row, column) {
    for (let r = 0; r < part.rows; r++) {
      const line = part.purl.subarray(r * part.columns, (r + 1) * part.columns);
      this.purl.set(line, this.index(row + r, column));
    }
  }

  /** Cut or filled up with knits, kept at the bottom left. @param {number} rows @param {number} columns */
  resized(rows, columns) {
    return Grid.build(rows, columns, (row, column) => (this.has(row, column) ? this.purl[this.index(row, column)] : 0));
  }

  /** Repeated from the bottom left up to the given size. @param {number} rows @param {number} columns */
  tiled(rows, columns) {
    return Grid.build(rows, columns, (row, column) => this.purl[this.index(row % this.rows, column % this.columns)]);
  }

  /** Left and right exchanged; knits stay knits. */
  mirrored() {
    return Grid.build(this.rows, this.columns, (row, column) => this.purl[this.index(row, this.columns - 1 - column)]);
  }

  /** Top and bottom exchanged. */
  flipped() {
    return Grid.build(this.rows, this.columns, (row, column) => this.purl[this.index(this.rows - 1 - row, column)]);
  }

  /** Turned by half a turn in its plane. */
  rotated() {
    return this.mirrored().flipped();
  }

  /** Every knit a purl and every purl a knit. */
  swapped() {
    return new Grid(
      this.rows,
      this.columns,
      this.purl.map((p) => 1 - p),
    );
  }

  /** The back of the same cloth. */
  turnedOver() {
    return this.mirrored().swapped();
  }

  /** @param {Grid} other */
  equals(other) {
    return this.rows === other.rows && this.columns === other.columns && this.purl.every((p, i) => p === other.purl[i]);
  }
}

/** Whether a text is K/P lines of one length within the page's limits. @param {string} text */
export function isChartText(text) {
  const lines = text.trim().split("\n");
  const columns = lines[0].length;
  return (
    columns > 0 &&
    columns <= MAX_SIDE &&
    lines.length <= MAX_SIDE &&
    lines.every((line) => line.length === columns && /^[KP]+$/.test(line))
  );
}

/** A repeat from one line of text, as a design document has it: "KP/PK", the top row first. @param {string} motif */
export function motifGrid(motif) {
  return Grid.fromText(motif.replaceAll("/", "\n"));
}

/** A repeat as one line of text. @param {Grid} grid */
export function motifText(grid) {
  return grid.text.replaceAll("\n", "/");
}
