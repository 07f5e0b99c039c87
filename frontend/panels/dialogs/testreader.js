/**
 * How the two stretch tests of a fabric are read: what each column is, what the files leave open, and the
 * curves that come out.
 *
 * @import {Direction, DoubtResult, Fabric, TableResult, TablesResult} from "../../types.js"
 * @import {Template} from "../../services/tables.js"
 */

import { api } from "../../api.js";
import { h } from "../../elements/dom.js";
import { icon } from "../../elements/icons.js";
import { pullsPlot } from "../../plots/pulls.js";
import { download } from "../../services/exporter.js";
import {
  QUANTITIES,
  answerable,
  asItStands,
  hindrances,
  changed,
  inWords,
  isSaid,
  remember,
  remembered,
  unitsOf,
  withColumn,
} from "../../services/tables.js";
import { uploaded } from "../../services/yarns.js";
import { textButton } from "../../widgets/buttons.js";
import { labelled, numberField, selectField } from "../../widgets/fields.js";
import { table } from "../../widgets/table.js";
import { attempt } from "../../widgets/problem.js";

/** @param {string} unit */
const unitName = (unit) => (unit === "-" ? "fraction" : unit);

/** @type {readonly (readonly [Direction, string])[]} */
const DIRECTIONS = [
  ["course", "rows"],
  ["wale", "columns"],
];

/**
 * @param {Fabric} fabric
 * @param {Record<Direction, HTMLInputElement>} pickers of the files
 */
