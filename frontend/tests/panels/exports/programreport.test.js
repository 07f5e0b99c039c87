import assert from "node:assert/strict";
import { test } from "node:test";
import { reportRows } from "../../../panels/exports/programreport.js";

const REPORT = {
  interval_source: "",
  machine: "Kniterate, 7 gauge",
  stitch_number: 6,
  passes: 27,
  knit_passes: 15,
  transfer_passes: 10,
  empty_passes: 2,
  transfers: 40,
  rackings: 0,
  minutes: 3.4,
  cost: null,
  yarns: [{ carrier: "1", loops: 90, length_m: 12.34, mass_g: 5.6 }],
  kinds_of_transfer: [
    {
      rack: 2,
      passes: 1,
      transfers: 4,
      line: 30,
      tightest: {
        needles: 3,
        across: true,
        tension_n: 0.42,
        tension_interval_n: /** @type {[number, number]} */ ([0.13, 3]),
        needed_mm: 14,
        own_mm: 11,
        break_chance: 0.03,
        verdict: /** @type {const} */ ("tight"),
      },
    },
    { rack: 0, passes: 9, transfers: 36, line: 20, tightest: null },
  ],
  notes: [],
};

test("a program's table gives time, yarn by carrier and the tightest loops", () => {
  const rows = Object.fromEntries(reportRows(REPORT));
  assert.match(rows.Time, /^3 min without stops$/);
  assert.match(rows.Passes, /^27: 15 knit, 10 transfer, 2 to bring/);
  assert.equal(rows["Carrier 1"], "12.3 m, about 5.6 g");
  assert.match(rows["Transfers racked by 2"], /^1 pass, tightest loop tight, 0\.42 N \(0\.13 to 3\.0\), breaks/);
  assert.match(rows["Transfers straight across"], /^9 passes, tightest loop at rest$/);
});

test("a home machine has work by hand in place of passes of transfers", () => {
  const yarns = [{ carrier: "A (main yarn)", loops: 90, length_m: 12.34, mass_g: 5.6 }];
  const home = { passes: 15, knit_passes: 15, transfer_passes: 0, empty_passes: 0, kinds_of_transfer: [], yarns };
  const rows = Object.fromEntries(reportRows({ ...REPORT, ...home }));
  assert.equal(rows.Passes, "15");
  assert.match(reportRows({ ...REPORT, minutes: 652 })[0][1], /^10 h 52 min without stops/);
  assert.equal(rows["By hand"], "40 stitches moved or latched up");
  assert.ok("Yarn A (main yarn)" in rows);
});

test("a price gives a cost", () => {
  assert.match(reportRows({ ...REPORT, cost: 4.5 })[0][1], /costs 4\.50$/);
});
