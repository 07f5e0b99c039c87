/**
 * The fabric in 3D: the service's viewer in a frame, kept in step with the chart. At most one request
 * is under way; of the changes meanwhile only the last is sent.
 *
 * @import {ChartView} from "../../chart/view.js"
 * @import {Studio} from "../../state/studio.js"
 * @import {CameraSide, ViewRequest} from "../../types.js"
 */

import { ApiError, api } from "../../api.js";
import { OVERLAYS, atRest, fabricKey, scale, shownOverlay, swatches } from "../../state/overlays.js";
import { onTheme, readPalette } from "../../state/palette.js";
import { along } from "../../core/directions.js";
import { batlow } from "../../state/colormaps.js";
import { h, nextTask } from "../../elements/dom.js";
import { icon } from "../../elements/icons.js";
import { ViewLink } from "./link.js";
import { Still } from "./still.js";
import { toolbar } from "./toolbar.js";
import { pieceOf } from "../../services/scope.js";
import { POSES, wordsOf } from "../../state/seeing.js";
import { REST } from "../../state/studio.js";
import { legendOf } from "../../widgets/legend.js";
import { problemText } from "../../widgets/problem.js";

/** Delay before the 3D view updates: without a GPU, drawing can block painting. */
const DELAY_MS = 650;
/** After a stroke another one often follows. */
const BETWEEN_STROKES_MS = 600;
/** A frame whose page did not come is loaded again after this time. */
const RELOAD_MS = 2500;
/** Most stitches that the service draws as yarn; of larger charts it draws a part. */
const MAX_DRAWN = 40_000;

const BLIND = {
  type: "browser",
  status: 0,
  title: "A picture of the fabric, which cannot be turned",
  detail: "This browser draws nothing in 3D: it has no WebGL 2.",
  remedy: "Allow it graphics acceleration, or use another one. Chart, numbers and stretch test work all the same.",
};

/**
 * @param {HTMLElement} host
 * @param {Studio} studio
 * @param {ChartView} view
 * @returns {() => void} sends the design again, for a service that has forgotten it
 */
