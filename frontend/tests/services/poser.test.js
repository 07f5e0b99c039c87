import assert from "node:assert/strict";
import { test } from "node:test";

import { api } from "../../api.js";
import { wordsOf } from "../../state/seeing.js";
import { Signal } from "../../core/signal.js";
import { Grid } from "../../grid/grid.js";
import { startPoser } from "../../services/poser.js";

/** What the poser reads of the page. @returns {any} */
function studio() {
  let change = () => {};
  const signal = (/** @type {unknown} */ value) => new Signal(value);
  const seeing = {
    pose: signal("flat"),
    posed: signal(null),
    limb: signal({ direction: "course", girths: null }),
    curling: signal(false),
    glove: signal(null),
  };
  const page = {
    seeing,
    weight: signal(0.5),
    step: signal(0),
    stretch: signal(null),
    materialId: signal("acrylic"),
    gauges: { changes: signal(0), known: null, of: () => page.gauges.known },
    online: signal(true),
    problem: signal(null),
    /** @param {unknown} problem */
    tellProblem(problem) {
      this.problem.value = problem;
    },
    currentStrain: () => null,
    tooLarge: () => "",
    document: {
      grid: Grid.fromText("KP"),
      outlineText: null,
      shaped: false,
      outline: Uint8Array.of(1, 1),
      onChange: (/** @type {() => void} */ heard) => (change = heard),
    },
    paint: () => change(),
  };
  return page;
}

/** Shapes that are shown one after the other, until `count` are there. @param {any} page @param {number} count */
function shown(page, count) {
  /** @type {any[]} */
  const shapes = [];
  return new Promise((resolve) => {
    page.seeing.posed.listen((/** @type {any} */ posed) => {
      if (posed && shapes.push(posed) === count) resolve(shapes);
    });
  });
}

/** A service that answers so often that a shape is not at rest. @param {number} previews */
function answering(previews) {
  let calls = 0;
  /** @type {any} */ (api).run = () =>
    Promise.resolve({ id: `shape ${calls}`, rows: 1, columns: 2, converged: calls++ >= previews, notes: [] });
}

/** What a page shows that is laid down, until so many shapes are there. @param {any} page @param {number} count */
function laid(page, count) {
  startPoser(page);
  const shapes = shown(page, count);
  page.seeing.pose.value = "lying";
  return shapes;
}

test("a shape that is not at rest is called a preview until the one at rest has come", async () => {
  answering(1);
  const [first, last] = await laid(studio(), 2);
  assert.match(wordsOf(first), /a preview/);
  assert.doesNotMatch(wordsOf(last), /a preview/);
});

test("a shape that never comes to rest stays a preview", async () => {
  answering(Infinity);
  for (const posed of await laid(studio(), 2)) assert.match(wordsOf(posed), /a preview/);
});

test("after a stroke the old shape is a preview at once", async () => {
  answering(0);
  const page = studio();
  await laid(page, 1);
  page.paint();
  assert.match(wordsOf(page.seeing.posed.value), /a preview/);
  page.seeing.pose.value = "flat"; // nothing is asked for any more
});

test("the first shape begins at the old one, and the last one at nothing", async () => {
  /** @type {any[]} */
  const begun = [];
  /** @type {any} */ (api).run = (/** @type {string} */ operation, /** @type {any} */ { after, time_limit_s }) => {
    assert.equal(operation, "curl");
    begun.push(after);
    const id = `shape ${begun.length}`;
    return Promise.resolve({ id, rows: 1, columns: 2, converged: time_limit_s > 1 || after, notes: [] });
  };
  const page = studio();
  await laid(page, 2);
  const three = shown(page, 3);
  page.paint();
  const [old, first, last] = await three;
  assert.deepEqual(begun, [null, null, "shape 2", null]);
  assert.deepEqual(
    [old, first, last].map(({ converged }) => converged),
    [false, false, true],
  );
});

test("a chart that is too large for a pose stays flat, and the reason is said", () => {
  const page = studio();
  const said = /** @type {string[]} */ ([]);
  page.tooLarge = (/** @type {string} */ operation) => `too large for ${operation}`;
  page.tell = (/** @type {string} */ words) => said.push(words);
  startPoser(page);
  page.seeing.pose.value = "lying";
  assert.equal(page.seeing.pose.value, "flat");
  assert.deepEqual(said, ["too large for curl"]);
});

