/**
 * Two pieces side by side: their charts on one scale, their numbers with the difference, their curves
 * in one plot, their extensibility rectangles one in the other.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {Answer} from "../../core/difference.js"
 * @import {Studio} from "../../state/studio.js"
 * @import {Direction, PredictResult} from "../../types.js"
 * @import {Answers, Choice, Piece} from "./pieces.js"
 */

import { ApiError } from "../../api.js";
import { difference } from "../../core/difference.js";
import { DIRECTIONS, LINES, along } from "../../core/directions.js";
import { figure, range } from "../../core/format.js";
import { STRETCH } from "../../core/hand.js";
import { Latest } from "../../services/latest.js";
import { h, remark } from "../../elements/dom.js";
import { drawPair } from "../../plots/pair.js";
import { dialog } from "../../widgets/dialog.js";
import { segmented } from "../../widgets/fields.js";
import { thumbnail } from "../../widgets/thumbnail.js";
import { sizeAtRest } from "../../services/scope.js";
import { NOW, answers, choices, piece } from "./pieces.js";
import { problemBox } from "../../widgets/problem.js";

/** The sides, and the colours that their curves and rectangles have. */
const SIDES = /** @type {const} */ ([
  { id: "a", letter: "A", colour: "accent" },
  { id: "b", letter: "B", colour: "odd" },
]);
/** Longest side of the larger picture. */
const PICTURE_PX = 190;
const RECTANGLES_PX = 150;

