/**
 * The design document, version 2: the project file, what the service keeps, and what this page
 * holds. The same fields as in the Python library, checked here too, so that a broken file is reported
 * in words and changes nothing.
 *
 * @import {DesignDocument, DesignLayout, DesignRegion, DesignRepeat} from "../types.js"
 *
 * @typedef {DesignRegion} RegionItem
 * @typedef {DesignRepeat} RepeatItem
 * @typedef {DesignLayout["shelf"][number]} ShelfItem
 * @typedef {DesignRepeat["placements"][number]} PlacementItem
 * @typedef {{chart: string} & Omit<DesignLayout, "machine">} Content what of a document the chart shows
 */

import { MAX_SIDE, isChartText } from "../grid/grid.js";
import { readCodes } from "../grid/kinds.js";
import { faultOf } from "./others.js";

export const FORMAT = "knitcore-design";
export const MAX_ITEMS = 200;
const MAX_MACHINE = 100_000;
export const MAX_MOTIF = 20_000;

/** A design that cannot be read: what is wrong, and what to do. */
export class DesignError extends Error {
  /** @param {string} detail @param {string} [remedy] */
  constructor(detail, remedy = "Export the design again, or use the file that it was made from.") {
    super(detail);
    this.name = "DesignError";
    this.remedy = remedy;
  }
}

/** @param {string} chart @param {Partial<Content>} [more] @returns {Content} */
export function contentOf(chart, more = {}) {
  return { chart, other_stitches: [], outline: null, regions: [], repeats: [], shelf: [], ...more };
}

/** A document from the content of a file. @param {unknown} value @returns {DesignDocument} @throws {DesignError} */
export function readDesign(value) {
  if (!isObject(value) || value.format !== FORMAT) {
    throw new DesignError("It is not a design.", `A design says "format": "${FORMAT}".`);
  }
  const { version } = value;
  if (version !== 2) {
    throw new DesignError(
      `It is of version ${JSON.stringify(version)}.`,
      "This page reads version 2: export it with a program of the same age.",
    );
  }
  return {
    format: FORMAT,
    version: 2,
    name: text(value.name ?? "Untitled", "name", 200),
    material: text(value.material ?? "acrylic", "material", 80),
    note: typeof value.note === "string" ? value.note.slice(0, 20_000) : "",
    machine: typeof value.machine === "string" ? value.machine.slice(0, MAX_MACHINE) : null,
    ...readContent(value),
  };
}

/** @param {Record<string, unknown>} value @returns {Content} @throws {DesignError} */
export function readContent(value) {
  if (typeof value.chart !== "string") throw new DesignError("It holds no chart.");
  let chart = value.chart.trim();
  let runs = value.other_stitches;
  const read = isChartText(chart) ? null : readCodes(chart); // as the library may write it
  if (read?.others.length && !items(runs, "other stitches").length) {
    ({ chart } = read);
    runs = read.others.map(([row, column, codes]) => ({ row, column, codes }));
  }
  const {
    length: rows,
    0: { length: columns },
  } = chart.split("\n");
  if (Math.max(rows, columns) > MAX_SIDE) {
    throw new DesignError(
      `Its chart has ${columns} stitches × ${rows} rows.`,
      `This page paints at most ${MAX_SIDE} × ${MAX_SIDE}; the command line takes more.`,
    );
  }
  if (!isChartText(chart)) throw new DesignError("Its chart is not rows of K and P of one length.");
  return {
    chart,
    other_stitches: readOthers(runs, rows, columns),
    outline: readOutline(value.outline ?? null, rows, columns),
    regions: items(value.regions, "regions").map((item) => readRegion(item, rows, columns)),
    repeats: items(value.repeats, "repeats").map((item) => readRepeat(item, rows, columns)),
    shelf: items(value.shelf, "shelf").map((item) => ({
      name: text(item.name, "name of a pattern", 80),
      motif: motif(item.motif, `pattern ${item.name}`),
    })),
  };
}

/**
 * What of a damaged content can be used: the chart above all.
 *
 * @param {Record<string, unknown>} value
 * @returns {Content | null} null without a readable chart
 */
export function salvageContent(value) {
  /** @param {Record<string, unknown>} part */
  const read = (part) => {
    try {
      return readContent(part);
    } catch (error) {
      if (error instanceof DesignError) return null;
      throw error;
    }
  };
  const bare = read({ chart: value.chart });
  if (!bare) return null;
  for (const field of /** @type {const} */ (["other_stitches", "outline", "regions", "repeats", "shelf"])) {
    const readable = read({ chart: value.chart, [field]: value[field] });
    if (readable) Object.assign(bare, { [field]: readable[field] });
  }
  return bare;
}

/** @param {unknown} value @param {number} rows @param {number} columns @returns {Content["other_stitches"]} */
function readOthers(value, rows, columns) {
  const runs = value ?? [];
  if (!Array.isArray(runs) || !runs.every(isObject)) throw new DesignError("Its other stitches are not a list.");
  const fault = faultOf(runs, rows, columns);
  if (fault) throw new DesignError(fault, "Use stitches of the list, each inside the chart and in a place of its own.");
  return runs.map(({ row, column, codes }) => ({ row: Number(row), column: Number(column), codes: String(codes) }));
}

