import assert from "node:assert/strict";
import { test } from "node:test";

import { largestRectangle } from "../../grid/inscribed.js";

/** @param {string} text lines of x and dots, the lowest row first */
function marks(text) {
  return Uint8Array.from(text.replaceAll(/\s/g, ""), (mark) => Number(mark === "x"));
}

test("the largest rectangle inside an outline is found", () => {
  assert.deepEqual(largestRectangle(marks("xxxxx .xxx. .xxx. ..x.."), 5), { row0: 0, column0: 1, row1: 3, column1: 4 });
  assert.deepEqual(largestRectangle(marks("xxxx xxxx"), 4), { row0: 0, column0: 0, row1: 2, column1: 4 });
  assert.equal(largestRectangle(marks("... ..."), 3), null);
});

test("it is inside, and no rectangle inside is larger", () => {
  const [rows, columns] = [6, 7];
  let state = 1;
  for (let round = 0; round < 200; round++) {
    const inside = Uint8Array.from({ length: rows * columns }, () => {
      state = (state * 48271) % 2147483647;
      return Number(state % 4 !== 0);
    });
    /** @param {{row0: number, column0: number, row1: number, column1: number}} box */
    const full = ({ row0, column0, row1, column1 }) => {
      for (let row = row0; row < row1; row++) {
        for (let column = column0; column < column1; column++) if (!inside[row * columns + column]) return false;
      }
      return true;
    };
    let most = 0;
    for (let row0 = 0; row0 < rows; row0++) {
      for (let row1 = row0 + 1; row1 <= rows; row1++) {
        for (let column0 = 0; column0 < columns; column0++) {
          for (let column1 = column0 + 1; column1 <= columns; column1++) {
            if (full({ row0, column0, row1, column1 })) most = Math.max(most, (row1 - row0) * (column1 - column0));
          }
        }
      }
    }
    const largest = largestRectangle(inside, columns);
    assert.ok(largest && full(largest));
    assert.equal((largest.row1 - largest.row0) * (largest.column1 - largest.column0), most);
  }
});