export function fabricview(host, studio, view) {
  const frame = h("iframe", { title: "Fabric in 3D", class: "fabric-frame full-width", tabIndex: 0 });
  // Without our origin it may have a process of its own; then its frames do not keep the page waiting.
  frame.setAttribute("sandbox", "allow-scripts");
  const status = h("div", { class: "fabric-status raised line rounded gap-10", role: "status" });
  const caption = h("div", { class: "fabric-caption small", "data-result": "fabric" });
  const still = new Still(frame);
  const drawing = { slow: false, held: false };
  /** @param {{pass: string} | {hold: boolean} | {ink: string}} message */
  const tellFrame = (message) => frame.contentWindow?.postMessage(message, "*");
  const tellInk = () => tellFrame({ ink: getComputedStyle(host).color });
  /** Let its frames wait, or go on. @param {boolean} held */
  const hold = (held) => {
    if (drawing.held === held) return;
    drawing.held = held;
    tellFrame({ hold: held });
  };
  const link = new ViewLink(studio, view, {
    lost: () => {
      sent = "";
      now();
    },
    slow: () => drawing.slow,
  });

  /** @param {CameraSide} side */
  const look = async (side) => {
    try {
      await api.look(studio.designId, side);
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      studio.tellProblem(error.problem);
    }
  };

  /** Whether the view's page runs in the frame. */
  let loaded = false;
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let reloading;
  const reload = () => {
    if (shown && !loaded) frame.src = shown;
  };
  frame.addEventListener("load", () => {
    if (shown) reloading = setTimeout(reload, RELOAD_MS); // the browser's own page about a failure loads, too
  });
  /** The browser draws nothing in 3D. */
  let blind = false;
  addEventListener("message", ({ source, data }) => {
    if (source !== frame.contentWindow) return;
    if (data.view === "loaded") {
      loaded = true;
      blind = false;
      tellFrame({ hold: drawing.held });
      tellInk();
      if (pass) tellFrame({ pass });
    }
    if (data.view === "seen") knitted();
    if (data.view === "none") {
      blind = true;
      status.replaceChildren(icon("warning"), problemText(BLIND));
    }
    if (typeof data.slow === "boolean") drawing.slow = data.slow;
  });
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let holding;
  const release = () => {
    clearTimeout(holding);
    if (studio.document.painting) holding = setTimeout(release, BETWEEN_STROKES_MS);
    else hold(false);
  };
  studio.document.onChange(() => {
    hold(true);
    clearTimeout(holding);
    holding = setTimeout(release, BETWEEN_STROKES_MS);
  });

  let sending = false;
  let again = false;
  /** What the service shows. */
  let sent = "";
  /** Address of the view in the frame, and what lets the frame watch it. */
  let shown = "";
  let pass = "";
  let source = "";
  /** @type {ReturnType<typeof setTimeout> | undefined} */
  let timer;

  const request = () => viewRequest(studio, view);
  host.replaceChildren(
    frame,
    still.root,
    caption,
    toolbar(studio, (side) => void look(side), request),
    status,
  );

  let problem = false;
  let live = false;
  /** @param {boolean} now */
  const setLive = (now) => {
    live = now;
    host.toggleAttribute("data-live", live);
  };
  /** The live view shows the cloth. */
  const knitted = () => {
    setLive(true);
    still.clear();
    if (!problem) status.replaceChildren();
  };
  /** Until it does, or always where it cannot, a picture stands in for it. */
  const beStill = () => {
    setLive(false);
    void still.draw(request(), () => {
      if (!problem && !blind) status.replaceChildren();
    });
  };
  /** @param {string} url */
  const open = (url) => {
    if (shown === url) return;
    shown = url;
    pass = "";
    sent = "";
    [confirmed, confirmedColours] = ["", null]; // of another design
    describe();
    setLive(false);
    status.replaceChildren(h("span", { class: "spinner" }), "Knitting …");
    still.clear();
    clearTimeout(reloading);
    loaded = false;
    frame.src = url;
    link.disconnect();
  };
  const send = async () => {
    if (sending) {
      again = true;
      return;
    }
    open(`/view/${encodeURIComponent(studio.designId)}/`); // it loads while the scene is being made
    const scene = request();
    const sceneWords = words();
    const sceneColours = coloursOf(studio);
    const text = JSON.stringify(scene);
    const until = changes;
    if (text === sent) {
      [confirmed, confirmedColours, changesShown] = [sceneWords, sceneColours, until];
      return describe();
    }
    sending = true;
    host.toggleAttribute("data-sending", true);
    if (!live) beStill();
    await nextTask();
    try {
      sent = "";
      const answer = await api.view(studio.designId, scene);
      sent = text;
      if (problem) status.replaceChildren();
      problem = false;
      source = answer.source;
      [confirmed, confirmedColours, changesShown] = [sceneWords, sceneColours, until];
      describe();
      studio.online.value = true;
      pass = answer.url.slice(answer.url.indexOf("#") + 1);
      tellFrame({ pass });
      link.connect();
    } catch (error) {
      if (!(error instanceof ApiError)) throw error;
      if (error.offline) {
        studio.online.value = false;
        status.replaceChildren(); // the banner over the cloth says why nothing comes
        describe();
        return;
      }
      const { field } = error.problem;
      if (field === "chart" && scene.chart !== studio.document.grid.text) {
        refusedChart = String(scene.chart);
        again = true;
        return;
      }
      if (field === "curl.id" && studio.seeing.posed.value) {
        const { pose, curling } = studio.seeing;
        const forgotten = { pose: pose.value, curling: curling.value }; // by a restarted service
        [pose.value, curling.value] = ["flat", false];
        [pose.value, curling.value] = [forgotten.pose, forgotten.curling];
        return;
      }
      const id = field === "stretch.id" ? (studio.currentStretch()?.id ?? null) : null;
      if (id !== null) {
        status.replaceChildren(h("span", { class: "spinner" }), "Pulling the cloth once more …");
        studio.seeing.forgotten.value = id; // it is run again, and then sent again
        return;
      }
      problem = true;
      describe();
      status.replaceChildren(icon("warning"), problemText(error.problem));
    } finally {
      sending = false;
      host.toggleAttribute("data-sending", false);
      if (again) {
        again = false;
        void send();
      }
    }
  };
  /** How often something changed that the view shows, and up to which change it shows it. */
  let changes = 0;
  let changesShown = 0;
  const soon = () => {
    outdate();
    clearTimeout(timer);
    timer = setTimeout(() => {
      if (studio.document.painting) soon();
      else void send();
    }, DELAY_MS);
  };
  const now = () => {
    outdate();
    clearTimeout(timer);
    void send();
  };
  const outdate = () => {
    changes += 1;
    caption.toggleAttribute("data-stale", confirmed !== "");
  };

  /** What the cloth on show is: it keeps that until another one is there. */
  let confirmed = "";
  let confirmedColours = coloursOf(studio);
  const words = () => {
    const strain = studio.seeing.pose.value !== "flat" ? 0 : studio.currentStrain();
    const plain = studio.document.others.size && stitchesShown(studio) === studio.document.grid.text;
    return `${
      strain && !studio.seeing.posed.value
        ? `Stretched ${along(studio.stretchDirection())} by ${(100 * strain).toFixed(0)} %`
        : poseText(studio)
    }${plain ? ": the knits and purls of the chart alone" : ""}`;
  };
  const describe = () => {
    const stale = changes !== changesShown && confirmed !== "";
    const left = stale && (problem || !studio.online.value); // no other one will come for now
    caption.toggleAttribute("data-stale", stale);
    host.toggleAttribute("data-left", left);
    const { pressure } = (!stale && studio.seeing.posed.value) || {};
    caption.replaceChildren(
      pressure?.warning ? tooTight(pressure.warning) : "",
      confirmedColours
        ? h("div", { class: "fabric-legend line small", id: "fabric-legend" }, ...legendOf(confirmedColours))
        : "",
      stale ? `${confirmed}${left ? ", before the change" : ""}` : words(),
      h("span", { class: "spinner caption-spinner", title: "The cloth is being made anew" }),
    );
    caption.title = studio.seeing.posed.value?.note ?? (source && `Yarn: ${source}`);
  };

  studio.document.onChange(soon);
  const { yarnColours, groups, block, pose, posed } = studio.seeing;
  for (const signal of [
    studio.materialId,
    studio.gauges.changes,
    studio.overlay,
    studio.rectangles,
    studio.stretch,
    groups,
    block,
  ]) {
    signal.listen(soon);
  }
  yarnColours.listen(now);
  let form = posed.value?.id;
  posed.listen((shape) => {
    const same = shape?.id === form; // it waits for the next one: sent now, it would hold that up
    form = shape?.id;
    if (!same) now();
    if (shape && !same && !drawing.slow) release();
    describe();
  });
  pose.listen(() => {
    now();
    describe();
  });
  studio.step.listen(now);
  onTheme(() => {
    tellInk();
    soon();
  });
  studio.stretch.watch(describe);
  studio.step.listen(describe);
  void nextTask().then(now);
  return () => {
    shown = ""; // a restarted service has new scenes, so the frame must connect anew
    const test = pulled(studio);
    if (test)
      studio.seeing.forgotten.value = test.id; // it is run again, and then sent
    else now();
  };
}

