import assert from "node:assert/strict";
import { test } from "node:test";
import { ApiError } from "../../api.js";
import { deliver } from "../../sync/delivery.js";
import { merge, same, strokesBetween } from "../../sync/merge.js";
import { random } from "../random.js";

/** @typedef {import("../../types.js").DesignDocument} DesignDocument */

/** @param {string} chart @param {Partial<DesignDocument>} [more] @returns {DesignDocument} */
const design = (chart, more = {}) => ({
  format: "knitcore-design",
  version: 2,
  name: "Cuff",
  material: "acrylic",
  note: "",
  machine: null,
  other_stitches: [],
  outline: null,
  regions: [],
  repeats: [],
  shelf: [],
  chart,
  ...more,
});

/** @param {number} status @param {string} [field] */
const refusal = (status, field) => new ApiError({ type: "test", title: "Refused", status, detail: "", field });

/** A service that keeps one design as the real one does. */
class OneDesign {
  /** @type {{document: DesignDocument, revision: number} | null} */ kept = null;
  /** @type {Map<string, string>} */ keys = new Map();
  deleted = false;
  created = 0;

  /** @param {DesignDocument} document @param {string} key */
  async create(document, key) {
    const body = JSON.stringify(document);
    if (this.keys.has(key)) {
      if (this.keys.get(key) !== body) throw refusal(422, "Idempotency-Key");
    } else {
      this.keys.set(key, body);
      this.created++;
      this.kept = { document, revision: 1 };
    }
    return this.#full();
  }

  async read() {
    if (this.deleted || !this.kept) throw refusal(404);
    return this.#full();
  }

  /** @param {string} _id @param {DesignDocument} document @param {number} revision */
  async replace(_id, document, revision) {
    const kept = await this.read();
    if (kept.revision !== revision) throw refusal(412);
    this.kept = { document, revision: revision + 1 };
    return this.#full();
  }

  /** @param {string} _id @param {any} strokes */
  async paint(_id, { rows, columns, runs }) {
    const { document, revision } = await this.read();
    const lines = document.chart.split("\n");
    if (lines.length !== rows || lines[0].length !== columns) throw refusal(409);
    for (const { row, column, stitches } of runs) {
      const line = lines[rows - 1 - row];
      lines[rows - 1 - row] = line.slice(0, column) + stitches + line.slice(column + stitches.length);
    }
    this.kept = { document: { ...document, chart: lines.join("\n") }, revision: revision + 1 };
    return { revision: revision + 1 };
  }

  async recover() {
    if (!this.kept) throw refusal(404);
    this.deleted = false;
    this.kept.revision++;
    return this.#full();
  }

  #full() {
    if (!this.kept) throw refusal(404);
    return { id: "remote-1", ...this.kept };
  }
}

/** @param {DesignDocument} document @returns {import("../../sync/delivery.js").Parcel} */
const parcelOf = (document) => ({ id: "local-1", remote: null, base: null, document });

/** @param {import("../../sync/delivery.js").Parcel} parcel @param {OneDesign} service */
async function kept(parcel, service) {
  const outcome = await deliver(parcel, service);
  assert.notEqual(outcome.kind, "conflict");
  return /** @type {{parcel: import("../../sync/delivery.js").Parcel}} */ (outcome).parcel;
}

test("strokes between two charts make one of the other", async () => {
  for (let seed = 0; seed < 50; seed++) {
    const grid = random(seed);
    const [before, after] = [grid.text, random(seed + 100).tiled(grid.rows, grid.columns).text];
    const service = new OneDesign();
    service.kept = { document: design(before), revision: 1 };
    await service.paint("", strokesBetween(before, after));
    assert.equal(service.kept.document.chart, after);
  }
  assert.equal(strokesBetween("KK\nKK", "KKKK"), null);
  assert.equal(strokesBetween("KKKKK", "KK\nKK"), null);
});

