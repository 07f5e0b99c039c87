/**
 * What a program takes on its machine: time, yarn by carrier, and the tightest loops of its transfers.
 *
 * @import {ProgramReportResult} from "../../types.js"
 */

import { figure, percent } from "../../core/format.js";
import { h } from "../../elements/dom.js";
import { table, tableRow } from "../../widgets/table.js";

/** Kinds of transfer that are shown, the tightest first. */
const MOST_KINDS = 4;

/** Minutes, and hours of them from two on. @param {number} minutes */
function duration(minutes) {
  const count = Math.max(1, Math.round(minutes));
  return count < 120 ? `${count} min` : `${Math.floor(count / 60)} h ${count % 60} min`;
}

/** Rows of the table: a name and its figures. @param {ProgramReportResult} report @returns {[string, string][]} */
export function reportRows(report) {
  const cost = report.cost === null ? "" : `, costs ${figure(report.cost)}`;
  const kinds = [
    report.transfer_passes ? `${report.knit_passes} knit, ${report.transfer_passes} transfer` : "",
    report.empty_passes ? `${report.empty_passes} to bring the carriage back` : "",
  ].filter(Boolean);
  const passes = kinds.length ? `${report.passes}: ${kinds.join(", ")}` : String(report.passes);
  const byHand = report.transfers && !report.transfer_passes;
  return [
    ["Time", `${duration(report.minutes)} without stops${cost}`],
    ["Passes", passes],
    ...(byHand ? [pair("By hand", `${report.transfers} stitches moved or latched up`)] : []),
    ...report.yarns.map(({ carrier, length_m, mass_g }) =>
      pair(
        /^\d/.test(carrier) ? `Carrier ${carrier}` : `Yarn ${carrier}`,
        `${figure(length_m)} m, about ${figure(mass_g, 2)} g`,
      ),
    ),
    ...report.kinds_of_transfer
      .slice(0, MOST_KINDS)
      .map(({ rack, passes, tightest }) =>
        pair(
          rack ? `Transfers racked by ${rack}` : "Transfers straight across",
          `${passes} ${passes === 1 ? "pass" : "passes"}, tightest loop ${tightest ? pulled(tightest) : "at rest"}`,
        ),
      ),
  ];
}

/** @param {string} name @param {string} words @returns {[string, string]} */
const pair = (name, words) => [name, words];

/** @param {NonNullable<ProgramReportResult["kinds_of_transfer"][0]["tightest"]>} loop */
function pulled({ verdict, tension_n, tension_interval_n: [low, high], break_chance }) {
  const chance = break_chance >= 0.005 ? `, breaks with a chance of ${percent(break_chance)}` : "";
  return `${verdict}, ${figure(tension_n, 2)} N (${figure(low, 2)} to ${figure(high, 2)})${chance}`;
}

/** @param {ProgramReportResult} report */
export const reportTable = (report) =>
  table(
    { class: "figures full-width small", id: "program-report" },
    [`On ${report.machine}`, ""],
    h("tbody", {}, ...reportRows(report).map(([name, words]) => tableRow(name, words))),
  );