/** What the colours of the cloth mean; null for those of its yarn. @param {Studio} studio */
function coloursOf(studio) {
  const { posed } = studio.seeing;
  const colour = posed.value?.piece ? "yarn" : colourOf(studio);
  const palette = readPalette();
  if (colour === "pressure") {
    const { most = 0, limit } = posed.value?.pressure ?? {};
    return most ? { ...scale(batlow, [0, most], "mmHg at most", "Pressure"), limit } : null;
  }
  if (colour === "fabric" || colour === "phase") return fabricKey(palette);
  if (colour === "region") {
    const shown = studio.document.regions.filter(({ hidden, count }) => !hidden && count);
    return swatches(...shown.map(({ name, colour }) => /** @type {[string, string]} */ ([name, colour])));
  }
  return colour === "yarn" ? null : (OVERLAYS.find(({ view }) => view === colour)?.legend(studio, palette) ?? null);
}

/** What colours the stitches of the view. @param {Studio} studio */
function colourOf(studio) {
  const { yarnColours, posed } = studio.seeing;
  if (yarnColours.value !== "chart") return yarnColours.value;
  if (posed.value?.pose === "worn") return "pressure";
  const overlay = shownOverlay(studio);
  return (!posed.value && pulled(studio) ? overlay : atRest(overlay)).view;
}