/** @param {Studio} studio @param {ActionContext} context */
export function create(studio, { keeper }) {
  const status = h("div", { class: "dialog-status", role: "status" });
  const table = h("table", { class: "numbers compare-numbers full-width", id: "compare-numbers" });
  const plot = h("div", { class: "plot relative shrinks-x shrinks-y clipped", id: "compare-plot" });
  const rectangles = h("div", { class: "compare-rectangles stack" });
  /** @type {Direction} */
  let direction = "course";
  const directions = DIRECTIONS.map(
    (way) => /** @type {const} */ ([way, `Pulled ${along(way)}`, { id: `compare-${way}` }]),
  );
  const ways = segmented("Direction of the curves", directions, direction, (way) => {
    direction = way;
    draw();
  });
  const sides = SIDES.map(({ id, letter }) => {
    const which = h("select", {
      class: "select grows shrinks-x full-width",
      id: `compare-${id}`,
      "aria-label": `Piece ${letter}`,
      onchange: () => ((side.yarnId = ""), load()),
    });
    const yarn = h("select", {
      class: "select grows shrinks-x full-width",
      id: `compare-${id}-yarn`,
      "aria-label": `Yarn of piece ${letter}`,
      onchange: () => ((side.yarnId = yarn.value), load()),
    });
    const side = {
      which,
      yarn,
      yarnId: "", // chosen instead of the piece's own
      picture: h("div", { class: "compare-picture centred rounded sunken" }),
      size: h("p", { class: "muted figures small" }),
    };
    return side;
  });
  const element = dialog(
    "compare-dialog",
    "Compare",
    h(
      "div",
      { class: "compare-sides stack" },
      ...sides.map(({ which, yarn, picture, size }, k) =>
        h(
          "section",
          { class: "stack gap-6 shrinks-x", "aria-label": `Piece ${SIDES[k].letter}` },
          h("div", { class: "line gap-8" }, badge(k), which),
          yarn,
          picture,
          size,
        ),
      ),
    ),
    status,
    h("div", { class: "compare-answers stack" }, h("div", {}, table), h("div", {}, ways.element, plot, rectangles)),
  );

  /** @type {{piece: Piece, answers: Answers}[]} */
  let compared = [];
  const latest = new Latest(0);
  const load = () => {
    element.classList.add("busy");
    if (!compared.length) status.replaceChildren(remark("The numbers of both pieces come in a moment …"));
    latest.run(
      async (signal) => {
        const all = await Promise.all(
          sides.map(async ({ which, yarnId }) => {
            const sidePiece = await piece(studio, keeper, which.value);
            const material = yarnId || sidePiece.material;
            const answered = await answers(sidePiece, material, studio.gauges, signal);
            return { piece: { ...sidePiece, material }, answers: answered };
          }),
        );
        if (signal.aborted) return;
        compared = all;
        status.replaceChildren();
        element.classList.remove("busy");
        draw();
      },
      ({ problem }) => {
        element.classList.remove("busy");
        compared = []; // the numbers on show are of other pieces
        for (const shown of [table, rectangles, ...sides.map(({ picture }) => picture)]) shown.replaceChildren();
        for (const { size } of sides) size.textContent = "";
        void drawPair(plot, []);
        status.replaceChildren(problemBox(problem, load));
      },
    );
  };
  const draw = () => {
    if (!compared.length) return;
    const sizes = compared.map(({ piece: { scope }, answers: { predicted } }) => {
      const { course, wale } = sizeAtRest(scope, predicted);
      return { width: course.value / 10, height: wale.value / 10 };
    });
    const scale = PICTURE_PX / Math.max(...sizes.flatMap(({ width, height }) => [width, height]));
    compared.forEach(({ piece: { chart, outline, material, scope }, answers: { predicted } }, k) => {
      const { width, height } = sizes[k];
      const picture = thumbnail({ chart, outline }, { side: PICTURE_PX });
      picture.style.cssText = `width: ${width * scale}px; height: ${height * scale}px; aspect-ratio: auto`;
      sides[k].picture.replaceChildren(picture);
      sides[k].size.textContent = `${scope.size} · ${figure(width)} × ${figure(height)} cm at rest`;
      sides[k].size.title = scope.note || predicted.notes.join(" ");
      yarns(sides[k].yarn, studio, material);
    });
    fill(
      table,
      compared.map((side) => side.answers),
    );
    drawRectangles(
      rectangles,
      compared.map((side) => side.answers.predicted),
    );
    void drawPair(
      plot,
      compared.map(({ answers: { curves } }, k) => ({
        name: SIDES[k].letter,
        colour: SIDES[k].colour,
        curve: curves[direction],
      })),
    );
  };

  element.addEventListener("close", () => latest.cancel()); // a browser sends only six requests at a time

  /** The design that was compared last. */
  let opened = "";
  return async () => {
    element.classList.add("busy"); // what is on show may be old
    element.showModal();
    await keeper.flush();
    const { against } = studio.seeing;
    /** @type {Choice[]} */
    let all;
    try {
      all = await choices(studio, keeper);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      element.classList.remove("busy");
      status.replaceChildren(problemBox(error.problem));
      return;
    }
    const same = opened === studio.designId;
    opened = studio.designId;
    sides.forEach((side, k) => {
      const { which } = side;
      const before = same ? which.value : "";
      offer(which, all);
      // Opened for a version, or with what was compared last; else with the latest other thing there is.
      const last = against.value ? "" : before;
      const preferred = last || (k ? (against.value ?? all[1]?.value ?? NOW) : NOW);
      which.value = all.some(({ value }) => value === preferred) ? preferred : NOW;
      if (which.value !== before) side.yarnId = "";
    });
    against.value = null;
    load();
  };
}

/** @param {number} side */
function badge(side) {
  const { letter, colour } = SIDES[side];
  const element = h("span", { class: "compare-badge small" }, letter);
  element.style.backgroundColor = `var(--${colour})`;
  return element;
}

/** @param {HTMLSelectElement} select @param {Choice[]} all */
function offer(select, all) {
  const groups = [...new Set(all.map(({ group }) => group))];
  select.replaceChildren(
    ...groups.map((label) =>
      h(
        "optgroup",
        { label },
        ...all.filter(({ group }) => group === label).map(({ value, label: text }) => h("option", { value }, text)),
      ),
    ),
  );
}

