/**
 * The numbers of the chart or the selection, with interval and source, and two plots.
 *
 * @import {Studio} from "../../state/studio.js"
 * @import {Direction, PredictResult} from "../../types.js"
 * @import {Scope} from "../../services/scope.js"
 */

import { DIRECTIONS, LINES, along } from "../../core/directions.js";
import { figure, percent, percentRange, percents, range } from "../../core/format.js";
import { PULL } from "../../core/hand.js";
import { paced } from "../../core/paced.js";
import { sourceInWords } from "../../core/plainly.js";
import { FABRICS, countSegments, fabricShares, surroundings } from "../../grid/segments.js";
import { scopeOf, sizeAtRest } from "../../services/scope.js";
import { remarksOn } from "../../services/stitches.js";
import { placeOf, predictionOf } from "../../services/belonging.js";
import { h } from "../../elements/dom.js";
import { icon } from "../../elements/icons.js";
import { curvePlot } from "../../plots/curve.js";
import { rigidityPlot } from "../../plots/rigidity.js";
import { drape } from "./drape.js";
import { limb } from "./limb.js";
import { narrower } from "./narrower.js";
import { ownGauge } from "./owngauge.js";
import { segmented } from "../../widgets/fields.js";
import { problemText } from "../../widgets/problem.js";

const COUNT_MS = 80;
/** Loop lengths of a yarn's fabrics that differ by more than this make their sizes another cloth's. */
const LOOP_SPREAD = 1.15;
const PULLS = /** @type {const} */ ([
  ["light", "Light", { title: "A light pull: 0.03 N/mm, 3 N on 10 cm of cloth" }],
  ["hand", "Hand", { title: PULL }],
  ["firm", "Firm", { title: "A firm pull: 0.3 N/mm, 30 N on 10 cm of cloth" }],
]);
const PLOTS = /** @type {const} */ (["rigidity", "curve", "limb", "drape"]);
/** @typedef {(typeof PLOTS)[number]} Plot */