/** What the view is to show. @param {Studio} studio @param {ChartView} view @returns {ViewRequest} */
export function viewRequest(studio, view) {
  const { document: chart, seeing } = studio;
  const posed = seeing.posed.value;
  const stretch = posed ? null : pulled(studio);
  const colour = colourOf(studio);
  const byRegion = ["yarn", "region"].includes(colour) || (studio.rectangles.value && seeing.groups.value === "region");
  const { rows, columns } = chart.grid;
  const { written: palette } = readPalette();
  const seen = view.viewport.visible(chart.grid);
  if (posed?.piece) {
    return { material: studio.materialId.value, ...posed.piece, colour: "yarn", palette, curl: { id: posed.id } };
  }
  return {
    ...pieceOf(studio),
    ...(chart.others.size && { chart: stitchesShown(studio) }),
    colour: /** @type {ViewRequest["colour"]} */ (colour),
    palette,
    regions: byRegion ? chart.regions.map((region) => region.written(columns)) : [],
    rectangles: studio.rectangles.value,
    rectangle_groups: seeing.groups.value,
    rectangle_block: seeing.block.value,
    stretch: stretch && studio.step.value !== REST ? { id: stretch.id, step: studio.step.value } : null,
    curl: posed && { id: posed.id },
    focus:
      rows * columns > MAX_DRAWN
        ? { row: (seen.row0 + seen.row1) >> 1, column: (seen.column0 + seen.column1) >> 1 }
        : null,
  };
}

/** A chart of any stitches that the service did not draw: its knits and purls are shown. */
let refusedChart = "";

/** The stitches that the view draws: all where the cloth lies flat, its knits and purls where it is pulled or posed. @param {Studio} studio @returns {string} */
function stitchesShown(studio) {
  const { document: chart, seeing, balance } = studio;
  const lies = seeing.pose.value === "flat" && !studio.currentStrain() && !chart.shaped && !balance.value.length;
  const codes = chart.others.size && lies ? chart.text : "";
  return codes && codes !== refusedChart ? codes : chart.grid.text;
}

/** The test that is shown: none while the fabric is shown in another pose, or the test is run again. @param {Studio} studio */
function pulled(studio) {
  const { pose, forgotten } = studio.seeing;
  const test = pose.value === "flat" ? studio.currentStretch() : null;
  return test?.id === forgotten.value ? null : test;
}

/** How the fabric that nobody pulls is shown. @param {Studio} studio */
function poseText(studio) {
  const { pose, posed } = studio.seeing;
  const { value } = pose;
  if (posed.value) return wordsOf(posed.value);
  if (value === "flat") return "Relaxed, pinned flat";
  return `${POSES[value]}: being computed`;
}

/** That a garment presses too much; why that matters is folded, so that the cloth keeps its room. @param {string} warning */
function tooTight(warning) {
  const [much, ...why] = warning.split(/(?<=\.) /);
  const folded = h("details", {}, h("summary", {}, h("strong", {}, much)), why.join(" "));
  return h("div", { class: "problem-text", role: "alert" }, folded);
}