/** @param {HTMLSelectElement} select @param {Studio} studio @param {string} chosen */
function yarns(select, studio, chosen) {
  select.replaceChildren(...studio.completeYarns.map(({ id, name }) => h("option", { value: id }, name)));
  select.value = chosen;
}

/**
 * The numbers that are compared: what they are, their unit, and their values with the intervals.
 *
 * @param {Answers} answers
 * @returns {[label: string, unit: string, answer: Answer][]}
 */
const numbersOf = ({ predicted }) =>
  DIRECTIONS.flatMap((way) => {
    const poisson = way === "course" ? "poisson_yx" : "poisson_xy";
    const lines = LINES[way];
    const pulled = predicted.hand.find(({ pull }) => pull === "hand")?.[way];
    const [low, high] = pulled?.strain_interval ?? [NaN, NaN];
    const modulus = predicted[`modulus_${way}_n_per_mm`];
    return [
      [
        `${STRETCH}, ${lines}`,
        "%",
        { value: pulled && 100 * pulled.strain, interval: pulled && [100 * low, 100 * high] },
      ],
      [
        way === "course" ? "Width of a stitch" : "Height of a stitch",
        "mm",
        { value: predicted[`relaxed_${way}_mm`], interval: predicted[`relaxed_${way}_interval_mm`] },
      ],
      [`Stiffness, ${lines}`, "N/mm", { value: modulus, interval: predicted[`modulus_${way}_interval_n_per_mm`] }],
      [`Poisson ratio, ${lines}`, "", { value: predicted[poisson], interval: predicted[`${poisson}_interval`] }],
    ];
  });

/** @param {HTMLTableElement} table @param {Answers[]} pair */
function fill(table, pair) {
  const [ours, theirs] = pair.map(numbersOf);
  table.replaceChildren(
    h(
      "thead",
      {},
      h(
        "tr",
        {},
        h("td", {}),
        ...SIDES.map((_, k) => h("th", { scope: "col" }, badge(k))),
        h("th", { scope: "col", title: "B beside A; bold where the 90 % intervals do not meet" }, "B over A"),
      ),
    ),
    h(
      "tbody",
      {},
      ...ours.map(([label, unit, answer], row) => {
        const both = [answer, theirs[row][2]];
        const { text, clear, meet } = difference(both[0], both[1]);
        return h(
          "tr",
          {},
          h("th", { scope: "row" }, label, unit && h("span", { class: "unit" }, unit)),
          ...both.map(({ value, interval }, k) =>
            h(
              "td",
              {},
              h("span", { class: "value" }, figure(value)),
              h("span", { class: "interval", title: pair[k].predicted.interval_source }, range(interval)),
            ),
          ),
          h("td", { class: clear ? "clear" : "unclear" }, text, meet && note()),
        );
      }),
    ),
  );
}

const note = () => h("span", { class: "interval" }, "no clear difference");

/** Rectangles of both pieces on one scale, one in the other. @param {HTMLElement} host @param {PredictResult[]} pair */
function drawRectangles(host, pair) {
  const sides = pair.map((predicted) => [
    predicted.extensibility_course_mm_per_n,
    predicted.extensibility_wale_mm_per_n,
  ]);
  // The square root keeps stiff fabrics visible beside ribs that give fifty times as much.
  const scale = RECTANGLES_PX / Math.sqrt(Math.max(...sides.flat()));
  host.replaceChildren(
    h(
      "div",
      { class: "compare-nest relative", role: "img", "aria-label": "Extensibility rectangles of both pieces" },
      ...sides.map(([course, wale], k) => {
        const rectangle = h("span", {});
        rectangle.style.cssText = `width: ${Math.sqrt(course) * scale}px; height: ${Math.sqrt(wale) * scale}px; border-color: var(--${SIDES[k].colour})`;
        return rectangle;
      }),
    ),
    h(
      "p",
      { class: "muted small" },
      "Extensibility rectangles: as wide and as high as the cloth stretches along rows and columns (sides grow as its square root).",
    ),
  );
}
