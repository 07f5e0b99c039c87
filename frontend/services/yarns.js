/**
 * Yarns of one's own: kept at the service from a file, or made of what was measured.
 *
 * @import {Studio} from "../state/studio.js"
 * @import {Direction, EstimateRequest, EstimateResult, Fabric, FabricDocument, FitResult, MaterialDocument, MaterialSummary, TableTemplate, YarnDocument} from "../types.js"
 *
 * @typedef {{stitches: number, rows: number}} Gauge per 10 cm
 * @typedef {Gauge & {course: File, wale: File, templates?: Record<Direction, TableTemplate>}} Tests of a fabric:
 *   pulled along rows and columns, and how their tables are read
 */

import { api, call } from "../api.js";
import { base64 } from "../grid/bits.js";
import { isComplete } from "../state/studio.js";

/** Longest side of a photo of yarn as it is sent; a hand's length of yarn is still some pixels wide. */
const PHOTO_SIDE_PX = 2400;

/** Names of the standard errors of a fit that a yarn keeps. */
const DEVIATION = /^(modulus|poisson)_/;

/** Names of the constants of a law in a fit. */
const CONSTANT = /^(stiffness|alpha|beta|shear_modulus|kappa)_/;

export const OWN = "own:";

/** @param {string} id */
const at = (id) => `/materials/${encodeURIComponent(id)}`;

export const yarns = {
  /** @type {(document: MaterialDocument) => Promise<MaterialSummary>} */
  add: (document) => call("/materials", { method: "POST", body: document }),

  /** @type {(id: string) => Promise<MaterialDocument>} */
  file: (id) => call(`${at(id)}/document`),

  /** @type {(id: string) => Promise<void>} */
  remove: (id) => call(at(id), { method: "DELETE" }),
};

/**
 * Keep a yarn, offer it, and knit the design with it if it has all four fabrics.
 *
 * @param {Studio} studio
 * @param {MaterialDocument} document
 */
export async function adopt(studio, document) {
  const { designId } = studio;
  const added = await yarns.add(document);
  await refresh(studio);
  const complete = isComplete(added);
  const same = designId === studio.designId;
  if (complete && same) studio.materialId.value = added.id;
  studio.tell(
    complete
      ? `${added.name} is added${same ? ", and chosen" : ""}.`
      : `${added.name} is added, but not chosen: it lacks some of the four fabrics. Change it under Own yarns, and keep it: they are estimated.`,
  );
  return added;
}

/** @param {Studio} studio */
export async function refresh(studio) {
  studio.materials.value = (await api.materials()).materials;
}

/** @param {unknown} value @returns {value is MaterialDocument} */
export const isYarnFile = (value) =>
  typeof value === "object" && value !== null && "format" in value && value.format === "knitcore-material";

/** What a service asks for of two tests of a fabric. @param {Tests} tests */
export async function fitRequest({ course, wale, templates }) {
  return {
    test_course: await uploaded(course),
    test_wale: await uploaded(wale),
    template_course: templates?.course,
    template_wale: templates?.wale,
  };
}

/** A file as requests hold it. @param {File} file */
export async function uploaded(file) {
  return { name: file.name, content: base64(new Uint8Array(await file.arrayBuffer())) };
}

/**
 * What photos of hanging yarn say of its bending modulus.
 *
 * @param {readonly File[]} photos
 * @param {{gramsPerMetre: number, lengthMm: number}} given weight per length, and the length that hangs
 */
export const bendingRequest = async (photos, { gramsPerMetre, lengthMm }) => ({
  images: await Promise.all(photos.map(async (photo) => uploaded(await shrunk(photo)))),
  linear_density_g_per_m: gramsPerMetre,
  length_mm: lengthMm,
});

/**
 * A photo no larger than tracing needs: those of a telephone are ten times as heavy.
 *
 * @param {File} photo as it is if the browser cannot read it: the service says what is wrong with it
 */
export async function shrunk(photo) {
  const bitmap = await createImageBitmap(photo).catch(() => null);
  const scale = PHOTO_SIDE_PX / Math.max(bitmap?.width ?? 0, bitmap?.height ?? 0);
  if (!bitmap || scale >= 1) return photo;
  const canvas = new OffscreenCanvas(Math.round(bitmap.width * scale), Math.round(bitmap.height * scale));
  canvas.getContext("2d")?.drawImage(bitmap, 0, 0, canvas.width, canvas.height);
  bitmap.close();
  return new File([await canvas.convertToBlob({ type: photo.type, quality: 0.92 })], photo.name);
}

/** @param {File} file @param {number} diameterMm NaN if the file says it */
export const compressionRequest = async (file, diameterMm) => ({
  file: await uploaded(file),
  diameter_mm: diameterMm > 0 ? diameterMm : null,
});

/**
 * Fabrics of the yarn that nobody has tested, from its bending modulus, the yarn in a stitch and the
 * fabrics that were tested.
 *
 * @param {MaterialDocument} yarn with its bending modulus
 * @param {number} loopMm
 * @returns {Promise<EstimateResult>}
 */
