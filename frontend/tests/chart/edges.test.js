import assert from "node:assert/strict";
import { test } from "node:test";
import { edgesOf } from "../../chart/edges.js";
import { random } from "../random.js";

/** @param {Int16Array} edges */
const pieces = (edges) => Array.from({ length: edges.length / 6 }, (_, k) => [...edges.subarray(6 * k, 6 * k + 6)]);

test("a box has four edges, all of its corners outer ones", () => {
  const cells = Uint8Array.of(0, 0, 0, 0, 1, 1, 0, 1, 1);
  assert.deepEqual(pieces(edgesOf(cells, 3, 3)), [
    [0, 1, 1, 3, 1, 0],
    [0, 3, 1, 3, -1, 0],
    [1, 1, 1, 3, 1, 0],
    [1, 3, 1, 3, -1, 0],
  ]);
});

test("an L has one inner corner, where lines are prolonged", () => {
  const cells = Uint8Array.of(1, 1, 1, 0);
  const inner = pieces(edgesOf(cells, 2, 2)).filter((piece) => piece[5]);
  assert.deepEqual(inner, [
    [0, 1, 1, 2, -1, 1],
    [1, 1, 1, 2, -1, 1],
  ]);
});

test("edges are as long as the borders between what is in and what is out", () => {
  for (let seed = 1; seed < 60; seed++) {
    const { rows, columns, purl } = random(seed);
    const at = (/** @type {number} */ row, /** @type {number} */ column) =>
      row >= 0 && column >= 0 && row < rows && column < columns ? purl[row * columns + column] : 0;
    let borders = 0;
    for (let row = -1; row < rows; row++) {
      for (let column = -1; column < columns; column++) {
        borders += (at(row, column) ^ at(row + 1, column)) + (at(row, column) ^ at(row, column + 1));
      }
    }
    const length = pieces(edgesOf(purl, rows, columns)).reduce((sum, [, , from, to]) => sum + to - from, 0);
    assert.equal(length, borders);
  }
});