/** @param {unknown} value @param {number} rows @param {number} columns */
function readOutline(value, rows, columns) {
  if (value === null) return null;
  const lines = typeof value === "string" ? value.trim().split("\n") : [];
  if (lines.length !== rows || !lines.every((line) => line.length === columns && /^[x.]+$/.test(line))) {
    throw new DesignError(`Its outline is not ${rows} lines of ${columns} x or dots, as its chart has.`);
  }
  return lines.join("\n");
}

/** @param {Record<string, unknown>} item @param {number} rows @param {number} columns @returns {RegionItem} */
function readRegion(item, rows, columns) {
  const name = text(item.name, "name of a region", 80);
  if (typeof item.colour !== "string" || !/^#[0-9a-f]{6}$/i.test(item.colour)) {
    throw new DesignError(`The colour of region ${name} is not like #3b6fb6.`);
  }
  const runs = Array.isArray(item.runs) ? item.runs : [];
  for (const run of runs) {
    const whole = Array.isArray(run) && run.length === 3 && run.every(Number.isInteger);
    const [row, column, length] = whole ? run : [-1, 0, 0];
    if (row < 0 || row >= rows || column < 0 || length < 1 || column + length > columns) {
      throw new DesignError(`Region ${name} reaches beyond the chart of ${columns} × ${rows} stitches.`);
    }
  }
  return {
    id: identifier(item.id),
    name,
    colour: item.colour.toLowerCase(),
    yarn: (item.yarn ?? null) === null ? null : text(item.yarn, "yarn", 80),
    fill: (item.fill ?? null) === null ? null : motif(item.fill, `region ${name}`),
    runs,
    locked: item.locked === true,
    hidden: item.hidden === true,
  };
}

/** @param {Record<string, unknown>} item @param {number} rows @param {number} columns @returns {RepeatItem} */
function readRepeat(item, rows, columns) {
  const name = text(item.name, "name of a repeat", 80);
  const placements = items(item.placements, `placements of ${name}`).map((place) => {
    const { row, column, rows: high, columns: wide } = place;
    const whole = isCount(row, 0) && isCount(column, 0) && isCount(high, 1) && isCount(wide, 1);
    if (!whole || row + high > rows || column + wide > columns) {
      throw new DesignError(`A placement of repeat ${name} reaches beyond the chart of ${columns} × ${rows}.`);
    }
    return { row, column, rows: high, columns: wide };
  });
  const edge = (/** @type {unknown} */ value) => (isCount(value, 0) ? Math.min(value, MAX_SIDE) : 0);
  return {
    id: identifier(item.id),
    name,
    motif: motif(item.motif, `repeat ${name}`),
    edge_columns: edge(item.edge_columns),
    edge_rows: edge(item.edge_rows),
    placements,
  };
}

/** @param {unknown} value @param {string} what @returns {Record<string, unknown>[]} */
function items(value, what) {
  const list = value ?? [];
  if (!Array.isArray(list) || !list.every(isObject)) throw new DesignError(`Its ${what} are not a list.`);
  if (list.length > MAX_ITEMS) throw new DesignError(`It has more than ${MAX_ITEMS} ${what}.`);
  const ids = list.map(({ id }) => id).filter((id) => id !== undefined);
  if (new Set(ids).size < ids.length) throw new DesignError(`Two of its ${what} have one id.`);
  return list;
}

/** @param {unknown} value @param {string} what @param {number} most */
function text(value, what, most) {
  if (typeof value !== "string" || !value || /\p{Cc}/u.test(value)) {
    throw new DesignError(`The ${what} must be one line of text.`);
  }
  return value.slice(0, most);
}

/** @param {unknown} value @param {string} what */
function motif(value, what) {
  const well = typeof value === "string" && value.length <= MAX_MOTIF;
  if (!well || !isChartText(value.replaceAll("/", "\n"))) {
    throw new DesignError(`The motif of ${what} is not rows of K and P of one length, such as KP/PK.`);
  }
  return value;
}

/** @param {unknown} value */
function identifier(value) {
  if (typeof value !== "string" || !/^[\w.:-]{1,64}$/.test(value)) {
    throw new DesignError("A region or repeat has no id.");
  }
  return value;
}

/** @param {unknown} value @param {number} least @returns {value is number} */
const isCount = (value, least) => Number.isInteger(value) && Number(value) >= least;

/** @param {unknown} value @returns {value is Record<string, unknown>} */
const isObject = (value) => typeof value === "object" && value !== null && !Array.isArray(value);

/** @param {string} name @param {string} chart @param {string} material @returns {DesignDocument} */
export const plainDesign = (name, chart, material) => ({
  format: "knitcore-design",
  version: 2,
  name,
  material,
  note: "",
  machine: null,
  ...contentOf(chart),
});
