/**
 * Knit along: the row at hand large, in words and as it hangs on the needles, to be read at arm's length.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {Studio} from "../../state/studio.js"
 * @import {KnitAlongResult} from "../../types.js"
 */

import { loadSigns } from "../../chart/symbols.js";
import { loadSettings, saveSettings } from "../../design/store.js";
import { h } from "../../elements/dom.js";
import { Places, alongRequest, alongRows, repeatWords, resume, stepOf, waysOf } from "../../services/along.js";
import { Awake } from "../../services/awake.js";
import { knownMachines } from "../../services/machines.js";
import { iconButton, textButton } from "../../widgets/buttons.js";
import { dialog } from "../../widgets/dialog.js";
import { numberField } from "../../widgets/fields.js";
import { attempt } from "../../widgets/problem.js";
import { rowPicture } from "./picture.js";

/** How far a finger moves across for a step, px. */
const SWIPE = 48;

/** @param {string} text */
const capital = (text) => text.replace(/^(\W*)(\w)/, (_, before, letter) => before + letter.toUpperCase());

/** Where the place is kept, in words. */
const KEPT = {
  design: "Your place is kept with the design: another device goes on here.",
  browser: "Your place is kept in this browser.",
  nowhere: "This browser keeps nothing: note the row before you close the page.",
};