/** @param {HTMLElement} host @param {Studio} studio @returns {() => void} draws the plots anew, for another theme */
export function inspector(host, studio) {
  const title = h("h2", {});
  const scopes = h("select", {
    class: "chip-select",
    id: "inspector-scope",
    title: "What these numbers describe",
    "aria-label": "What these numbers describe",
    onchange: () => {
      studio.selection.value = null;
      studio.seeing.region.value = scopes.value || null;
    },
  });
  const gauge = ownGauge(studio);
  const narrow = narrower(studio);
  const provenance = h("summary", { id: "provenance", title: "Where these numbers come from" });
  const notes = h("ul", { class: "notes" });
  const source = h("details", { class: "source small muted" }, provenance, notes);
  const problem = h("div", { class: "problem", hidden: true });
  const felt = h("table", { class: "numbers full-width" });
  const table = h("table", { class: "numbers full-width" });
  const rank = h("div", { class: "small muted hand-rank", id: "hand-rank" });
  const compared = h("p", { class: "small muted hand-rank", id: "sizes-compared" });
  const others = h("p", { class: "small", id: "other-stitches" });
  const plain = h("p", { class: "small muted", id: "plain-note" });
  const shares = h("div", { class: "shares stack gap-6" });
  const segments = h("div", { class: "shares stack gap-6" });
  const { handPull, details: detailed } = studio.seeing;
  const hands = segmented("How hard you pull", PULLS, handPull.value, (at) => (handPull.value = at), {
    class: "segmented small",
    id: "hand-pull",
  });
  const details = h(
    "details",
    { class: "inspector-details small", id: "inspector-details", open: detailed.value },
    h("summary", {}, "Stiffness, Poisson's ratio, segments"),
    table,
    segments,
  );
  details.addEventListener("toggle", () => (detailed.value = details.open));
  const rigidity = h("div", { class: "plot relative shrinks-x shrinks-y clipped", id: "plot-rigidity" });
  const curve = h("div", { class: "plot relative shrinks-x shrinks-y clipped", id: "plot-curve" });
  const worn = h("div", { class: "limb stack shrinks-x shrinks-y gap-10", id: "plot-limb" });
  const weighed = h("div", { class: "limb stack shrinks-x shrinks-y gap-10", id: "plot-drape" });
  const plots = { rigidity, curve, limb: worn, drape: weighed };
  /** @type {Record<Plot, () => void>} */
  const draw = {
    rigidity: rigidityPlot(rigidity, studio),
    curve: curvePlot(curve, studio),
    limb: limb(worn, studio),
    drape: drape(weighed, studio),
  };

  /** @param {Plot} id @param {string} label */
  const tab = (id, label) =>
    h(
      "button",
      {
        class: "tab bare small shrinks-x nowrap muted clipped",
        role: "tab",
        id: `tab-${id}`,
        "aria-controls": `plot-${id}`,
        onclick: () => {
          choose(id);
          // Where the plot is below the numbers.
          plots[id].scrollIntoView({ block: "nearest" });
        },
      },
      label,
    );
  const tabs = {
    rigidity: tab("rigidity", "Stiffness"),
    curve: tab("curve", "Curves"),
    limb: tab("limb", "Limb"),
    drape: tab("drape", "Drape"),
  };
  const ways = DIRECTIONS.map(
    (way) =>
      /** @type {const} */ ([
        way,
        icon(way),
        { id: `curve-${way}`, title: `Pulled ${along(way)}`, "aria-label": LINES[way] },
      ]),
  );
  const { pull } = studio.seeing;
  const pulls = segmented("Direction of the curves", ways, pull.value, (way) => (pull.value = way), {
    class: "segmented small curve-pulls",
  });
  pull.listen(pulls.show);
  /** @param {Plot} id */
  const choose = (id) => {
    pulls.element.hidden = id !== "curve";
    for (const plot of PLOTS) {
      plots[plot].hidden = plot !== id;
      tabs[plot].setAttribute("aria-selected", String(plot === id));
    }
    draw[id]();
  };

  const numbers = h(
    "div",
    { class: "inspector-numbers" },
    h(
      "div",
      { class: "inspector-head stack" },
      h("div", { class: "inspector-title line gap-8 spread" }, title, scopes),
      source,
    ),
    problem,
    plain,
    h("div", { class: "line gap-8 spread small" }, h("span", { class: "muted" }, "At a pull of"), hands.element),
    felt,
    narrow.element,
    rank,
    gauge.element,
    compared,
    others,
    shares,
    details,
  );
  host.append(
    numbers,
    h(
      "div",
      { class: "inspector-plots stack shrinks-x shrinks-y relative" },
      h("div", { class: "tabs flex wrap shrinks-x", role: "tablist", "aria-label": "Plots" }, ...Object.values(tabs)),
      pulls.element,
      ...Object.values(plots),
    ),
  );
  choose("rigidity");

  const belonging = predictionOf(studio);
  belonging.marks(numbers, "numbers");
  /** The part of the chart that the title names: all that stands below it is of the same part. @type {string | null} */
  let titled = null;
  const show = () => {
    const { value, busy, problem: wrong, basis } = studio.prediction.value;
    host.classList.toggle("busy", busy);
    if (busy && titled !== null) return; // the old numbers stay, with their title, until the answer comes
    if (value) belonging.show(basis);
    else belonging.clear();
    titled = placeOf(studio);
    countSoon();
    const part = scopeOf(studio);
    title.replaceChildren(part.title, " ", h("span", { class: "muted figures unbroken" }, part.size));
    title.title = part.note || (part.shaped && value ? value.notes[0] : "");
    // While the service is unreachable the banner says so.
    problem.hidden = !wrong || wrong.type === "offline";
    if (wrong) problem.replaceChildren(icon("warning"), problemText(wrong));
    fill(table, value);
    feel(value, part);
    others.textContent = value?.other_stitches ? othersInWords(value) : "";
    plain.textContent = value ? remarksOn(studio, part).note : "";
    source.hidden = !value;
    gauge.show();
    if (value) {
      const lines = [
        part.note,
        remarksOn(studio, part).note,
        ...value.notes,
        `90 % intervals: ${value.interval_source}`,
      ].filter(Boolean);
      name();
      notes.replaceChildren(...lines.map((note) => h("li", {}, note)));
    }
  };
  /** What a hand feels, and how wide the cloth lies. @param {PredictResult | null} value @param {Scope} part */
  const feel = (value, part) => {
    const pull = value?.hand.find((each) => each.pull === handPull.value);
    const size = value && sizeAtRest(part, value);
    narrow.show(value, handPull.value);
    felt.replaceChildren(
      columnHeads(),
      h(
        "tbody",
        {},
        row(
          "Stretch",
          "",
          "How far the cloth stretches from its size at rest when pulled along its rows or columns",
          ...DIRECTIONS.map((way) => {
            const of = pull?.[way];
            const ends = of ? `${percentRange(of.strain_interval)} %` : "";
            return cell(`hand-${way}`, of ? percent(of.strain) : "–", ends, of?.word);
          }),
        ),
        row(
          "Size, cm",
          "",
          "Width and height of the cloth when nothing pulls at it",
          ...DIRECTIONS.map((way) =>
            cell(`size-${way}`, figure(inCm(size?.[way].value)), range(size && cmOf(size[way].interval))),
          ),
        ),
      ),
    );
    rank.replaceChildren(
      ...(pull ? DIRECTIONS.map((way) => h("div", {}, `${capital(LINES[way])}: ${amongFabrics(pull[way])}`)) : []),
    );
    const lengths = FABRICS.flatMap((fabric) => studio.yarn?.fabrics[fabric]?.loop_length_mm ?? []);
    const [least, most] = [Math.min(...lengths), Math.max(...lengths)];
    compared.textContent =
      most > LOOP_SPREAD * least
        ? `The sizes of this yarn's fabrics do not compare: they were knitted with ${figure(least)} to ${figure(most)} mm of yarn a stitch.`
        : "";
  };
  handPull.listen(() => {
    const { value, busy } = studio.prediction.value;
    if (!busy) feel(value, scopeOf(studio));
  });
  const name = () => {
    const { value } = studio.prediction.value;
    provenance.textContent = `How sure? ${sourceInWords(value?.provenance ?? "")}${studio.relaxing.value ? ", relaxing …" : ""}`;
  };
  const count = () => {
    if (titled !== placeOf(studio)) return; // the numbers of that part come with its title
    const { document: chart } = studio;
    const { grid, mask } = scopeOf(studio).counted;
    const counted = countSegments(grid, mask);
    const mix = fabricShares(grid === chart.grid ? chart.codes : surroundings(grid, mask), mask);
    const rounded = percents(mix);
    shares.replaceChildren(
      shareBar(
        "share-fabrics",
        FABRICS.map((fabric, i) => ({ share: mix[i], colour: `var(--${fabric})`, text: `${fabric} ${rounded[i]}` })),
      ),
    );
    segments.replaceChildren(
      ...DIRECTIONS.map((direction) => {
        const { even, odd } = counted[direction];
        const all = even + odd || 1;
        return shareBar(
          `segments-${direction}`,
          [
            { share: even / all, colour: "var(--even)", text: `${even} even` },
            { share: odd / all, colour: "var(--odd)", text: `${odd} odd` },
          ],
          direction,
        );
      }),
    );
  };
  const countSoon = paced(count, COUNT_MS);
  studio.prediction.watch(show);
  studio.relaxing.listen(name);
  const offer = () => {
    const { regions } = studio.document;
    const { region } = studio.seeing;
    if (region.value !== null && !studio.document.region(region.value)) region.value = null;
    scopes.hidden = !regions.length;
    scopes.replaceChildren(
      h("option", { value: "" }, "Whole chart"),
      ...regions.map(({ id, name }) => h("option", { value: id }, name)),
    );
    scopes.value = region.value ?? "";
  };
  studio.document.onSettle(offer);
  studio.seeing.region.listen(offer);
  offer();
  studio.document.onChange(countSoon);
  count();
  studio.stretch.watch(({ value, stale, direction }) => {
    if (!value || stale) return;
    studio.seeing.pull.value = direction;
    choose("curve");
  });
  return () => {
    draw.rigidity();
    if (!curve.hidden) draw.curve();
  };
}

