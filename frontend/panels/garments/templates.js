/**
 * The garments that can be planned, and what is measured for each. Lengths are in mm.
 *
 * @typedef {{key: string, label: string, value: number, hint?: string}} Measure
 * @typedef {{id: string, name: string, note: string, material: string, ease: number,
 *   measures: Measure[], profile?: [number, number][], fingers?: boolean}} Template
 */

/** @type {Template[]} */
export const TEMPLATES = [
  {
    id: "glove",
    name: "Therapeutic glove",
    note: "One flat piece, knitted sideways from the thumb around the hand and grafted. Stockinette holds the wrist along its stiff direction; seed lies at the thumb, rib along the fingers, garter over the hand.",
    material: "glove-wool:glove",
    ease: -0.1,
    fingers: true,
    measures: [
      { key: "wrist_circumference_mm", label: "Around the wrist", value: 165 },
      { key: "palm_circumference_mm", label: "Around the knuckles", value: 205, hint: "without the thumb" },
      { key: "cuff_mm", label: "Cuff", value: 12 },
      { key: "wrist_mm", label: "Wrist support", value: 55 },
      { key: "thumb_crotch_mm", label: "Wrist to the base of the thumb", value: 45 },
      { key: "palm_mm", label: "Wrist to the base of the fingers", value: 80 },
      { key: "gusset_mm", label: "Thumb gusset, height", value: 22, hint: "0 for none" },
      { key: "gusset_girth_mm", label: "Thumb gusset, girth", value: 22 },
    ],
  },
  {
    id: "wrist-brace",
    name: "Wrist brace",
    note: "Knitted sideways and grafted, so that stockinette's stiff direction goes around the wrist; garter edges.",
    material: "acrylic",
    ease: -0.15,
    measures: [
      { key: "wrist_mm", label: "Around the wrist", value: 170 },
      { key: "length_mm", label: "Along the arm", value: 90 },
      { key: "edge_mm", label: "Garter edges", value: 15 },
    ],
  },
  {
    id: "limb",
    name: "Sleeve (arm or leg)",
    note: "A tube that follows the limb's circumference, with rib at both ends.",
    material: "acrylic",
    ease: -0.15,
    profile: [
      [0, 180],
      [120, 240],
      [220, 265],
    ],
    measures: [{ key: "hem_mm", label: "Rib at each end", value: 40 }],
  },
  {
    id: "sock-leg",
    name: "Sock leg",
    note: "From the ankle up to the calf, with rib at both ends; heel and foot are knitted on by hand.",
    material: "acrylic",
    ease: -0.15,
    measures: [
      { key: "ankle_mm", label: "Around the ankle", value: 220 },
      { key: "calf_mm", label: "Around the calf", value: 340 },
      { key: "length_mm", label: "Length", value: 200 },
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