export function testReader(fabric, pickers) {
  /** @type {Record<Direction, Template>} */
  const templates = { course: asItStands(), wale: asItStands() };
  /** Files whose template came from this browser. @type {Set<Direction>} */
  const offered = new Set();
  /** Files that have not been looked at yet. @type {Set<Direction>} */
  const fresh = new Set();
  /** @type {TablesResult | null} */
  let read = null;
  let turn = 0;
  const status = h("div", { class: "dialog-status", role: "status" });
  const body = h("div", { class: "test-pair stack" });
  const element = h(
    "section",
    {
      class: "test-reading sunken rounded",
      id: `yarn-${fabric}-reading`,
      hidden: true,
      "aria-label": `How the tests of ${fabric} are read`,
    },
    h("h4", {}, `How the tests of ${fabric} are read`),
    status,
    body,
  );

  /** @returns {Promise<void>} when the latest of several looks is on show */
  const look = async () => {
    const mine = ++turn;
    const [course, wale] = DIRECTIONS.map(([direction]) => pickers[direction].files?.[0]);
    element.hidden = !course && !wale;
    read = null;
    if (element.hidden) return body.replaceChildren();
    if (!body.hasChildNodes()) body.append(h("p", { class: "muted" }, "Reading …"));
    const answer = await attempt(status, async () =>
      api.run("measure/tables", {
        test_course: course ? await uploaded(course) : null,
        test_wale: wale ? await uploaded(wale) : null,
        template_course: templates.course,
        template_wale: templates.wale,
        fabric,
      }),
    );
    if (mine !== turn) return undefined;
    if (!answer) return body.replaceChildren();
    let isKnown = false;
    for (const direction of fresh) {
      const test = answer.tests[direction];
      const before = test && remembered(test);
      if (!before) continue;
      templates[direction] = before;
      offered.add(direction);
      isKnown = true;
    }
    fresh.clear();
    if (isKnown) return look();
    read = answer;
    return show(answer);
  };

  /** A file was chosen: it is read as it stands, or as its like was. @param {Direction} direction */
  const choose = (direction) => {
    templates[direction] = asItStands();
    offered.delete(direction);
    fresh.add(direction);
    void look();
  };
  for (const [direction] of DIRECTIONS) pickers[direction].addEventListener("change", () => choose(direction));

  /** @param {Direction} direction @param {Template} template */
  const say = async (direction, template) => {
    templates[direction] = template;
    offered.delete(direction);
    await look();
    const test = read?.tests[direction];
    if (test?.pulls.length) remember(test, template);
  };

  const exchange = () => {
    const { course, wale } = pickers;
    [course.files, wale.files] = [wale.files, course.files];
    [templates.course, templates.wale] = [templates.wale, templates.course];
    void look();
  };

  /**
   * @param {DoubtResult} doubt
   * @param {Direction | null} direction null for a doubt about both
   */
  const question = (doubt, direction) => {
    const name = `${fabric}-${direction ?? "both"}-${doubt.field}`;
    return h(
      "fieldset",
      { class: `test-question line wrap rounded ${doubt.is_open ? "open" : ""}` },
      h("legend", {}, icon("warning"), ` ${doubt.field}: ${doubt.problem}`),
      ...doubt.readings.map((reading) =>
        h(
          "label",
          { class: "check" },
          h("input", {
            type: "radio",
            name,
            checked: direction ? isSaid(templates[direction], reading) : !reading.exchanges && !doubt.is_open,
            onchange: () => {
              if (reading.exchanges) exchange();
              else if (direction) void say(direction, changed(templates[direction], reading.changes));
            },
          }),
          reading.words,
        ),
      ),
    );
  };

  /** @param {Direction} direction @param {TableResult} test */
  const columnTable = (direction, test) => {
    const what = test.columns.map(({ title, quantity }) => {
      const choice = selectField(
        {
          "aria-label": `${title} holds`,
          class: `select ${quantity ? "" : "unused"}`,
          onchange: () => void say(direction, withColumn(templates[direction], test, title, choice.value)),
        },
        QUANTITIES,
      );
      choice.value = quantity;
      choice.disabled = !title;
      return h("td", {}, choice);
    });
    const units = test.columns.map(({ title, quantity, unit }) => {
      const known = unitsOf(quantity);
      if (!known.length) return h("td", { class: "muted" }, unit);
      /** @type {Record<string, string>} */
      const own = unit && !known.includes(unit) ? { [unit]: unit } : {};
      /** @type {Record<string, string>} */
      const silent = unit ? {} : { "": `${unitName(known[0])}, not stated` };
      const choice = selectField(
        {
          "aria-label": `Unit of ${title}`,
          class: `select ${unit ? "" : "asked"}`,
          onchange: () => void say(direction, changed(templates[direction], { units: { [quantity]: choice.value } })),
        },
        { ...silent, ...own, ...Object.fromEntries(known.map((word) => [word, unitName(word)])) },
      );
      choice.value = unit;
      return h("td", {}, choice);
    });
    const rows = test.rows.map((cells) => h("tr", {}, ...cells.map((cell) => h("td", { class: "figures" }, cell))));
    return h(
      "div",
      { class: "test-table" },
      table(
        { class: "small" },
        test.columns.map(({ title }) => title),
        h("tbody", {}, h("tr", {}, ...what), h("tr", {}, ...units), ...rows),
      ),
    );
  };

  /** @param {Direction} direction @param {"width_mm" | "length_mm"} name @param {TableResult} test */
  const size = (direction, name, test) => {
    const field = numberField({
      id: `yarn-${fabric}-${direction}-${name === "width_mm" ? "width" : "length"}`,
      min: "5",
      max: "10000",
      step: "any",
      value: test[name] ?? "",
      onchange: () => {
        const value = Number.isFinite(field.valueAsNumber) ? field.valueAsNumber : null;
        void say(direction, changed(templates[direction], { [name]: value }));
      },
    });
    field.classList.toggle("asked", test.missing.includes(name));
    return field;
  };

  /** @param {Direction} direction @param {string} along @param {TableResult} test */
  const half = (direction, along, test) => {
    const template = templates[direction];
    const words = inWords(template);
    const wrong = hindrances({ ...test, doubts: [] }).join(" ");
    const asStands = () => void say(direction, asItStands());
    const save = () => {
      const text = `${JSON.stringify(template, null, 1)}\n`;
      download(`${test.name.replace(/\.\w+$/, "")}-template.json`, new Blob([text], { type: "application/json" }));
    };
    return h(
      "section",
      { class: "test-half stack gap-8 shrinks-x", "aria-label": `${test.name}, along the ${along}` },
      h("h5", {}, test.name, h("span", { class: "muted" }, ` along the ${along}`)),
      wrong && h("p", { class: "problem-text", role: "alert" }, wrong),
      ...test.doubts.map((doubt) => question(doubt, direction)),
      test.columns.length > 0 && columnTable(direction, test),
      h(
        "div",
        { class: "yarn-facts" },
        labelled("Width", size(direction, "width_mm", test), "mm, clamped"),
        labelled("Clamps", size(direction, "length_mm", test), "mm apart at rest"),
      ),
      test.pulls.length > 0 && pullsPlot(test.pulls, `Force against stretch along the ${along}, ${test.name}`),
      test.notes.length > 0 && h("ul", { class: "notes small" }, ...test.notes.map((note) => h("li", {}, note))),
      words &&
        h(
          "p",
          { class: "small muted" },
          `${offered.has(direction) ? "Read as a table with the same heads was" : "Read with what you said"}: ${words}. `,
        ),
      words &&
        h(
          "div",
          { class: "flex wrap gap-8" },
          textButton("undo", "Read it as it stands", asStands),
          textButton("export", "Save how it is read", save),
        ),
    );
  };

  /** @param {TablesResult} answer */
  const show = ({ tests, doubts }) => {
    const focused = document.activeElement?.id;
    body.replaceChildren(
      ...answerable(doubts).map((doubt) => question(doubt, null)),
      ...DIRECTIONS.flatMap(([direction, along]) => {
        const test = tests[direction];
        return test ? [half(direction, along, test)] : [];
      }),
    );
    if (focused) document.getElementById(focused)?.focus();
  };

  return {
    element,
    templates,
    /** What has to be answered before a law is fitted; empty if nothing has. */
    open: () => {
      if (!element.hidden && !read) return "Its tests are still being read, or cannot be.";
      const open = Object.values(read?.tests ?? {}).flatMap((test) =>
        hindrances(test).map((words) => (words.includes(test.name) ? words : `${test.name}: ${words}`)),
      );
      const both = (read?.doubts ?? []).filter(({ is_open }) => is_open).map(({ problem }) => problem);
      return [...open, ...both].join(" ");
    },
    /** Nothing is chosen any more. */
    clear: () => {
      Object.assign(templates, { course: asItStands(), wale: asItStands() });
      void look();
    },
  };
}
