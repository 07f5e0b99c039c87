/**
 * What to paint with: flip, knit, purl, and whole patterns.
 *
 * @import {ActionContext} from "../actions/action.js"
 * @import {Palette} from "../chart/palette.js"
 * @import {Studio} from "../studio.js"
 */

import { action } from "../actions/registry.js";
import { readPalette } from "../chart/palette.js";
import { FLIP, Ink, KNIT, PURL } from "../core/ink.js";
import { QUARTERS, surroundings } from "../core/segments.js";
import { h } from "../dom.js";
import { icon } from "../icons.js";

const SIDE = 34;
/** A thumbnail shows at most this many stitches a side. */
const MOST = 9;

/**
 * @param {HTMLElement} host
 * @param {Studio} studio
 * @param {ActionContext} context
 * @returns {() => void} draws the thumbnails anew, for another theme
 */
export function shelf(host, studio, context) {
  const list = h("div", { class: "shelf-list" });
  const fill = action("fill-part");
  const fillButton = h(
    "button",
    {
      class: "button",
      type: "button",
      id: "fill-all",
      title: "Fill the selection, or the whole chart, with this pattern (F)",
      onclick: () => fill.perform(context),
    },
    icon("fill"),
    h("span", {}, "Fill chart"),
  );
  studio.selection.watch((box) => {
    const text = fillButton.querySelector("span");
    if (text) text.textContent = box ? "Fill selection" : "Fill chart";
  });

  const show = () => {
    const palette = readPalette();
    const inks = [FLIP, KNIT, PURL, ...studio.shelf.value];
    list.replaceChildren(
      ...inks.map((ink) =>
        h(
          "button",
          {
            class: "swatch",
            type: "button",
            role: "radio",
            id: `ink-${ink.id}`,
            title: ink.note || ink.name,
            "aria-checked": String(ink.id === studio.ink.value.id),
            onclick: () => (studio.ink.value = ink),
          },
          thumbnail(ink, palette),
          h("span", {}, ink.name),
        ),
      ),
    );
  };
  studio.shelf.watch(show);
  studio.ink.listen((chosen) => {
    for (const element of list.children) {
      element.setAttribute("aria-checked", String(element.id === `ink-${chosen.id}`));
    }
    fillButton.disabled = chosen.repeat === null;
  });
  fillButton.disabled = studio.ink.value.repeat === null;
  host.append(list, fillButton);
  return show;
}

/**
 * @param {Ink} ink
 * @param {Palette} palette
 */
function thumbnail(ink, palette) {
  const canvas = h("canvas", { width: 2 * SIDE, height: 2 * SIDE, class: "thumbnail" });
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext("2d"));
  const count = ink.repeat ? Math.min(MOST, Math.max(6, ink.repeat.rows, ink.repeat.columns)) : 1;
  const cell = (2 * SIDE) / count;
  if (!ink.repeat) {
    context.fillStyle = `rgb(${palette.knit.join(" ")})`;
    context.fillRect(0, 0, 2 * SIDE, 2 * SIDE);
    context.fillStyle = `rgb(${palette.purl.join(" ")})`;
    context.beginPath();
    context.moveTo(0, 2 * SIDE);
    context.lineTo(2 * SIDE, 2 * SIDE);
    context.lineTo(2 * SIDE, 0);
    context.fill();
    return canvas;
  }
  const single = ink === KNIT || ink === PURL;
  const tiles = ink.repeat.tiled(2 * count, 2 * count);
  const codes = surroundings(tiles);
  for (let row = 0; row < count; row++) {
    for (let column = 0; column < count; column++) {
      const i = tiles.index(row, column);
      const purl = tiles.purl[i];
      QUARTERS[codes[i]].forEach((phase, quarter) => {
        const colour = single ? (purl ? palette.purl : palette.knit) : palette.fabrics[phase];
        const shade = purl && !single ? 0.72 : 1;
        context.fillStyle = `rgb(${colour.map((c) => Math.round(c * shade)).join(" ")})`;
        context.fillRect(
          (column + (quarter & 1) / 2) * cell,
          (count - 1 - row + (quarter < 2 ? 0.5 : 0)) * cell,
          cell / 2 + 0.5,
          cell / 2 + 0.5,
        );
      });
    }
  }
  return canvas;
}