/** What the stitches are that are neither knit nor purl, and what they take. @param {PredictResult} value */
function othersInWords({ other_stitches: of, yarn_per_stitch_mm: yarn, yarn_per_stitch_interval_mm: ends }) {
  if (!of) return "";
  const shares = /** @type {const} */ ([
    [of.yarn_overs, "yarn overs"],
    [of.slips, "slipped"],
    [of.tucks, "tucked"],
  ])
    .filter(([share]) => share)
    .map(([share, name]) => `${percent(share)} ${name}`);
  const said = [
    shares.length && `Of its stitches ${shares.join(", ")}.`,
    of.crossings && `${figure(of.crossings)} crossings a stitch.`,
    yarn && `Yarn a stitch: ${figure(yarn)} mm${ends ? ` (${range(ends)})` : ""}.`,
    of.yarn_m && `In all: ${figure(of.yarn_m)} m${of.yarn_interval_m ? ` (${range(of.yarn_interval_m)})` : ""}.`,
    of.longest_float_mm && `Longest float: ${figure(of.longest_float_mm)} mm (${range(of.longest_float_interval_mm)}).`,
  ];
  return said.filter(Boolean).join(" ");
}

/** How a stretch compares with those of the yarn's own fabrics. @param {PredictResult["hand"][number]["course"]} stretch */
function amongFabrics({ more_than: more, less_than: less }) {
  const parts = [more.length && `more than ${inWords(more)}`, less.length && `less than ${inWords(less)}`];
  return `stretch ${parts.filter(Boolean).join(", ") || "as this yarn's other fabrics do"}.`;
}

