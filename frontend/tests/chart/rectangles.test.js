import assert from "node:assert/strict";
import { test } from "node:test";
import { groupAt, roomInStitches, sideOfBlocks } from "../../chart/rectangles.js";
import { Viewport } from "../../chart/viewport.js";
import { ChartDocument } from "../../design/document.js";
import { Grid } from "../../grid/grid.js";

/** @typedef {import("../../state/studio.js").Studio} Studio */

/** @param {ChartDocument} document @param {string} groups */
const studioOf = (document, groups, block = 4) =>
  /** @type {Studio} */ (
    /** @type {unknown} */ ({ document, seeing: { groups: { value: groups }, block: { value: block } } })
  );

/** @param {number} cellWidth */
const zoomed = (cellWidth) => Object.assign(new Viewport(), { cellWidth, cellHeight: cellWidth });

test("the legend names the blocks that are drawn, not those that would be too small to see", () => {
  const chart = new ChartDocument(new Grid(20, 20));
  assert.equal(sideOfBlocks(studioOf(chart, "stitch"), zoomed(20)), 1);
  assert.equal(sideOfBlocks(studioOf(chart, "stitch"), zoomed(5)), 3);
  assert.equal(sideOfBlocks(studioOf(chart, "block", 8), zoomed(5)), 8);
  assert.equal(roomInStitches(studioOf(chart, "block", 8), zoomed(5)), 8);
});

test("all regions have the room of the largest", () => {
  const chart = new ChartDocument(new Grid(20, 20));
  chart.addRegion({ name: "small", colour: "#ff0000" }, Array(4).keys());
  chart.addRegion({ name: "large", colour: "#00ff00" }, Array(36).keys());
  assert.equal(roomInStitches(studioOf(chart, "region"), zoomed(20)), 6);
});

test("what lies outside the outline has no rectangle", () => {
  const chart = new ChartDocument(new Grid(4, 4));
  chart.outline.fill(0);
  chart.outline[0] = 1;
  Object.defineProperty(chart, "shaped", { value: true });
  const studio = studioOf(chart, "block");
  assert.deepEqual(groupAt(studio, 0, 0, 4)?.cells, [0]);
  assert.equal(groupAt(studio, 3, 3, 2), null);
});