/** A stitch of the chart as it was predicted. */
const STITCH = { relaxed_course_mm: 50, relaxed_wale_mm: 2 };

/** A service whose garment presses by 10 to 40 mmHg. @param {[operation: string, request: any][]} sent */
function pressing(sent) {
  /** @type {any} */ (api).run = (/** @type {string} */ operation, /** @type {any} */ request) => {
    if (operation === "predict") return Promise.resolve(STITCH);
    sent.push([operation, request]);
    const place = { mmhg: [10, 40] };
    return Promise.resolve({ id: "shape", places: [place], parts: [place], limit_mmhg: 32, notes: [] });
  };
}

test("a shaped chart is worn with its outline, and its bar ends at the highest pressure", async () => {
  /** @type {[string, any][]} */
  const sent = [];
  pressing(sent);
  const page = studio();
  page.document.shaped = true;
  page.document.outline = Uint8Array.of(1, 0);
  startPoser(page);
  const shapes = shown(page, 1);
  page.seeing.pose.value = "worn";
  const [{ pressure }] = await shapes;
  assert.deepEqual([sent[0][0], sent[0][1].outline], ["limb", "x."]);
  assert.deepEqual([pressure.most, pressure.limit], [40, 32]);
  page.seeing.limb.value = { ...page.seeing.limb.value };
  assert.equal(page.seeing.posed.value.pressure, undefined); // that of another limb
  page.seeing.pose.value = "flat";
});

test("every pose has the size of a counted gauge, and is computed anew when one is counted", async () => {
  for (const pose of ["lying", "hung", "worn"]) {
    /** @type {unknown[]} */
    const sent = [];
    /** @type {any} */ (api).run = (/** @type {string} */ operation, /** @type {any} */ { gauge }) => {
      if (operation === "predict") return Promise.resolve({ relaxed_course_mm: 50, relaxed_wale_mm: gauge ? 3 : 2 });
      sent.push(gauge);
      return Promise.resolve({ id: `shape ${sent.length}`, places: [], converged: true, notes: [] });
    };
    const page = studio();
    startPoser(page);
    const atRest = () =>
      new Promise((resolve) =>
        page.seeing.posed.listen((/** @type {any} */ posed) => posed?.converged && resolve(posed)),
      );
    const uncounted = atRest();
    page.seeing.pose.value = pose;
    await uncounted;
    const counted = atRest();
    page.gauges.known = "counted";
    page.gauges.changes.value += 1;
    await counted;
    assert.deepEqual(sent, [null, "counted"]);
    page.seeing.pose.value = "flat";
  }
});

test("the limb fits the whole piece, whatever part of it is selected", async () => {
  const girths = [];
  for (const selection of [null, { row0: 0, row1: 1, column0: 0, column1: 1 }]) {
    /** @type {[string, any][]} */
    const sent = [];
    pressing(sent);
    const page = studio();
    page.selection = { value: selection };
    startPoser(page);
    const worn = shown(page, 1);
    page.seeing.pose.value = "worn";
    await worn;
    girths.push(sent[0][1].girths);
    page.seeing.pose.value = "flat";
  }
  const around = 2 * STITCH.relaxed_course_mm;
  assert.deepEqual(
    girths[0].map((/** @type {any} */ { girth_mm }) => girth_mm),
    [1.12 * around, 1.25 * around].map(Math.round),
  );
  assert.deepEqual(girths[1], girths[0]);
});

test("a planned glove is worn on its hand until its stitches or its yarn change", async () => {
  /** @type {[string, any][]} */
  const sent = [];
  pressing(sent);
  const page = studio();
  page.document.outlineText = "x.";
  page.seeing.glove.value = { outline: "x.", chart: "KP", request: { material: "acrylic" } };
  startPoser(page);
  const shapes = shown(page, 1);
  page.seeing.pose.value = "worn";
  await shapes;
  const change = { KK: () => (page.document.grid = Grid.fromText("KK")), wool: () => (page.materialId.value = "wool") };
  for (const changed of Object.values(change)) {
    page.document.grid = Grid.fromText("KP");
    page.problem.value = null;
    const refused = new Promise((resolve) => page.problem.listen(resolve));
    page.seeing.pose.value = "worn";
    changed();
    page.paint();
    assert.match(/** @type {any} */ (await refused).detail, /changed since it was planned/);
    assert.equal(page.seeing.pose.value, "flat");
  }
  assert.deepEqual(
    sent.map(([operation]) => operation),
    ["glove"],
  );
});