test("what only one side changed is taken from it", () => {
  const base = design("KKK\nKKK");
  const { document, conflicts } = merge(
    base,
    { ...base, chart: "PKK\nKKK", note: "soft" },
    { ...base, chart: "KKK\nKKP", name: "Rim" },
  );
  assert.deepEqual(conflicts, []);
  assert.equal(document.chart, "PKK\nKKP");
  assert.equal(document.name, "Rim");
  assert.equal(document.note, "soft");
});

test("what both changed differently is a conflict and keeps ours", () => {
  const base = design("KK\nKK");
  const merged = merge(base, { ...base, name: "A", chart: "KKK" }, { ...base, name: "B", chart: "P" });
  assert.deepEqual(merged.conflicts, ["name", "chart"]);
  assert.equal(merged.document.name, "A");
});

test("lists merge item by item", () => {
  /** @param {string} id @param {string} colour */
  const region = (id, colour) => ({
    id,
    name: id,
    colour,
    yarn: null,
    fill: null,
    runs: [],
    locked: false,
    hidden: false,
  });
  const [a, b, c] = [region("a", "#111111"), region("b", "#222222"), region("c", "#333333")];
  const base = design("K", { regions: /** @type {any} */ ([a, b]) });
  const mine = { ...base, regions: /** @type {any} */ ([{ ...a, colour: "#999999" }, b]) };
  const theirs = { ...base, regions: /** @type {any} */ ([a, c]) };
  const { document, conflicts } = merge(base, mine, theirs);
  assert.deepEqual(conflicts, []);
  assert.deepEqual(
    document.regions.map(({ id, colour }) => [id, colour]),
    [
      ["a", "#999999"],
      ["c", "#333333"],
    ],
  );
});

test("the order of fields makes no difference", () => {
  const [first, second] = [
    { name: "Mine", motif: "KP" },
    { motif: "KP", name: "Mine" },
  ];
  assert.ok(same(design("K", { shelf: [first] }), design("K", { shelf: [second] })));
});

test("a first delivery whose answer is lost happens once", async () => {
  const service = new OneDesign();
  const first = parcelOf(design("KK"));
  first.posted = first.document;
  await deliver(first, service); // its answer never comes
  first.document = design("KP");
  const after = await kept(await kept(first, service).then((p) => ({ ...p, document: first.document })), service);
  assert.equal(service.created, 1);
  assert.equal(service.kept?.document.chart, "KP");
  assert.equal(after.remote?.revision, 2);
});

test("two windows with one new design keep both", async () => {
  const service = new OneDesign();
  await deliver(parcelOf(design("KK")), service);
  await deliver(parcelOf(design("PP")), service);
  assert.equal(service.created, 2);
});

test("strokes of two people merge", async () => {
  const service = new OneDesign();
  const mine = await kept(parcelOf(design("KKKK")), service);
  await service.paint("", { rows: 1, columns: 4, runs: [{ row: 0, column: 3, stitches: "P" }] });
  const outcome = await deliver({ ...mine, document: design("PKKK") }, service);
  assert.equal(outcome.kind, "merged");
  assert.equal(/** @type {any} */ (outcome).parcel.document.chart, "PKKP");
  assert.equal(service.kept?.document.chart, "PKKP");
});

test("a rename elsewhere and strokes here merge; two renames are a conflict", async () => {
  const service = new OneDesign();
  const mine = await kept(parcelOf(design("KK")), service);
  service.kept = { document: design("KK", { name: "Theirs" }), revision: 2 };
  const merged = await kept({ ...mine, document: design("KP", { note: "x" }) }, service);
  assert.equal(merged.document.name, "Theirs");
  assert.equal(merged.document.chart, "KP");
  await deliver(merged, service);
  assert.equal(service.kept?.document.note, "x");

  service.kept = { document: { ...service.kept.document, name: "Again" }, revision: 9 };
  const clash = await deliver({ ...merged, document: { ...merged.document, name: "Mine" } }, service);
  assert.equal(clash.kind, "conflict");
  assert.deepEqual(/** @type {any} */ (clash).parts, ["name"]);
});

