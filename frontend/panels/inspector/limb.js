/**
 * The chart (or its part) worn as a tube on a limb: how it fits and presses along it.
 *
 * @import {GirthAt} from "../../state/seeing.js"
 * @import {Studio} from "../../state/studio.js"
 * @import {Direction, LimbResult} from "../../types.js"
 */

import { api } from "../../api.js";
import { percent, range } from "../../core/format.js";
import { plainNote } from "../../widgets/plainnote.js";
import { Belonging, clothOf } from "../../services/belonging.js";
import { Latest } from "../../services/latest.js";
import { isWarning } from "../../services/poser.js";
import { h, remark } from "../../elements/dom.js";
import { pressurePlot } from "../../plots/pressure.js";
import { clothIn, limbOf, pieceIn, scopeOf } from "../../services/scope.js";
import { iconButton } from "../../widgets/buttons.js";
import { table, tableRow } from "../../widgets/table.js";
import { labelled, numberField, selectField } from "../../widgets/fields.js";
import { problemText } from "../../widgets/problem.js";

const DELAY_MS = 250;
const MAX_GIRTHS = 12;
/** From the last girth to one that is added, mm. */
const FARTHER_MM = 50;

/** @param {HTMLElement} host @param {Studio} studio @returns {() => void} asks anew */
export function limb(host, studio) {
  const chosen = studio.seeing.limb;
  const latest = new Latest(DELAY_MS);
  const ask = () => {
    const { value } = studio.prediction.value;
    if (host.hidden || !value) return;
    const scope = scopeOf(studio);
    const { girths, direction } = limbOf(studio, scope, value);
    if (!chosen.value.girths) showGirths(girths); // those that fit the piece
    // Of a tube of another size the piece is a repeat.
    const rest_mm = tube.valueAsNumber > 0 ? tube.valueAsNumber : null;
    const sized = rest_mm ? girths.map((girth) => ({ ...girth, rest_mm })) : girths;
    const cloth = rest_mm ? clothIn(studio, scope) : pieceIn(studio, scope);
    belonging.check(); // the tube may be another
    const { basis } = belonging;
    latest.run(
      async (signal) => {
        show(await api.run("limb", { ...cloth, direction, girths: sized }, signal));
        belonging.show(basis);
      },
      ({ problem }) => {
        answer.replaceChildren(problemText(problem));
        belonging.clear();
      },
    );
  };
  const tube = numberField({ id: "limb-tube", min: "10", max: "3000", placeholder: "chart", oninput: ask });
  const around = selectField(
    {
      class: "select",
      id: "limb-around",
      onchange: () => (chosen.value = { ...chosen.value, direction: /** @type {Direction} */ (around.value) }),
    },
    { course: "rows go around", wale: "columns go around" },
  );
  around.value = chosen.value.direction;

  const body = h("tbody", {});
  /** Girths as they stand in the fields; those without a number, or out of order, are left out. */
  const given = () => {
    const girths = [...body.rows].map((row) => {
      const [at, girth] = [...row.querySelectorAll("input")].map((field) => field.valueAsNumber);
      return { at_mm: at, girth_mm: girth };
    });
    return girths
      .filter(({ at_mm, girth_mm }) => at_mm >= 0 && girth_mm > 0)
      .sort((a, b) => a.at_mm - b.at_mm)
      .filter(({ at_mm }, i, all) => at_mm !== all[i - 1]?.at_mm);
  };
  const change = () => {
    const girths = given();
    if (girths.length > 1) chosen.value = { ...chosen.value, girths };
  };
  /** @param {GirthAt[]} girths */
  const showGirths = (girths) => {
    const old = given();
    if (JSON.stringify(old) === JSON.stringify(girths)) return;
    body.replaceChildren(...girths.map(girthRow));
  };
  /** @param {GirthAt} girth @param {number} i */
  const girthRow = ({ at_mm, girth_mm }, i) => {
    const field = (/** @type {string} */ name, /** @type {number} */ value, /** @type {number} */ min) =>
      numberField({ value, min, max: "3000", "aria-label": `${name} ${i + 1}`, oninput: change });
    const remove = iconButton("close", `Remove girth ${i + 1}`, () => {
      if (body.rows.length < 3) return;
      row.remove();
      change();
    });
    const row = tableRow(null, field("Place", at_mm, 0), field("Girth", girth_mm, 10), remove);
    return row;
  };
  const add = () => {
    const girths = given();
    const last = girths.at(-1);
    if (!last || girths.length >= MAX_GIRTHS) return;
    chosen.value = {
      ...chosen.value,
      girths: [...girths, { at_mm: last.at_mm + FARTHER_MM, girth_mm: last.girth_mm }],
    };
    showGirths(chosen.value.girths ?? []);
  };
  showGirths(chosen.value.girths ?? []);

  const answer = h("div", { role: "status", id: "limb-answer" });
  const belonging = new Belonging(studio, () => {
    const { value } = studio.prediction.value;
    const worn = value && limbOf(studio, scopeOf(studio), value);
    return { ...clothOf(studio), limb: [worn, tube.value] };
  });
  belonging.marks(answer, "limb");
  /** @param {LimbResult} fit */
  const show = (fit) => {
    const { places, tightest_mm, loose_mm, length_mm, relaxed_length_mm, interval_source } = fit;
    const pressed = places.filter(({ mmhg }) => mmhg);
    const ends = (/** @type {"mmhg" | "mmhg_with_spread"} */ name) => {
      const all = pressed.map((place) => /** @type {[number, number]} */ (place[name]));
      return [Math.min(...all.map(([low]) => low)), Math.max(...all.map(([, high]) => high))];
    };
    const stretch = places.map(({ ease }) => Math.max(0, 1 / (1 + ease) - 1));
    const stretched = new Set([percent(Math.min(...stretch)), percent(Math.max(...stretch))]);
    const words = [
      `Stretched around the limb by ${[...stretched].join(" to ")}.`,
      `Nearest to running out of stretch ${tightest_mm.toFixed(0)} mm along (${percent(Math.max(...places.map((p) => p.lock_up_share)))}).`,
      loose_mm > 0 ? `Loose over ${loose_mm.toFixed(0)} mm.` : "",
      length_mm && relaxed_length_mm
        ? `${length_mm.toFixed(0)} mm long on the limb if free to shorten, ${relaxed_length_mm.toFixed(0)} mm unworn.`
        : "",
    ];
    const problem = places.find((place) => place.problem && place.ease < 0)?.problem;
    answer.replaceChildren(
      h(
        "p",
        { class: "limb-pressure flex wrap" },
        h("span", { class: "value figures" }, pressed.length ? `${range(ends("mmhg"))} mmHg` : "No pressure"),
        pressed.length
          ? h(
              "span",
              { class: "muted figures", title: interval_source },
              `90 % interval ${range(ends("mmhg_with_spread"))}`,
            )
          : "",
      ),
      ...fit.notes.filter(isWarning).map((words) => h("p", { class: "problem-text", role: "alert" }, words)),
      pressurePlot(places),
      h("p", { class: "muted figures" }, words.filter(Boolean).join(" ")),
      problem ? h("p", { class: "muted" }, problem) : "",
      remark("A mean over the limb, without friction or posture; not a medical class."),
    );
  };
  host.append(
    plainNote(studio, "The fit on a limb"),
    h(
      "div",
      { class: "limb-fields flex wrap" },
      table({ class: "limb-girths" }, ["Distance along, mm", "Girth, mm", ""], body),
      h(
        "div",
        { class: "limb-more flex wrap gap-6" },
        h("button", { class: "button", id: "limb-add", onclick: add }, "Add a girth"),
        labelled("Tube, unworn", tube, "mm"),
        labelled("Which way round?", around),
        h(
          "button",
          { class: "button", id: "limb-wear", onclick: () => (studio.seeing.pose.value = "worn") },
          "Show on the body",
        ),
      ),
    ),
    answer,
  );
  studio.prediction.listen(({ busy }) => !busy && ask());
  chosen.listen(ask);
  return ask;
}
