/**
 * What a tool is. A tool says which stitches a gesture covers; ink, symmetry, live drawing and undo
 * are the same for all and live in the painter.
 *
 * @import {Grid} from "../grid/grid.js"
 * @import {Cell, Span} from "../grid/raster.js"
 * @import {Others} from "../design/others.js"
 * @import {Ink} from "../design/ink.js"
 * @import {IconName} from "../elements/icons.js"
 *
 * @typedef {object} Gesture
 * @property {Cell} start stitch where the pointer went down
 * @property {Cell} previous stitch at the last event
 * @property {Cell} current stitch under the pointer; may lie outside the chart
 * @property {Cell[]} path all stitches since the start
 * @property {boolean} constrain Shift is held
 *
 * @typedef {object} ToolContext
 * @property {Grid} grid
 * @property {Uint8Array} codes
 * @property {Uint8Array} outline 1 where there is a stitch
 * @property {Others} [others] stitches that are neither knit nor purl
 * @property {number} size of the brush
 * @property {Ink} ink
 *
 * @typedef {object} Tool
 * @property {string} id
 * @property {string} label
 * @property {IconName} icon
 * @property {string} key such as "B" or "Shift+M"
 * @property {string} hint
 * @property {"stroke" | "shape" | "once" | "select" | "move" | "place" | "pan"} mode how a drag adds
 *   up: each move adds, the last position counts, only the press counts; or it selects, moves what
 *   is selected, places a linked repeat, or moves the view
 * @property {boolean} [sized] whether the brush size matters
 * @property {(gesture: Gesture, context: ToolContext) => Span[]} spans
 * @property {(gesture: Gesture) => Cell} [origin] where the ink's repeat begins; else the chart's corner
 */

export {};