test("a design deleted elsewhere comes back with the change", async () => {
  const service = new OneDesign();
  const mine = await kept(parcelOf(design("KK")), service);
  service.deleted = true;
  const again = await kept({ ...mine, document: design("KP") }, service);
  await deliver(again, service);
  assert.equal(service.deleted, false);
  assert.equal(service.kept?.document.chart, "KP");
});

test("a service that has lost everything gets the design anew", async () => {
  const service = new OneDesign();
  const mine = await kept(parcelOf(design("KK")), service);
  const now = () => service.kept?.document.chart;
  service.kept = null;
  await deliver({ ...mine, document: design("KP") }, service);
  assert.equal(now(), "KP");
});

test("a delivery whose answer was lost is no conflict with oneself", async () => {
  const service = new OneDesign();
  const first = design("KK\nKK");
  const { parcel } = /** @type {any} */ (
    await deliver({ id: "mine", remote: null, base: null, document: first }, service)
  );
  const sent = design("PK\nKK", { name: "Sleeve", repeats: [] });
  await service.replace("1", sent, 1); // it arrived, but its answer did not
  const undone = { ...parcel, document: design("KK\nKK", { name: "Cuff of mine" }), sent: [sent] };
  const outcome = await deliver(undone, service);
  assert.equal(outcome.kind, "kept");
  assert.deepEqual(/** @type {any} */ (outcome).parcel.document, undone.document);
  const again = await deliver(/** @type {any} */ (outcome).parcel, service);
  assert.equal(again.kind, "kept");
  assert.deepEqual(service.kept?.document, undone.document);
  const others = await deliver({ ...undone, sent: [] }, service);
  assert.notEqual(others.kind, "conflict"); // the service has the very same by now
});

test("the same change by somebody else is a conflict still", async () => {
  const service = new OneDesign();
  const first = design("KK\nKK");
  const { parcel } = /** @type {any} */ (
    await deliver({ id: "mine", remote: null, base: null, document: first }, service)
  );
  await service.replace("1", design("PK\nKK", { name: "Theirs" }), 1);
  const mine = { ...parcel, document: design("KK\nKK", { name: "Mine" }), sent: [design("PP\nKK")] };
  assert.equal((await deliver(mine, service)).kind, "conflict");
});

test("lace of two people becomes one chart, stitch by stitch; the same stitch painted twice is a conflict", () => {
  const base = design("KKKKKK\nKKKKKK", { other_stitches: [{ row: 0, column: 0, codes: "[1/1R]" }] });
  const lace = [...base.other_stitches, { row: 1, column: 0, codes: "O/" }];
  const mine = { ...base, other_stitches: lace };
  const theirs = design("KKKKPK\nKPKKKK", { other_stitches: [{ row: 1, column: 3, codes: "V" }] });
  const { document, conflicts } = merge(base, mine, theirs);
  assert.deepEqual(conflicts, []);
  assert.equal(document.chart, "KKKKPK\nKPKKKK");
  assert.deepEqual(document.other_stitches, [
    { row: 1, column: 0, codes: "O/" },
    { row: 1, column: 3, codes: "V" },
  ]);
  const other = { ...base, other_stitches: [{ row: 1, column: 1, codes: "V" }] };
  assert.deepEqual(merge(base, mine, other).conflicts, ["chart"]);
  assert.ok(!same(base, mine) && same(mine, { ...mine }));
});

test("a chart with lace is sent whole: strokes would paint it over", async () => {
  const service = new OneDesign();
  const lace = design("KK\nKK", { other_stitches: [{ row: 1, column: 0, codes: "V" }] });
  await service.create(lace, "key");
  service.paint = () => assert.fail("painted");
  const document = { ...lace, chart: "PK\nPK" };
  const parcel = { id: "a", remote: { id: "1", revision: 1 }, base: lace, document };
  assert.equal((await deliver(parcel, service)).kind, "kept");
  assert.deepEqual(service.kept?.document, document);
});
