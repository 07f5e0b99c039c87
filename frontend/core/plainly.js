/**
 * What the service says and refuses, in words for somebody who knits: it names fields as programs do and
 * directions as engineers do.
 *
 * @import {Problem} from "../types.js"
 */

/** Fields by their last name, where its words would not say it. @type {Record<string, string>} */
const LABELS = {
  strain: "Stretch",
  force_n: "Force",
  chart: "Chart",
  target_mmhg: "Pressure",
  girth_mm: "Girth",
  worn_mm: "Girth",
  rest_mm: "Tube at rest",
  at_mm: "Place along the limb",
  profile: "Measurements along the limb",
  linear_density_g_per_m: "Weight of the yarn",
  linear_density_tex: "Yarn in tex",
};
/** The service's title of every refusal of an input. */
const UNUSABLE = "This input cannot be used";
const UNITS = /_(mm|n|g_per_m|n_per_mm|mn_mm2|tex|mmhg|s|n_mm2|deg)$/;

/** Names of files and places in them, which are no fields. */
const IN_A_FILE = /\.(csv|txt|tsv|xlsx?|h5|hdf5|json|ks?|knitout|png|jpe?g|gif|bmp|tiff?|webp)\b|\s/i;

/** @param {string} field such as request.garment.wrist_mm */
export function labelOf(field) {
  if (IN_A_FILE.test(field)) return field;
  const parts = field.split(".").filter((part) => !/^\d+$/.test(part));
  const last = parts.at(-1) ?? field;
  const words = last.replace(UNITS, "").replaceAll("_", " ");
  return LABELS[last] ?? words.charAt(0).toUpperCase() + words.slice(1);
}

/** Numbers as people write them: 10000.0 is 10,000. @param {string} text */
const numbers = (text) =>
  text
    .replace(/(\d)\.0(?!\d)/g, "$1")
    .replace(/(?<![\d.,])\d{5,}(?!\d)/g, (digits) => Number(digits).toLocaleString("en"));

/** @param {string} text */
const directions = (text) =>
  text
    .replaceAll("course-wise", "along the rows")
    .replaceAll("wale-wise", "along the columns")
    .replaceAll("alpha times strain", "the share of its stretch");

/** A field within a sentence: no file, no function of the library, nothing in quotes. */
const FIELD = /(?<![\w.'"])[a-z]+(?:_[a-z0-9]+)+(?![\w('"]|\.\w)/g;

/** @param {string} text */
const sentence = (text) => directions(numbers(text.replace(FIELD, (field) => labelOf(field).toLowerCase())));

/** What pydantic says of a value. @type {[RegExp, string][]} */
const SAID = [
  [/^Input should be less than.*/, "is too large."],
  [/^Input should be greater than.*/, "is too small."],
  [/^Input should be a valid (number|integer).*/, "is not a number."],
  [/^Input should be a finite number.*/, "is not a number."],
  [/^Field required.*/, "is missing."],
];

/**
 * The same problem in plain words.
 *
 * @template {Pick<Problem, "title" | "detail" | "remedy" | "field">} P
 * @param {P} problem
 * @returns {P}
 */
export function plainly(problem) {
  const { title, field, detail, remedy } = problem;
  if (!field || field === "body") return title === UNUSABLE ? { ...problem, title: "This cannot be used" } : problem;
  const label = labelOf(field);
  const says = detail?.startsWith(`${field}: `) ? detail.slice(field.length + 2) : null;
  const [, instead] = SAID.find(([said]) => says !== null && said.test(says)) ?? [null, says];
  const joined =
    instead === null ? detail : `${label}${/^(is|has|needs|does|lies|are)\b/.test(instead) ? " " : ": "}${instead}`;
  return {
    ...problem,
    title: title === UNUSABLE ? `${label} cannot be used` : title,
    detail: joined && sentence(joined),
    remedy: remedy && sentence(remedy.replaceAll(field, label === field ? field : label.toLowerCase())),
  };
}

/** Where numbers come from. @param {string} source */
export function sourceInWords(source) {
  /** @type {Record<string, string>} */
  const words = {
    measured: "Measured on swatches",
    estimated: "Estimated from the yarn",
    swept: "Simulated stitch by stitch",
    learned: "Estimated from simulations",
    "learned with known size": "Estimated from simulations and a known size",
  };
  return words[source] ?? source;
}
