/**
 * The stretch test: pull the chart between two clamps, then go through the steps.
 *
 * @import {Studio} from "../state/studio.js"
 * @import {Stretcher} from "../services/stretcher.js"
 * @import {Direction, Problem} from "../types.js"
 */

import { withKey } from "../core/pointing.js";
import { along } from "../core/directions.js";
import { figure, percent, percentRange, spread, thousands } from "../core/format.js";
import { lockUpInWords } from "../core/striptest.js";
import { h } from "../elements/dom.js";
import { REST } from "../state/studio.js";
import { plainWords } from "../services/stitches.js";
import { icon } from "../elements/icons.js";
import { iconButton, verb } from "../widgets/buttons.js";
import { numberField, segmented, selectField } from "../widgets/fields.js";

/** @typedef {"%" | "N"} Unit of a pull */

/** What the field says in each unit at first. */
const DEFAULTS = { "%": "30", N: "2" };
/** What the service pulls at most. */
const MOST = { "%": 500, N: 10_000 };

/** @param {HTMLElement} host @param {Studio} studio @param {Stretcher} stretcher */
export function stretchdrawer(host, studio, stretcher) {
  /** @type {Direction} */
  let direction = "wale";
  const choices = segmented(
    "Direction of the pull",
    [
      ["course", [icon("course"), "Rows"], { id: "stretch-course", title: `Pull ${along("course")}` }],
      ["wale", [icon("wale"), "Columns"], { id: "stretch-wale", title: `Pull ${along("wale")}` }],
    ],
    direction,
    (way) => (direction = /** @type {Direction} */ (way)),
  );

  const amount = numberField({
    id: "stretch-amount",
    min: "1",
    step: "1",
    value: "30",
    "aria-label": "How far or how hard to pull",
    onkeydown: (/** @type {KeyboardEvent} */ { key }) => {
      if (key === "Enter") start(); // returning false would keep every other key from the field
    },
  });
  const unit = selectField(
    {
      class: "chip-select",
      id: "stretch-unit",
      "aria-label": "Unit of the pull",
      onchange: () => (amount.value = DEFAULTS[/** @type {Unit} */ (unit.value)]),
    },
    { "%": "%", N: "N" },
  );
  const start = () => {
    const pull = Number(amount.value);
    const toForce = unit.value === "N";
    const most = MOST[toForce ? "N" : "%"];
    if (!(pull > 0 && pull <= most)) {
      studio.tellProblem({
        type: "input",
        status: 422,
        title: toForce ? `Enter a force of up to ${thousands(most)} N` : `Enter a stretch of up to ${most} %`,
        detail: "",
        remedy: `For example ${DEFAULTS[toForce ? "N" : "%"]}.`,
      });
      amount.focus();
      return;
    }
    const shear = Number(options.shear.value);
    const how = {
      clamps: /** @type {"clamped" | "sliding"} */ (options.clamps.value),
      model: /** @type {"full" | "published"} */ (options.model.value),
      shear_modulus_n_per_mm: shear > 0 ? shear : null,
    };
    void stretcher.run(direction, toForce ? { force_n: pull } : { strain: pull / 100 }, how);
  };
  /** @param {number} most @param {Unit} of */
  const pullBy = (most, of) => {
    unit.value = of;
    amount.value = String(most);
    start();
  };
  const run = h("button", {
    class: "button primary",
    id: "stretch-run",
    onclick: () => (studio.stretch.value.busy ? stretcher.cancel() : start()),
  });
  const done = h("span");
  const progress = h(
    "div",
    { class: "progress clipped", role: "progressbar", "aria-label": "Stretch test", hidden: true },
    done,
  );
  const options = stretchOptions(studio);
  const save = iconButton(
    "export",
    "Save the test as a table (CSV)",
    () => void import("../services/exporter.js").then(({ exportStretch }) => exportStretch(studio)),
    { id: "stretch-save" },
  );
  const note = h("div", { class: "stretch-note gap-6 small muted", role: "status", id: "stretch-note" });

  const play = h("button", {
    class: "button icon-only",
    id: "stretch-play",
    onclick: () => (stretcher.playing ? stretcher.pause() : stretcher.play()),
  });
  const slider = h("input", {
    type: "range",
    class: "slider grows",
    id: "stretch-slider",
    min: String(REST),
    max: "0",
    value: "0",
    "aria-label": "Step of the stretch",
    oninput: () => {
      stretcher.pause();
      studio.step.value = Number(slider.value);
    },
  });
  const figures = h("dl", { class: "stretch-figures figures stack gap-2", id: "stretch-figures" });
  const player = h("div", { class: "player line gap-12" }, play, slider, figures, save);
  stretcher.belonging.marks(player, "stretch");

  const fold = h("button", {
    class: "stretch-fold bare line gap-6",
    id: "stretch-fold",
    onclick: () => folded(host.dataset.folded === undefined),
  });
  /** On small screens the drawer is closed until it is needed. @param {boolean} closed */
  const folded = (closed) => {
    host.toggleAttribute("data-folded", closed);
    fold.ariaExpanded = String(!closed);
    fold.replaceChildren(h("h2", {}, "Stretch test"), icon(closed ? "up" : "down"));
  };
  folded(matchMedia("(max-width: 900px)").matches);

  host.append(
    h(
      "div",
      { class: "stretch-set line gap-10" },
      h("h2", { class: "stretch-title" }, "Stretch test"),
      fold,
      choices.element,
      h("div", { class: "line gap-6" }, amount, unit),
      options.element,
      run,
    ),
    progress,
    note,
    player,
  );

  const showStep = () => {
    const { value } = studio.stretch.value;
    const i = studio.step.value;
    slider.value = String(value ? i : REST);
    if (!value) return figures.replaceChildren();
    if (i === REST) {
      slider.setAttribute("aria-valuetext", "unstretched");
      figures.replaceChildren(h("div", {}, h("dt", {}, "Unstretched"), h("dd", {}, "in the clamps")));
      return;
    }
    slider.setAttribute("aria-valuetext", `stretched by ${percent(value.strain[i])}`);
    const at = (/** @type {number[]} */ ends) => ends[i];
    const [low, high] = value.force_interval_n.map(at);
    const widths = value.stress_n_per_mm[i] / value.force_n[i];
    /** @param {string} term @param {string} text @param {string} hint @param {string} [interval] */
    const pair = (term, text, hint, interval) =>
      h(
        "div",
        { title: hint },
        h("dt", {}, term),
        h(
          "dd",
          {},
          text,
          interval && h("span", { class: "interval", title: `90 % interval: ${value.interval_source}` }, interval),
        ),
      );
    figures.replaceChildren(
      pair("Stretch", percent(value.strain[i]), "Clamp to clamp, along the pull"),
      pair("Force", `${figure(value.force_n[i])} N`, "On the clamp, for this many stitches", spread([low, high]).text),
      pair(
        "Stress",
        `${figure(value.stress_n_per_mm[i])} N/mm`,
        "Force per relaxed width",
        spread([widths * low, widths * high]).text,
      ),
      pair(
        "Waist",
        percent(value.waist_strain[i], 1),
        "Change of width half way between the clamps",
        percentRange(value.waist_strain_interval.map(at), 1),
      ),
    );
  };
  const show = () => {
    const { value, busy, stale, problem } = studio.stretch.value;
    run.replaceChildren(...(busy ? [icon("stop"), "Cancel"] : [icon(direction), "Stretch"]));
    run.title = busy ? withKey("Cancel the test", "J") : withKey("Pull the chart between two clamps", "J");
    run.classList.toggle("primary", !busy);
    progress.hidden = !busy;
    const current = value !== null && !stale;
    player.classList.toggle("idle", !current);
    slider.disabled = play.disabled = save.disabled = !current;
    if (value) slider.max = String(value.strain.length - 1);
    showStep();
    note.className = `stretch-note gap-6 small muted ${problem ? "error" : ""}`;
    note.replaceChildren();
    if (problem) {
      note.append(icon("warning"), refused(problem, pullBy));
    } else if (busy) note.append(waiting() ? "Waiting for its turn …" : "Pulling the cloth between two clamps …");
    else if (value && stale) note.append(`${stale}. Pull again to see what it does now.`);
    else if (value) {
      const outcome = value.converged
        ? `Simulated strip test in ${value.seconds.toFixed(1)} s; not a certified test.`
        : `Stopped early at ${percent(value.strain[value.strain.length - 1] ?? 0)}.`;
      const lockUp = lockUpInWords(value);
      const rest = ` ${[outcome, ...(value.messages ?? [])].join(" ")}`;
      const warned = value.first_taut && h("span", { class: "warned" }, icon("warning"), lockUp);
      note.append(h("span", {}, warned ?? lockUp, rest));
    } else note.append("Pull the chart along its rows or columns and see where it gives.");
    const plain = plainWords(studio, "The test");
    if (plain && !problem) note.append(h("span", {}, ` ${plain}`));
    host.classList.toggle("busy", busy);
    if (busy) folded(false);
  };
  const waiting = () => stretcher.progress.value === null;
  let plainSaid = false;
  studio.document.onSettle(() => {
    const others = studio.document.others.size > 0;
    if (others !== plainSaid) show();
    plainSaid = others;
  });
  studio.stretch.watch(show);
  studio.step.listen(showStep);
  stretcher.progress.watch((share) => {
    progress.classList.toggle("open-ended", !share);
    done.style.width = share ? `${Math.round(100 * share)}%` : "";
    if (share) progress.setAttribute("aria-valuenow", String(Math.round(100 * share)));
    else progress.removeAttribute("aria-valuenow");
    if (studio.stretch.value.busy) show();
  });
  stretcher.onPlay(() => {
    play.replaceChildren(icon(stretcher.playing ? "pause" : "play"));
    play.setAttribute("aria-label", stretcher.playing ? "Pause" : "Play the stretch");
    play.title = stretcher.playing ? withKey("Pause", "Shift+J") : withKey("Play the stretch", "Shift+J");
  });
  stretcher.pause();
}

