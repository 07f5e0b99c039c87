/**
 * The garments that can be planned, and what is measured for each. Lengths are in mm.
 *
 * @typedef {[least: number, most: number]} Bounds of a body
 * @typedef {{key: string, label: string, value: number, of: Bounds, hint?: string, body?: string}} Measure `body`:
 *   the part of the body, where several garments need it
 * @typedef {{key: string, label: string, fabric: Fabric}} FabricOfPart
 * @typedef {{id: string, name: string, note: string, material: string, ease: number, measures: Measure[],
 *   fabrics: FabricOfPart[], profile?: [number, number][], graded?: boolean, fingers?: boolean}} Template
 *
 * @import {Fabric} from "../../types.js"
 */

/** @type {Bounds} */
const WRIST = [80, 350];
/** @type {Bounds} */
const AROUND = [60, 1500];
/** @type {Bounds} */
const LONG = [10, 1200];
/** @type {Bounds} */
const OF_HAND = [5, 250];
/** @type {Bounds} */
const BAND = [0, 300];
/** Of any limb. */
export const LIMB = { around: AROUND, at: /** @type {Bounds} */ ([0, 1500]) };
/** Of fingers. */
export const FINGER = { around: /** @type {Bounds} */ ([25, 130]), long: /** @type {Bounds} */ ([10, 150]) };

/** @type {Template[]} */
export const TEMPLATES = [
  {
    id: "glove",
    name: "Therapeutic glove",
    note: "One flat piece, knitted sideways from the thumb around the hand and grafted. In the study stockinette holds the wrist along its stiff direction; seed lies at the thumb, rib along the fingers, garter over the hand.",
    material: "glove-wool:glove",
    ease: 0.05,
    fingers: true,
    fabrics: [
      { key: "support_fabric", label: "Wrist support", fabric: "stockinette" },
      { key: "hand_fabric", label: "Hand and cuff", fabric: "garter" },
      { key: "thumb_fabric", label: "Thumb", fabric: "seed" },
      { key: "finger_fabric", label: "Fingers", fabric: "rib" },
    ],
    measures: [
      { key: "wrist_circumference_mm", label: "Around the wrist", value: 165, of: WRIST, body: "wrist" },
      {
        key: "palm_circumference_mm",
        label: "Around the knuckles",
        value: 205,
        of: [100, 400],
        hint: "without the thumb",
      },
      { key: "cuff_mm", label: "Cuff", value: 12, of: OF_HAND },
      { key: "wrist_mm", label: "Wrist support", value: 55, of: OF_HAND },
      { key: "thumb_crotch_mm", label: "Wrist to the base of the thumb", value: 45, of: OF_HAND },
      { key: "palm_mm", label: "Wrist to the base of the fingers", value: 80, of: OF_HAND },
      { key: "gusset_mm", label: "Thumb gusset, height", value: 22, of: [0, 100], hint: "0 for none" },
      { key: "gusset_girth_mm", label: "Thumb gusset, girth", value: 22, of: [0, 100] },
    ],
  },
  {
    id: "wrist-brace",
    name: "Wrist brace",
    note: "Knitted sideways and grafted, so that stockinette's stiff direction goes around the wrist; garter edges.",
    material: "acrylic",
    ease: -0.15,
    fabrics: [
      { key: "support", label: "Support", fabric: "stockinette" },
      { key: "edge", label: "Edges", fabric: "garter" },
    ],
    measures: [
      { key: "wrist_mm", label: "Around the wrist", value: 170, of: WRIST, body: "wrist" },
      { key: "length_mm", label: "Along the arm", value: 90, of: LONG },
      { key: "edge_mm", label: "Edges", value: 15, of: BAND },
    ],
  },
  {
    id: "limb",
    name: "Sleeve (arm or leg)",
    note: "A tube that follows the limb's circumference, with rib at both ends.",
    material: "acrylic",
    ease: -0.15,
    graded: true,
    fabrics: [
      { key: "body", label: "Body", fabric: "stockinette" },
      { key: "hem", label: "Ribbing at the ends", fabric: "rib" },
    ],
    profile: [
      [0, 180],
      [120, 240],
      [220, 265],
    ],
    measures: [{ key: "hem_mm", label: "Ribbing at each end", value: 40, of: BAND }],
  },
  {
    id: "sock-leg",
    name: "Sock leg",
    note: "From the ankle up to the calf, with rib at both ends; heel and foot are knitted on by hand.",
    material: "acrylic",
    ease: -0.15,
    graded: true,
    fabrics: [
      { key: "body", label: "Body", fabric: "stockinette" },
      { key: "hem", label: "Ribbing at the ends", fabric: "rib" },
    ],
    measures: [
      { key: "ankle_mm", label: "Around the ankle", value: 220, of: [120, 500], body: "ankle" },
      { key: "calf_mm", label: "Around the calf", value: 340, of: [180, 800], body: "calf" },
      { key: "length_mm", label: "Length", value: 200, of: LONG },
    ],
  },
];

/** Length and circumference, mm. @type {[string, number, number][]} */
export const DIGITS = [
  ["Thumb", 55, 65],
  ["Index", 70, 64],
  ["Middle", 78, 64],
  ["Ring", 72, 60],
  ["Little", 57, 53],
];