export function estimated(yarn, loopMm) {
  const swatches = entries(yarn).map(([fabric, { law, loop_length_mm }]) => ({
    fabric,
    law: Object.fromEntries(Object.entries(law).filter(([, value]) => value !== null)),
    loop_length_mm: loop_length_mm ?? loopMm,
  }));
  const body = { bending_modulus_n_mm2: yarn.yarn?.bending_modulus_n_mm2, loop_length_mm: loopMm, swatches };
  return api.run("estimate", /** @type {EstimateRequest} */ (body));
}

/**
 * A yarn of what is known of it: a former state, and what was measured since. Fabrics that were only
 * estimated are left out, to be estimated anew.
 *
 * @param {MaterialDocument | null} base
 * @param {string} name
 * @param {Partial<YarnDocument>} yarn
 * @param {Map<Fabric, {tests: Tests, fit: FitResult}>} fitted
 * @param {readonly string[]} evidence in sentences
 * @returns {MaterialDocument}
 */
export function yarnOf(base, name, yarn, fitted, evidence = []) {
  const tested = base ? entries(base).filter(([, { origin }]) => origin !== "estimated") : [];
  const document = {
    format: "knitcore-material",
    version: 1,
    identifier: base?.identifier ?? identifierOf(name),
    name,
    yarn: { ...base?.yarn, ...yarn },
    fabrics: {
      ...Object.fromEntries(tested),
      ...Object.fromEntries([...fitted].map(([fabric, known]) => [fabric, fabricOf(known)])),
    },
    note: distinctLines(base?.note ?? "", ...evidence),
  };
  // What is left out is filled in by the service.
  return /** @type {MaterialDocument} */ (/** @type {unknown} */ (document));
}

/** What a yarn's figures rest on, in lines. @param {MaterialDocument} yarn */
export const evidenceOf = (yarn) => [
  ...distinctLines(yarn.note ?? "")
    .split("\n")
    .filter(Boolean),
  ...entries(yarn).map(
    ([fabric, known]) =>
      `${fabric}: ${[known.law_source, known.stitch_size_source && `size: ${known.stitch_size_source}`].filter(Boolean).join("; ")}`,
  ),
];

/** Lines of a note, each once. @param {...string} texts */
export const distinctLines = (...texts) => [...new Set(texts.join("\n").split("\n"))].filter(Boolean).join("\n");

/**
 * The yarn with the size of its stitches as measured; what agrees already keeps its source.
 *
 * @param {MaterialDocument} yarn
 * @param {ReadonlyMap<Fabric, Gauge>} gauges
 */
export function withGauges(yarn, gauges) {
  const fabrics = entries(yarn).map(([fabric, known]) => {
    const gauge = gauges.get(fabric);
    return [fabric, gauge && differs(known, gauge) ? { ...known, ...sizes(gauge) } : known];
  });
  return { ...yarn, fabrics: Object.fromEntries(fabrics) };
}

/** @param {MaterialDocument} yarn */
const entries = ({ fabrics }) => /** @type {[Fabric, FabricDocument][]} */ (Object.entries(fabrics));

/** Whether a gauge says more than what was rounded of the size. @param {FabricDocument} known @param {Gauge} gauge */
const differs = ({ stitch_course_mm, stitch_wale_mm }, { stitches, rows }) =>
  Math.abs((stitches * stitch_course_mm) / 100 - 1) > 1e-3 || Math.abs((rows * stitch_wale_mm) / 100 - 1) > 1e-3;

/** @param {Gauge} gauge */
const sizes = ({ stitches, rows }) => ({
  stitch_course_mm: 100 / stitches,
  stitch_wale_mm: 100 / rows,
  stitch_size_source: "gauge given on the page",
});

/** @param {{tests: Tests, fit: FitResult}} known */
const fabricOf = ({ tests, fit }) => ({
  law: lawOf(fit),
  ...sizes(tests),
  law_source: `fitted to ${tests.course.name} and ${tests.wale.name}, ${fit.rms_n_per_mm.toFixed(4)} N/mm rms`,
  standard_deviation: withoutUnits(Object.entries(fit.standard_errors).filter(([name]) => DEVIATION.test(name))),
  measured: fit.curves,
});

/** The name by which files refer to a yarn. @param {string} name */
export function identifierOf(name) {
  const plain = name
    .normalize("NFKD")
    .replace(/\p{M}/gu, "")
    .toLowerCase()
    .replace(/[^a-z0-9]+/g, "-")
    .replace(/^-+|-+$/g, "")
    .slice(0, 60);
  return plain || "yarn";
}

/** A fit's constants, without the units in their names. @param {FitResult} fit */
const lawOf = (fit) => withoutUnits(Object.entries(fit).filter(([name]) => CONSTANT.test(name)));

/** @param {[string, unknown][]} numbers by their names in answers of the service */
const withoutUnits = (numbers) =>
  Object.fromEntries(numbers.map(([name, value]) => [name.replace("_n_per_mm", ""), value]));
