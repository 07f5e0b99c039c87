/** Smaller copies of pictures, beside WebGL and a canvas that are made up. */

import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import vm from "node:vm";

/**
 * The smaller copies that a texture gets of a picture.
 *
 * @param {number} width
 * @param {number} height
 * @param {(x: number, y: number) => number[]} pixel of the picture at half its size
 */
async function copiesOf(width, height, pixel) {
  class HTMLImageElement {}
  /** @type {{level: number, width: number, height: number, data: Uint8Array}[]} */
  const copies = [];
  const page = vm.createContext({
    HTMLImageElement,
    WebGL2RenderingContext: class {
      texImage2D() {}
      texSubImage2D(/** @type {any[]} */ ...[, level, , , wide, high, , , data]) {
        if (data) copies.push({ level, width: wide, height: high, data });
      }
      generateMipmap() {}
    },
    OffscreenCanvas: class {
      getContext() {
        return {
          drawImage() {},
          getImageData: (/** @type {any[]} */ ...[, , wide, high]) => ({
            width: wide,
            height: high,
            data: Uint8ClampedArray.from({ length: 4 * wide * high }, (_, at) => {
              const place = at >> 2;
              return pixel(place % wide, Math.floor(place / wide))[at % 4];
            }),
          }),
        };
      }
    },
  });
  vm.runInContext(await readFile(new URL("../../viser/smaller.js", import.meta.url), "utf8"), page);
  const gl = vm.runInContext("new WebGL2RenderingContext()", page);
  gl.texSubImage2D(0, 0, 0, 0, 0, 0, Object.assign(new HTMLImageElement(), { width, height }));
  gl.generateMipmap(0);
  return copies;
}

test("columns that are hardly wider than pixels do not beat in smaller pictures", async () => {
  const PERIOD = 2.25;
  const copies = await copiesOf(720, 64, (x) => {
    const light = 0.5 + 0.4 * Math.cos((2 * Math.PI * x) / PERIOD);
    const value = 255 * light ** (1 / 2.2);
    return [value, value, value, 255];
  });
  assert.deepEqual(
    copies.map(({ level, width, height }) => [level, width, height]),
    [
      [2, 180, 16],
      [3, 90, 8],
      [4, 45, 4],
      [5, 22, 2],
      [6, 11, 1],
      [7, 5, 1],
      [8, 2, 1],
      [9, 1, 1],
    ],
  );
  const { width, data } = copies[0];
  const middle = Array.from({ length: width - 8 }, (_, x) => data[4 * (8 * width + x + 4)]);
  const differ = Math.max(...middle) - Math.min(...middle);
  assert.ok(differ <= 4, `${differ} of 150`);
});

test("the edge of a cloth has the cloth's colour", async () => {
  const [{ width, data }] = await copiesOf(64, 64, (x) => (x < 17 ? [200, 190, 180, 255] : [0, 0, 0, 0]));
  const covers = Array.from({ length: width }, (_, x) => [...data.slice(4 * x, 4 * x + 4)]);
  const edge = covers.filter(([, , , cover]) => cover > 20 && cover < 235);
  assert.ok(edge.length > 0);
  for (const [red, green, blue] of edge) {
    assert.ok(
      Math.abs(red - 200) < 3 && Math.abs(green - 190) < 3 && Math.abs(blue - 180) < 3,
      `${red} ${green} ${blue}`,
    );
  }
  assert.equal(covers[width - 1][3], 0);
});