/** How the ends are held, what is computed and shown; the usual choice is made. @param {Studio} studio */
function stretchOptions(studio) {
  const clamps = selectField(
    { class: "select shrinks-x", id: "stretch-clamps" },
    {
      clamped: "gripped",
      sliding: "free to slide sideways",
    },
  );
  const model = selectField(
    { class: "select shrinks-x", id: "stretch-model" },
    {
      full: "runs out of stretch, as yarn does",
      published: "as published, never runs out",
    },
  );
  const shear = numberField({ id: "stretch-shear", min: "0.0001", max: "10", step: "0.001", placeholder: "unknown" });
  const curling = h("input", {
    type: "checkbox",
    id: "stretch-curling",
    onchange: () => (studio.seeing.curling.value = curling.checked),
  });
  studio.seeing.curling.watch((on) => (curling.checked = on));
  /** @param {string} text @param {HTMLElement} field */
  const row = (text, field, unit = "") =>
    h("label", { class: "stack gap-8" }, h("span", {}, text), field, unit && h("span", { class: "muted" }, unit));
  const panel = h(
    "div",
    { class: "stretch-options raised rounded shadowed", id: "stretch-options", popover: "auto" },
    row("Ends", clamps),
    row("Free edges curl in 3D", curling),
    h(
      "details",
      {},
      h("summary", {}, "For engineers"),
      row("Law", model),
      row("Shear modulus", shear, "N/mm"),
      h("p", { class: "muted small" }, "Leave the shear modulus empty unless you have measured it."),
    ),
  );
  const button = h(
    "button",
    {
      class: "button quiet",
      id: "stretch-more",
      title: "How the ends are held, and what is computed",
      popoverTargetElement: panel,
      onclick: () => {
        const { left, top } = button.getBoundingClientRect();
        panel.style.left = `min(${left}px, 100vw - 328px)`; // 320 px wide
        panel.style.bottom = `${innerHeight - top + 6}px`;
      },
    },
    "Options",
    icon("down"),
  );
  return { clamps, model, shear, element: h("div", {}, button, panel) };
}

/**
 * What is wrong with a test that was refused; the largest pull in the unit in which it was entered.
 *
 * @param {Problem} problem
 * @param {(most: number, unit: Unit) => void} pull
 */
function refused({ type, title, detail, remedy, field, most }, pull) {
  // The banner says the rest.
  if (type === "offline") return h("span", {}, "No test without the service: pull again when it is back.");
  if (!most || (field !== "strain" && field !== "force_n")) {
    return h("span", {}, h("strong", {}, title), `: ${detail} ${remedy ?? ""}`);
  }
  /** @type {Unit} */
  const unit = field === "strain" ? "%" : "N";
  const amount = unit === "%" ? Math.floor(100 * most + 1e-9) : most;
  return h(
    "span",
    {},
    h("strong", {}, unit === "%" ? "Too far" : "Too hard"),
    `: the first stitches run out of stretch before that. Use at most ${amount} ${unit}. `,
    verb(`Pull by ${amount} ${unit}`, () => pull(amount, unit), { id: "stretch-most" }),
  );
}