/** @param {Studio} studio @param {ActionContext} context */
export function create(studio, { keeper, open }) {
  /** @type {KnitAlongResult | null} */
  let along = null;
  let way = loadSettings({ along: studio.editing.round.value ? "round" : "flat" }).along;
  let place = { row: 0, count: 0 };
  const places = new Places(
    () => keeper.remoteId,
    (where) => (kept.textContent = KEPT[where]),
  );
  const awake = new Awake();

  const ways = h(
    "select",
    {
      class: "text-field shrinks-x rounded",
      "aria-label": "How it is knitted",
      onchange: () => {
        way = ways.value;
        saveSettings({ along: way });
        void load().then(() => along && go(place.row)); // this is the way of the piece from now on
      },
    },
    h("option", { value: way }, way),
  );
  const number = numberField({
    min: "1",
    inputMode: "numeric",
    onchange: () => {
      if (Number.isInteger(number.valueAsNumber)) go(number.valueAsNumber);
      else show();
    },
  });
  const bar = h("progress", { class: "full-width", "aria-label": "Rows knitted", max: 1, value: 0 });
  const heading = h("h3", { class: "along-row" });
  const side = h("p", { class: "along-side" });
  const repeat = h("p", { class: "along-repeat figures" });
  const picture = h("div", { class: "along-picture", tabIndex: 0, role: "group", "aria-label": "Picture of the row" });
  const words = h("div", { class: "along-words" });
  const next = h("p", { class: "along-after muted" });
  const row = h(
    "div",
    { class: "along-reading", "aria-live": "polite", "aria-atomic": "true" },
    heading,
    side,
    repeat,
    words,
  );
  const status = h("div", { class: "dialog-status", role: "status" });
  const count = h("output", { class: "figures", "aria-label": "Counted" });
  const kept = h("p", { class: "muted small" });
  const back = textButton(null, "Back", () => step(-1), { class: "button along-step", id: "along-back" });
  const forth = textButton(null, "Next row", () => step(1), {
    class: "button primary along-step",
    id: "along-next",
  });
  const counter = h(
    "div",
    { class: "along-counter line gap-8", role: "group", "aria-label": "A counter of your own" },
    h("span", {}, "Your counter"),
    iconButton("minus", "Count down", () => tally(place.count - 1)),
    count,
    iconButton("plus", "Count up", () => tally(place.count + 1)),
    textButton(null, "Set to 0", () => tally(0), { class: "button quiet" }),
  );
  const files = h(
    "div",
    { class: "line wrap gap-8" },
    textButton("export", "File from this row", fromHere, { class: "button quiet", id: "along-file" }),
    textButton(null, "Print all rows", print, { class: "button quiet" }),
  );
  const reading = h("div", { class: "along-main" }, row, picture, next, counter, kept, files);
  const paper = h("div", { class: "along-paper" });
  const element = dialog(
    "along-dialog",
    "Knit along",
    h(
      "div",
      { class: "along-tools line wrap gap-8" },
      ways,
      h("label", { class: "line gap-5 nowrap" }, "Go to row", number),
    ),
    bar,
    status,
    reading,
    h("div", { class: "along-steps" }, back, forth),
    paper,
  );

  const piece = () => `${studio.designId} ${way}`;
  const last = () => (along?.rows.length ?? 0) + 1;

  /** @param {number} to 0 before the first row, one more than the rows after the last */
  function go(to) {
    place = { ...place, row: Math.min(Math.max(to, 0), last()) };
    places.save(piece(), way, place);
    show();
  }

  /** @param {number} by */
  const step = (by) => along && go(by === -Infinity ? 0 : by === Infinity ? last() : place.row + by);

  /** @param {number} to */
  function tally(to) {
    place = { ...place, count: Math.max(to, 0) };
    places.save(piece(), way, place);
    count.value = String(place.count);
  }

  async function load() {
    const chosen = piece();
    ways.value = way;
    reading.hidden = true;
    const rows = await attempt(status, () => alongRows(alongRequest(studio, way)), load);
    if (chosen !== piece()) return; // another way was chosen meanwhile
    along = rows;
    if (along?.rows.some(({ codes }) => codes?.length)) await loadSigns();
    await look();
    forth.disabled = back.disabled = !along;
    reading.hidden = !along;
    if (along) show();
  }

  /** Go to where the piece is by now: another device may have gone on. */
  async function look() {
    const chosen = piece();
    const latest = await places.load(chosen, way);
    if (chosen !== piece()) return;
    place = { ...latest, row: Math.min(latest.row, last()) }; // the design may have lost rows since
    count.value = String(place.count);
    show();
  }

  /** A program or a plan that begins with the row at hand. */
  function fromHere() {
    resume.row = Math.min(Math.max(place.row, 1), along?.rows.length ?? 1);
    element.close();
    open("exports");
  }

  async function offerWays() {
    const machines = (await attempt(status, knownMachines, offerWays)) ?? [];
    const words = waysOf(machines, studio.machine.value);
    const latest = await places.lastWay();
    if (latest in words) way = latest;
    if (!(way in words)) way = "flat";
    ways.replaceChildren(...Object.entries(words).map(([value, name]) => h("option", { value }, name)));
    await load();
  }

  function show() {
    if (!along) return;
    const { rows, opening, closing, notes, round, repeat_rows } = along;
    const name = round ? "Round" : "Row";
    const index = place.row - 1;
    const worked = rows[index];
    bar.max = last();
    bar.value = place.row;
    number.max = String(rows.length);
    number.value = worked ? String(place.row) : "";
    heading.textContent = worked
      ? `${name} ${place.row} of ${rows.length}`
      : index < 0
        ? "Before row 1"
        : "After the last row";
    side.textContent = worked ? sideOf(worked) : "";
    repeat.textContent = worked ? repeatWords(place.row, rows.length, repeat_rows) : "";
    const lines = worked ? worked.words : index < 0 ? opening : closing;
    words.replaceChildren(...lines.map((line) => h("p", {}, capital(line))), ...(index < 0 ? notes.map(remarkOf) : []));
    picture.hidden = !worked;
    if (worked) {
      const { marked, needles } = along;
      const isMarked = needles.length > 0 && worked.stitches.includes("P");
      picture.replaceChildren(
        rowPicture(along, index, studio.editing.symbols.value, picture.clientWidth),
        isMarked ? h("p", { class: "small" }, h("span", { class: "along-marked" }), marked) : "",
      );
      picture.scrollLeft = worked.leftwards ? picture.scrollWidth : 0;
    }
    const then = rows[place.row];
    next.textContent = then && worked ? `Then ${name.toLowerCase()} ${then.number}: ${then.words.join(" ")}` : "";
    const focused = document.activeElement;
    back.disabled = place.row === 0;
    forth.disabled = place.row === last();
    if (focused === forth && forth.disabled) back.focus(); // keys go on being heard
    if (focused === back && back.disabled) forth.focus();
    forth.textContent = then ? `${name} ${then.number}` : "Finish";
  }

  /** @param {KnitAlongResult["rows"][number]} worked */
  const sideOf = ({ heading: words, leftwards }) =>
    along?.needles.length
      ? `${capital(words)}, goes to the ${leftwards ? "left\u00a0←" : "right\u00a0→"}`
      : capital(words);

  /** @param {string} text */
  const remarkOf = (text) => h("p", { class: "muted small" }, text);

  function print() {
    if (!along) return;
    const name = along.round ? "Round" : "Row";
    paper.replaceChildren(
      h("h2", {}, studio.name.value),
      ...[...along.opening, ...along.notes].map((line) => h("p", {}, line)),
      ...along.rows.map((each) =>
        h("p", {}, `☐ ${name} ${each.number}${each.heading ? ` (${each.heading})` : ""}: ${each.words.join(" ")}`),
      ),
      ...along.closing.map((line) => h("p", {}, line)),
    );
    window.print();
    paper.replaceChildren();
  }

  element.addEventListener("keydown", (event) => {
    const { target, key, ctrlKey, metaKey, altKey } = event;
    const by = stepOf(key);
    if (!by || ctrlKey || metaKey || altKey || event.defaultPrevented) return;
    if (target instanceof HTMLInputElement || target instanceof HTMLSelectElement) return;
    if (target instanceof HTMLButtonElement && (key === " " || key === "Enter")) return; // it is pressed
    if (target === picture && key.startsWith("Arrow")) return; // it is scrolled
    event.preventDefault();
    step(by);
  });
  /** Where a finger came down. @type {{x: number, y: number} | null} */
  let down = null;
  row.addEventListener("pointerdown", ({ pointerType, clientX: x, clientY: y }) => {
    down = pointerType === "mouse" ? null : { x, y };
  });
  row.addEventListener("pointerup", ({ clientX, clientY }) => {
    if (!down) return;
    const [across, up] = [clientX - down.x, clientY - down.y];
    down = null;
    if (Math.abs(across) > SWIPE && Math.abs(across) > 2 * Math.abs(up)) step(across < 0 ? 1 : -1);
  });
  element.addEventListener("close", () => void awake.release());
  document.addEventListener("visibilitychange", () => {
    if (along && element.open && document.visibilityState === "visible") void look();
  });
  new ResizeObserver(() => show()).observe(element);

  return () => {
    element.showModal();
    forth.focus();
    void offerWays();
    void awake.keep().then((on) => {
      element.dataset.awake = String(on);
    });
  };
}