/** @param {string} word */
const capital = (word) => word[0].toUpperCase() + word.slice(1);

/** @param {string[]} words */
const inWords = (words) =>
  words.length < 2 ? words.join("") : `${words.slice(0, -1).join(", ")} and ${words[words.length - 1]}`;

const columnHeads = () =>
  h(
    "thead",
    {},
    h(
      "tr",
      {},
      h("td", {}),
      ...DIRECTIONS.map((way) =>
        h("th", { scope: "col", title: `Pulled ${along(way)}` }, icon(way), capital(LINES[way])),
      ),
    ),
  );

/** @param {string} id @param {string} value @param {string} interval @param {string} [word] */
const cell = (id, value, interval, word) =>
  h(
    "td",
    { id },
    h("span", { class: "value" }, value),
    interval && h("span", { class: "interval", title: "90 % interval" }, interval),
    word && h("span", { class: "word" }, word),
  );

/** @param {string} label @param {string} unit @param {string} hint @param {HTMLElement[]} cells */
const row = (label, unit, hint, ...cells) =>
  h("tr", {}, h("th", { scope: "row", title: hint }, label, unit && h("span", { class: "unit" }, unit)), ...cells);

/** @param {HTMLTableElement} table @param {PredictResult | null} value */
function fill(table, value) {
  /** @param {string} id @param {number | undefined} number @param {readonly number[] | null | undefined} ends */
  const number = (id, number, ends) => cell(id, figure(number), range(ends));
  table.replaceChildren(
    columnHeads(),
    h(
      "tbody",
      {},
      row(
        "Stiffness",
        "N/mm",
        "Young's modulus at the beginning of a pull: force per width over stretch",
        number("modulus-course", value?.modulus_course_n_per_mm, value?.modulus_course_interval_n_per_mm),
        number("modulus-wale", value?.modulus_wale_n_per_mm, value?.modulus_wale_interval_n_per_mm),
      ),
      row(
        "Extensibility",
        "mm/N",
        "How far it gives: mm of stretch per newton, for a square of cloth (1 over its stiffness)",
        number(
          "extensibility-course",
          value?.extensibility_course_mm_per_n,
          inverse(value?.modulus_course_interval_n_per_mm),
        ),
        number(
          "extensibility-wale",
          value?.extensibility_wale_mm_per_n,
          inverse(value?.modulus_wale_interval_n_per_mm),
        ),
      ),
      row(
        "Poisson",
        "ratio",
        "Contraction across when pulled along",
        number("poisson-yx", value?.poisson_yx, value?.poisson_yx_interval),
        number("poisson-xy", value?.poisson_xy, value?.poisson_xy_interval),
      ),
    ),
  );
}

/** @param {number | undefined} mm */
const inCm = (mm) => (mm === undefined ? undefined : mm / 10);

/** @param {[number, number]} mm @returns {[number, number]} */
const cmOf = ([low, high]) => [low / 10, high / 10];

/** @param {[number, number] | null | undefined} interval @returns {[number, number] | null} */
function inverse(interval) {
  return interval ? [1 / interval[1], 1 / interval[0]] : null;
}

/**
 * A bar in parts, and below it their key.
 *
 * @param {string} id
 * @param {{share: number, colour: string, text: string}[]} parts
 * @param {Direction} [direction] of what is counted
 */
function shareBar(id, parts, direction) {
  const present = parts.filter(({ share }) => share > 0);
  const bar = h("div", { class: "bar flex clipped", "aria-hidden": "true" });
  const keys = present.map(({ share, colour, text }) => {
    const piece = h("span", {});
    piece.style.flexGrow = String(share);
    piece.style.backgroundColor = colour;
    bar.append(piece);
    const key = h("span", { class: "key" });
    key.style.backgroundColor = colour;
    return h("span", { class: "legend-item gap-5" }, key, text);
  });
  const title = direction ? `Segments ${along(direction)}` : "Shares of the four fabrics, by quarters of stitches";
  return h(
    "div",
    { class: direction ? "share counts" : "share", id, title },
    bar,
    h("div", { class: "share-text figures flex wrap small" }, direction && icon(direction), ...keys),
  );
}
