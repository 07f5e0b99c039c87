/**
 * Tables of stretch tests: what the service reads in them, and how a user says that they are to be read.
 *
 * @import {AnswerResult, DoubtResult, TableResult, TableTemplate} from "../types.js"
 *
 * @typedef {Required<TableTemplate>} Template
 */

const KEY = "knitcore.tables";
/** Kinds of tables that a browser remembers. */
const MOST = 40;

/** What columns may hold, by our names. @type {Record<string, string>} */
export const QUANTITIES = {
  "": "not used",
  strain_along: "strain along the pull",
  extension_mm: "extension",
  strain_across: "strain across",
  force_n: "force",
  width_mm: "width",
  length_mm: "distance of the clamps",
  across_mm: "points tracked across",
  run: "specimen or run",
  time: "time",
};

const LENGTHS = ["mm", "cm", "m", "in"];

/** Units of each, the one first that is taken where a table says none. @param {string} quantity */
export const unitsOf = (quantity) =>
  quantity === "force_n"
    ? ["N", "cN", "mN", "kN", "g", "kg", "lbf"]
    : quantity.startsWith("strain")
      ? ["-", "%", "ratio"]
      : quantity.endsWith("_mm")
        ? LENGTHS
        : [];

/** @type {() => Template} */
export const asItStands = () => ({
  columns: {},
  units: {},
  width_mm: null,
  length_mm: null,
  narrowing_is_positive: false,
  keeps_slack: false,
});

/** @param {Template} template @param {TableTemplate} changes @returns {Template} */
export const changed = (template, changes) => ({
  ...template,
  ...changes,
  columns: { ...template.columns, ...changes.columns },
  units: { ...template.units, ...changes.units },
});

/**
 * A column that holds something else than was read.
 *
 * @param {Template} template
 * @param {TableResult} test
 * @param {string} title of the column
 * @param {string} quantity
 */
export function withColumn(template, test, title, quantity) {
  const before = test.columns.find((column) => column.title === title)?.quantity ?? "";
  /** @type {Record<string, string>} */
  const columns = {};
  if (before) columns[before] = "";
  if (quantity) columns[quantity] = title;
  return changed(template, { columns });
}

/** Whether a template says what an answer says. @param {Template} template @param {AnswerResult} answer */
export const isSaid = (template, { changes }) =>
  JSON.stringify(changed(template, changes)) === JSON.stringify(template) && Object.keys(changes).length > 0;

/** What a template says, in words; empty if a table is read as it stands. @param {Template} template */
export function inWords({ columns, units, width_mm, length_mm, narrowing_is_positive, keeps_slack }) {
  const name = (/** @type {string} */ quantity) => QUANTITIES[quantity] ?? quantity;
  return [
    ...Object.entries(columns).map(([quantity, title]) =>
      title ? `${name(quantity)} is “${title}”` : `no ${name(quantity)}`,
    ),
    ...Object.entries(units).map(([quantity, unit]) => `${name(quantity)} in ${unit === "-" ? "fractions" : unit}`),
    width_mm !== null && `${width_mm} mm wide`,
    length_mm !== null && `clamps ${length_mm} mm apart`,
    narrowing_is_positive && "narrowing is positive",
    keeps_slack && "counted from the first reading",
  ]
    .filter(Boolean)
    .join(", ");
}

/** What hinders a law, as sentences: what is missing, or else what is wrong; and what has to be answered. @param {TableResult} test */
export const hindrances = ({ missing, problem, doubts }) => [
  ...(missing.length ? [`Still needed: ${missing.map(needed).join(", ")}.`] : (problem ?? [])),
  ...doubts.filter(({ is_open }) => is_open).map((doubt) => doubt.problem),
];

/** @param {string} quantity that a table lacks */
const needed = (quantity) =>
  ["width_mm", "length_mm"].includes(quantity)
    ? `the ${QUANTITIES[quantity]}`
    : `a column of ${quantity === "strain_along" ? "strain or extension" : (QUANTITIES[quantity] ?? quantity)}`;

/** Doubts that may be answered, of a test or of both. @param {DoubtResult[]} doubts */
export const answerable = (doubts) => doubts.filter(({ readings }) => readings.length);

/**
 * Heads of a table, by which its kind is known again; empty for our own tables, and where no line names the columns.
 *
 * @param {TableResult} test
 */
const headsOf = ({ columns }) =>
  columns.every(({ title }) => /^column \d+$/.test(title)) ? "" : columns.map(({ title }) => title).join("\n");

/** @returns {[heads: string, template: Template][]} the last one first */
function kept() {
  try {
    const list = JSON.parse(localStorage.getItem(KEY) ?? "[]");
    return Array.isArray(list) ? list : [];
  } catch {
    return []; // closed storage, or something else of that name
  }
}

/** How a table with the same heads was read before. @param {TableResult} test @returns {Template | null} */
export function remembered(test) {
  const heads = headsOf(test);
  const template = heads && kept().find(([known]) => known === heads)?.[1];
  return template ? changed(asItStands(), template) : null;
}

/** @param {TableResult} test @param {Template} template */
export function remember(test, template) {
  const heads = headsOf(test);
  if (!heads) return;
  const others = kept().filter(([known]) => known !== heads);
  const mine = /** @type {[string, Template][]} */ (inWords(template) ? [[heads, template]] : []);
  try {
    localStorage.setItem(KEY, JSON.stringify([...mine, ...others].slice(0, MOST)));
  } catch {
    // Storage is closed to us: the file that can be saved holds the same.
  }
}
