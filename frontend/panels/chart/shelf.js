/**
 * What to paint with: knit, purl, their opposite, no stitch, a region, whole patterns, and patterns of one's own.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {Symbols} from "../../state/editing.js"
 * @import {Palette} from "../../state/palette.js"
 * @import {Ink} from "../../design/ink.js"
 * @import {Studio} from "../../state/studio.js"
 */

import { withKey } from "../../core/pointing.js";
import { action } from "../../actions/registry.js";
import { loadSigns } from "../../chart/symbols.js";
import { readPalette } from "../../state/palette.js";
import { FLIP, KNIT, NO_STITCH, PURL } from "../../design/ink.js";
import { motifText } from "../../grid/grid.js";
import { QUARTERS, surroundings } from "../../grid/segments.js";
import { ownInk, ownPatterns } from "../../design/shelf.js";
import { loadShelf, saveShelf } from "../../design/store.js";
import { h, inTurn } from "../../elements/dom.js";
import { iconButton, textButton } from "../../widgets/buttons.js";

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
  const { document: chart } = studio;
  const list = h("div", { class: "shelf-list flex shrinks-x grows gap-2" });
  const fill = action("fill-part");
  const fillButton = textButton("fill", h("span", {}, "Fill chart"), () => fill.perform(context), {
    id: "fill-all",
    title: withKey("Fill the selection, or the whole chart, with this pattern", "F"),
  });
  const removeLabel = "Take this pattern off the shelf";
  const removeButton = iconButton(
    "trash",
    removeLabel,
    () => {
      const motif = studio.ink.value.repeat ? motifText(studio.ink.value.repeat) : "";
      saveShelf(loadShelf().filter((item) => item.motif !== motif));
      chart.changeShelf(
        chart.shelf.filter((item) => item.motif !== motif),
        "Remove a pattern",
      );
      studio.ink.value = PURL;
      show();
    },
    { id: "shelf-remove", title: removeLabel },
  );
  studio.selection.watch((box) => {
    const text = fillButton.querySelector("span");
    if (text) text.textContent = box ? "Fill selection" : "Fill chart";
  });

  /** What the list shows, as text: made anew only if that changes. */
  let shown = "";
  const show = () => {
    const palette = readPalette();
    const chosen = studio.ink.value;
    const own = ownPatterns(chart.shelf, loadShelf()).map(ownInk);
    const region = chosen.target.startsWith("region:") ? [chosen] : [];
    const other = chosen.others.length ? [chosen] : [];
    const inks = [KNIT, PURL, FLIP, NO_STITCH, ...other, ...region, ...studio.shelf.value, ...own];
    const symbols = studio.editing.symbols.value;
    const what = JSON.stringify([inks.map(({ id, name }) => [id, name]), palette, symbols]);
    if (what !== shown) {
      shown = what;
      const swatches = inks.map((ink) => ({ ink, picture: h("img", { class: "thumbnail", alt: "" }) }));
      list.replaceChildren(
        ...swatches.map(({ ink, picture }) =>
          h(
            "button",
            {
              class: "swatch bare stack small nowrap rounded",
              role: "radio",
              id: `ink-${ink.id}`,
              title: ink.note || ink.name,
              onclick: () => (studio.ink.value = ink),
            },
            picture,
            h("span", { class: "ellipsis" }, ink.name),
          ),
        ),
      );
      void inTurn(swatches, ({ ink, picture }) => {
        if (ink.others.length) return void drawMotif(picture, ink, symbols);
        picture.src = thumbnail(ink, palette, symbols, chart.region(ink.target.slice(7))?.colour ?? "");
      });
    }
    for (const element of list.children) {
      const checked = String(element.id === `ink-${chosen.id}`);
      if (element.ariaChecked !== checked) element.ariaChecked = checked;
    }
    fillButton.disabled = chosen.repeat === null;
    removeButton.hidden = !chosen.id.startsWith("own-");
  };
  const remember = () => {
    const kept = loadShelf();
    const all = ownPatterns(chart.shelf, kept);
    if (all.length > kept.length) saveShelf(all.slice(0, 200));
    const { target } = studio.ink.value;
    // A region that is gone can no longer be painted.
    if (target.startsWith("region:") && !chart.region(target.slice(7))) studio.ink.value = PURL;
    show();
  };
  studio.shelf.watch(show);
  studio.editing.symbols.listen(show);
  studio.ink.listen((ink) => {
    show();
    document.getElementById(`ink-${ink.id}`)?.scrollIntoView({ block: "nearest", inline: "nearest" });
  });
  chart.onSettle(remember);
  remember();
  host.append(list, removeButton, fillButton);
  return show;
}

