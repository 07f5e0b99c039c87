/**
 * What the cloth's own weight does: hanging, over an edge, over a disc, and how wide a border would hold
 * it flat. Asked for by buttons, since these take seconds.
 *
 * @import {Studio} from "../../state/studio.js"
 */

import { api } from "../../api.js";
import { figure, percent } from "../../core/format.js";
import { plainNote } from "../../widgets/plainnote.js";
import { Belonging, clothOf } from "../../services/belonging.js";
import { Latest } from "../../services/latest.js";
import { h } from "../../elements/dom.js";
import { clothIn, scopeOf } from "../../services/scope.js";
import { labelled, numberField } from "../../widgets/fields.js";
import { textButton } from "../../widgets/buttons.js";
import { problemText } from "../../widgets/problem.js";

/** @typedef {ReturnType<typeof clothIn> & {linear_density_g_per_m: number}} Weighed */
/**
 * @typedef {{words: string[], notes: string[], converged?: boolean, piece?: {id: string, chart: string, outline: string}}} Findings
 *   words, and what to show in 3D and whether that is at rest
 */

/** Fabrics of a border. */
const BORDERS = /** @type {const} */ (["garter", "seed", "rib"]);

/**
 * The simulated tests: words of the button, what it is for, and how they are computed.
 *
 * @type {{id: string, label: string, hint: string,
 *   compute: (cloth: Weighed, signal: AbortSignal) => Promise<Findings>}[]}
 */
const TESTS = [
  {
    id: "overhang",
    label: "Over an edge",
    hint: "A strip that hangs over the edge of a table: Peirce's bending length",
    compute: async (request, signal) => {
      const ways = /** @type {const} */ (["course", "wale"]);
      const overhangs = await Promise.all(
        ways.map((direction) => api.run("overhang", { ...request, direction }, signal)),
      );
      const [rows, columns] = overhangs.map(({ bending_length_mm: mm }) => figure(mm / 10, 2));
      return {
        words: [`Bending length ${rows} cm along the rows, ${columns} cm along the columns.`],
        notes: overhangs[0].notes,
        converged: overhangs[0].converged,
        piece: overhangs[0].piece,
      };
    },
  },
  {
    id: "drape",
    label: "Over a disc",
    hint: "A round piece of 30 cm over a disc of 18 cm: the drape coefficient",
    compute: async (request, signal) => {
      const draped = await api.run("drape", request, signal);
      const { coefficient, coefficient_of_states: ends, folds, fall_mm, notes, converged, piece } = draped;
      const states = [...new Set(ends.map((end) => percent(end)))];
      const others = states.length > 1 ? ` (it comes to rest in several ways: ${states.join(" to ")})` : "";
      return {
        words: [
          `Drape coefficient ${percent(coefficient)}, ${folds} folds${others}.`,
          `Falls by ${figure(fall_mm / 10, 2)} cm. Soft cloth drapes more than this.`,
        ],
        notes,
        converged,
        piece,
      };
    },
  },
  {
    id: "border",
    label: "Border",
    hint: "How wide a border of garter, seed or rib holds it flat by its weight",
    compute: async (request, signal) => {
      const borders = await Promise.all(BORDERS.map((border) => api.run("border", { ...request, border }, signal)));
      const words = borders.map(({ sides, ends }, i) => {
        const [wide, high] = [sides, ends].map(({ width_mm: mm }) => figure(mm / 10, 2));
        const lies = sides.holds && ends.holds ? "" : "; a border cannot hold it flat";
        return `A ${BORDERS[i]} border by its weight alone: ${wide} cm at the sides, ${high} cm at the ends${lies}.`;
      });
      return { words, notes: borders[0].notes };
    },
  },
];

/** @param {HTMLElement} host @param {Studio} studio @returns {() => void} nothing to draw anew */
export function drape(host, studio) {
  const latest = new Latest(0);
  const answer = h("div", { role: "status", id: "drape-answer" });
  const belonging = new Belonging(studio, () => ({ ...clothOf(studio), weight: studio.weight.value }));
  belonging.marks(answer, "drape");
  const weight = numberField({ id: "drape-weight", min: "0.005", max: "20", step: "0.01", value: studio.weight.value });
  weight.addEventListener("change", () => {
    if (weight.valueAsNumber > 0) studio.weight.value = weight.valueAsNumber;
  });
  /** @param {string} label @param {NonNullable<Findings["piece"]> & Pick<Weighed, "gauge">} piece @param {boolean} converged @param {string} note */
  const show = (label, { id, ...piece }, converged, note) => {
    const { rows, columns } = studio.document.grid;
    studio.seeing.pose.value = "tested";
    studio.seeing.posed.value = {
      pose: "tested",
      id,
      rows,
      columns,
      converged,
      words: `${label}, by its weight`,
      note,
      piece,
    };
  };
  /** @param {(typeof TESTS)[number]} test */
  const run = ({ label, compute }) => {
    const cloth = clothIn(studio, scopeOf(studio));
    const request = { ...cloth, linear_density_g_per_m: studio.weight.value };
    const { basis } = belonging;
    belonging.clear();
    answer.replaceChildren(h("span", { class: "spinner" }), `${label}: being computed`);
    latest.run(
      async (signal) => {
        const { words, notes, converged = false, piece } = await compute(request, signal);
        answer.replaceChildren(
          ...words.map((text) => h("p", { class: "figures" }, text)),
          ...notes.map((text) => h("p", { class: "muted" }, text)),
        );
        belonging.show(basis);
        if (piece && !belonging.stale.value) show(label, { ...piece, gauge: cloth.gauge }, converged, notes[0]);
      },
      ({ problem }) => answer.replaceChildren(problemText(problem)),
    );
  };
  host.append(
    plainNote(studio, "Drape"),
    h(
      "div",
      { class: "limb-more flex wrap gap-6" },
      labelled("Yarn weighs", weight, "g/m"),
      textButton(null, "Hang it", () => (studio.seeing.pose.value = "hung"), {
        id: "drape-hang",
        title: "Hanging from its top edge, in 3D",
      }),
      ...TESTS.map((test) =>
        h(
          "button",
          { class: "button", id: `drape-${test.id}`, title: test.hint, onclick: () => run(test) },
          test.label,
        ),
      ),
    ),
    answer,
  );
  return () => {};
}
