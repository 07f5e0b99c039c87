/**
 * Yarns of one's own: kept at the service from a file, or made of stretch tests of the four fabrics.
 *
 * @import {Studio} from "../studio.js"
 * @import {Fabric, FitResult, MaterialDocument, MaterialSummary} from "../types.js"
 *
 * @typedef {{course: File, wale: File, stitches: number, rows: number}} Tests of a fabric: pulled along
 *   rows and columns, and the gauge per 10 cm
 */

import { api, call } from "../api.js";

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
  const added = await yarns.add(document);
  await refresh(studio);
  const complete = Object.keys(added.fabrics).length === 4;
  if (complete) studio.materialId.value = added.id;
  studio.tell(
    complete ? `${added.name} is added, and chosen.` : `${added.name} is added. It lacks some of the four fabrics.`,
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

/**
 * What a service asks for of two tests of a fabric.
 *
 * @param {Tests} tests
 */
export async function fitRequest({ course, wale }) {
  return { test_course: await uploaded(course), test_wale: await uploaded(wale) };
}

/** @param {File} file */
async function uploaded(file) {
  const bytes = new Uint8Array(await file.arrayBuffer());
  let text = "";
  for (let i = 0; i < bytes.length; i += 0x8000) text += String.fromCharCode(...bytes.subarray(i, i + 0x8000));
  return { name: file.name, content: btoa(text) };
}

/**
 * A yarn of fitted laws.
 *
 * @param {string} name
 * @param {Map<Fabric, {tests: Tests, fit: FitResult}>} fabrics
 * @returns {MaterialDocument}
 */
export function yarnOf(name, fabrics) {
  const identifier = name
    .normalize("NFKD")
    .replace(/\p{M}/gu, "")
    .toLowerCase()
    .replace(/[^a-z0-9]+/g, "-")
    .replace(/^-+|-+$/g, "")
    .slice(0, 60);
  const document = {
    format: "knitcore-material",
    version: 1,
    identifier: identifier || "yarn",
    name,
    fabrics: Object.fromEntries(
      [...fabrics].map(([fabric, { tests, fit }]) => [
        fabric,
        {
          law: lawOf(fit),
          stitch_course_mm: 100 / tests.stitches,
          stitch_wale_mm: 100 / tests.rows,
          stitch_size_source: "gauge given on the page",
          standard_deviation: {
            modulus_course: fit.standard_errors.modulus_course_n_per_mm,
            modulus_wale: fit.standard_errors.modulus_wale_n_per_mm,
            poisson_yx: fit.standard_errors.poisson_yx,
            poisson_xy: fit.standard_errors.poisson_xy,
          },
          measured: fit.curves,
        },
      ]),
    ),
    note: [...fabrics]
      .map(
        ([fabric, { tests, fit }]) =>
          `${fabric}: ${tests.course.name}, ${tests.wale.name}; rms ${fit.rms_n_per_mm.toFixed(4)} N/mm`,
      )
      .join("\n"),
  };
  // What is left out is filled in by the service.
  return /** @type {MaterialDocument} */ (/** @type {unknown} */ (document));
}

/** Constants of a law, without the units in their names. @param {FitResult} fit */
function lawOf(fit) {
  const names = /** @type {const} */ ([
    "stiffness_xxxx_n_per_mm",
    "stiffness_yyyy_n_per_mm",
    "stiffness_xxyy_n_per_mm",
    "stiffness_yyxx_n_per_mm",
    "alpha_xx",
    "alpha_yy",
    "beta_xx_n_per_mm",
    "beta_yy_n_per_mm",
    "shear_modulus_n_per_mm",
    "kappa_xx",
    "kappa_yy",
  ]);
  return Object.fromEntries(names.map((name) => [name.replace("_n_per_mm", ""), fit[name]]));
}