/** The picture of an ink of lace or cables, once what draws it is there. @param {HTMLImageElement} picture @param {Ink} ink @param {Symbols} symbols */
async function drawMotif(picture, ink, symbols) {
  const [{ motifPicture }] = await Promise.all([import("../stitches/picture.js"), loadSigns()]);
  picture.src = motifPicture(ink, symbols);
}

/**
 * Address of an image, not a canvas: each canvas on the page is a layer that every frame has to blend.
 *
 * @param {Ink} ink
 * @param {Palette} palette
 * @param {Symbols} symbols
 * @param {string} colour of a region
 */
function thumbnail(ink, palette, symbols, colour) {
  const side = 2 * SIDE;
  const canvas = h("canvas", { width: side, height: side });
  const context = canvas.getContext("2d", { willReadFrequently: true }); // reading from a GPU would stop it
  drawThumbnail(/** @type {CanvasRenderingContext2D} */ (context), side, ink, palette, symbols, colour);
  return canvas.toDataURL();
}

/**
 * @param {CanvasRenderingContext2D} context
 * @param {number} side in pixels
 * @param {Ink} ink
 * @param {Palette} palette
 * @param {Symbols} symbols
 * @param {string} colour of a region
 */
function drawThumbnail(context, side, ink, palette, symbols, colour) {
  /** @param {number[]} rgb */
  const css = (rgb) => `rgb(${rgb.map(Math.round).join(" ")})`;
  if (ink.target === "outline") {
    context.strokeStyle = palette.muted;
    context.lineWidth = 3;
    context.setLineDash([7, 6]);
    context.strokeRect(8, 8, side - 16, side - 16);
    return;
  }
  if (ink.target !== "stitches") {
    context.fillStyle = colour;
    context.fillRect(0, 0, side, side);
    return;
  }
  if (!ink.repeat || ink === KNIT || ink === PURL) {
    context.fillStyle = css(ink === PURL ? palette.purl : palette.knit);
    context.fillRect(0, 0, side, side);
    if (!ink.repeat) {
      context.fillStyle = css(palette.purl);
      context.beginPath();
      context.moveTo(0, side);
      context.lineTo(side, side);
      context.lineTo(side, 0);
      context.fill();
    }
    context.fillStyle = palette.text;
    if (ink === PURL && symbols === "dots") {
      context.beginPath();
      context.arc(side / 2, side / 2, side * 0.13, 0, 2 * Math.PI);
      context.fill();
    } else if (ink === PURL) context.fillRect(side * 0.28, side * 0.46, side * 0.44, side * 0.08);
    else if (ink === KNIT && symbols === "japanese")
      context.fillRect(side * 0.46, side * 0.28, side * 0.08, side * 0.44);
    return;
  }
  const count = Math.min(MOST, Math.max(6, ink.repeat.rows, ink.repeat.columns));
  const cell = side / count;
  const tiles = ink.repeat.tiled(2 * count, 2 * count);
  const codes = surroundings(tiles);
  for (let row = 0; row < count; row++) {
    for (let column = 0; column < count; column++) {
      const i = tiles.index(row, column);
      QUARTERS[codes[i]].forEach((phase, quarter) => {
        const shade = tiles.purl[i] ? 0.72 : 1;
        context.fillStyle = css(palette.fabrics[phase].map((c) => c * shade));
        context.fillRect(
          (column + (quarter & 1) / 2) * cell,
          (count - 1 - row + (quarter < 2 ? 0.5 : 0)) * cell,
          cell / 2 + 0.5,
          cell / 2 + 0.5,
        );
      });
    }
  }
}
