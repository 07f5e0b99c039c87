/**
 * A yarn without a tester: what is asked of the service about a swatch, and its answers in words.
 *
 * @import {Fabric, FabricDocument, MaterialDocument, PhotosRequest, StepResult, SwatchRequest, SwatchResult, UseResult} from "../types.js"
 *
 * @typedef {{direction: "course" | "wale", clampedMm: number, coinMm: number, hung: {photo: File, grams: number}[]}} Pull
 */

import { api, call } from "../api.js";
import { shrunk, uploaded } from "./yarns.js";

/** The sheet of marks, as a file. */
export async function marksSheet() {
  /** @type {{name: string, media_type: string, content: string}} */
  const sheet = await call("/measure/marks");
  const bytes = Uint8Array.from(atob(sheet.content), (letter) => letter.charCodeAt(0));
  return { name: sheet.name, blob: new Blob([bytes], { type: sheet.media_type }) };
}

/**
 * What the service asks for of photos of a swatch that hangs.
 *
 * @param {Pull} pull
 * @param {{fabric: Fabric, stitches_per_10_cm: number, rows_per_10_cm: number, weight_g?: number | null}} swatch
 * @returns {Promise<PhotosRequest>}
 */
export async function photosRequest({ direction, clampedMm, coinMm, hung }, swatch) {
  return {
    images: await Promise.all(hung.map(async ({ photo }) => uploaded(await shrunk(photo)))),
    loads_g: hung.map(({ grams }) => grams),
    fabric: swatch.fabric,
    direction,
    stitches_per_10_cm: swatch.stitches_per_10_cm,
    rows_per_10_cm: swatch.rows_per_10_cm,
    clamped_width_mm: clampedMm,
    swatch_weight_g: swatch.weight_g ?? 0,
    coin_mm: coinMm > 0 ? coinMm : null,
  };
}

/** @param {SwatchRequest} request @returns {Promise<SwatchResult>} */
export const swatchYarn = (request) => api.run("measure/swatch", request);

/**
 * Fabrics of a yarn that nobody has tested, from the law of one that was, without its bending modulus.
 *
 * @param {MaterialDocument} yarn of at least one fabric
 * @param {number} loopMm yarn in a stitch; NaN if unknown
 */
export async function untestedFabrics(yarn, loopMm) {
  const [[fabric, { law, stitch_course_mm, stitch_wale_mm, loop_length_mm }]] =
    /** @type {[Fabric, FabricDocument][]} */ (Object.entries(yarn.fabrics));
  const loop = loop_length_mm ?? loopMm;
  const { material, notes } = await swatchYarn({
    fabric,
    stitches_per_10_cm: 100 / stitch_course_mm,
    rows_per_10_cm: 100 / stitch_wale_mm,
    ten_stitches_mm: loop > 0 ? 10 * loop : null,
    law: Object.fromEntries(Object.entries(law).flatMap(([name, value]) => (value === null ? [] : [[name, value]]))),
  });
  return { material, warnings: notes };
}

/** @param {MaterialDocument} material @returns {Promise<UseResult[]>} */
export const usesOf = async (material) => (await api.run("measure/uses", { material })).uses;

/** Tex of a ball. @param {number} grams @param {number} metres @returns {number | null} */
export const texOf = (grams, metres) => (grams > 0 && metres > 0 ? (1000 * grams) / metres : null);

/** A value with its interval, in words. @param {{value: number, value_interval: [number, number]}} known @param {number} factor @param {number} digits @param {string} unit */
export function inWords({ value, value_interval: ends }, factor, digits, unit) {
  const [middle, low, high] = [value, ...ends].map((number) => (factor * number).toFixed(digits));
  return `${middle}${unit} (${low} to ${high})`;
}

/**
 * The cells of a step: what is known after it, with a mark where it brought something.
 *
 * @param {StepResult} step
 * @param {StepResult | null} before
 */
export function stepCells(step, before) {
  /** @type {((of: StepResult) => [{value: number, value_interval: [number, number]}, number, number, string])[]} */
  const columns = [
    (of) => [of.loop_length_mm, 1, 1, " mm"],
    (of) => [of.bending_modulus_n_mm2, 1000, 0, " mN·mm²"],
    (of) => [of.strain_at_0_1_n_per_mm.course, 100, 0, " %"],
    (of) => [of.strain_at_0_1_n_per_mm.wale, 100, 0, " %"],
  ];
  return columns.map((column) => {
    const words = inWords(...column(step));
    return { words, brought: before !== null && words !== inWords(...column(before)) };
  });
}

/** The service's words in those of knitters. @param {string} text */
export const inKnittersWords = (text) =>
  text.replace(/course-wise/g, "along the rows").replace(/wale-wise/g, "along the columns");
