/** Puts the page together in small asynchronous steps, so that the browser stays responsive. */

import { listenToKeys } from "./actions/registry.js";
import { ApiError, api } from "./api.js";
import { Painter } from "./chart/painter.js";
import { isDark, onTheme } from "./state/palette.js";
import { ChartView } from "./chart/view.js";
import { ChartDocument } from "./design/document.js";
import { exampleGrid } from "./grid/example.js";
import { Ink } from "./design/ink.js";
import { Latest } from "./services/latest.js";
import { isChartText, motifGrid } from "./grid/grid.js";
import { loadDesign, loadHistory, newIdentifier, saveSettings } from "./design/store.js";
import { byId, firstPaint, isTyping, nextTask } from "./elements/dom.js";
import { openAddressed } from "./sync/address.js";
import { Keeper } from "./sync/keeper.js";
import { fabricview } from "./panels/fabric/fabricview.js";
import { panelOpener } from "./panels/registry.js";
import { chartstrip } from "./panels/chart/chartstrip.js";
import { messages } from "./widgets/messages.js";
import { overlaybar } from "./panels/chart/overlaybar.js";
import { rail } from "./panels/chart/rail.js";
import { shelf } from "./panels/chart/shelf.js";
import { split } from "./widgets/split.js";
import { stretchdrawer } from "./panels/stretchdrawer.js";
import { offerTour, topbar } from "./panels/topbar.js";
import { watchConnection } from "./services/connection.js";
import { startPredictor } from "./services/predictor.js";
import { Stretcher } from "./services/stretcher.js";
import { Studio } from "./state/studio.js";

const FIRST_MATERIAL = "acrylic";
/** How far the example is stretched on a first visit. */
const FIRST_STRAIN = 0.3;

const kept = loadDesign();
const chart = kept ? ChartDocument.read(kept, loadHistory()) : new ChartDocument(exampleGrid());
const studio = new Studio(chart, kept ?? { id: newIdentifier(), name: "First swatch", material: FIRST_MATERIAL });

const view = new ChartView(byId("chart-host"), byId("chart"), byId("chart-top"), studio);
await nextTask();

const keeper = new Keeper(studio, kept?.remote ?? null);
const open = panelOpener(studio);
/** @type {(() => void)[]} */
const themed = [];

/** @type {import("./actions/action.js").ActionContext} */
const context = {
  studio,
  view,
  keeper,
  open: (name) => void open(name, context),
  toggleTheme: () => {
    const root = document.documentElement;
    root.dataset.theme = isDark() ? "light" : "dark";
    saveSettings({ theme: root.dataset.theme });
  },
};
const retheme = () => {
  view.retheme();
  for (const redraw of themed) redraw();
};
onTheme(retheme);

const stretcher = new Stretcher(studio);
topbar(byId("topbar"), studio, context);
rail(byId("rail"), studio, context);
await nextTask();

chartstrip(byId("chart-host"), context);
/** Rows that do not balance are seldom: what mends them comes with the first. */
let mending = false;
studio.balance.watch(async ({ length }) => {
  if (mending || !length) return;
  mending = true;
  (await import("./panels/chart/balancebar.js")).balancebar(byId("chart-host"), studio);
});
messages(byId("messages"), byId("offline"), studio);
themed.push(overlaybar(byId("overlays"), studio, view), shelf(byId("shelf"), studio, context));
await nextTask();

stretchdrawer(byId("stretch"), studio, stretcher);
split(byId("split-columns"), "--side-width", {
  axis: "x",
  least: 380,
  size: () => byId("inspector").offsetWidth,
  most: () => innerWidth - 480,
});
split(byId("split-rows"), "--inspector-height", {
  axis: "y",
  least: 160,
  size: () => byId("inspector").offsetHeight,
  most: () => innerHeight - 320,
});
const predictAgain = startPredictor(studio);
// Everything that follows the chart is there: now it may be painted on.
new Painter(view, studio);
listenToKeys(context, isTyping);
await nextTask();

// The 3D view starts in a process of its own, while the page is painted.
const showAgain = fabricview(byId("fabric"), studio, view);
await nextTask();

/** The numbers come second: the chart is there to be painted on before they come. */
void firstPaint().then(async () => {
  performance.mark("studio");
  void keeper.catchUp();
  const { afterPaint } = await import("./panels/afterpaint.js");
  themed.push(afterPaint(context));
});

/** Say what the service refused; that it is away, the banner says. @param {ApiError} error */
const missed = ({ offline, problem }) => {
  if (offline) studio.online.value = false;
  else studio.tellProblem(problem);
};

const material = new Latest(0);
const loadMaterial = () =>
  material.run(async (signal) => {
    studio.material.value = await api.material(studio.materialId.value, signal);
  }, missed);
studio.materialId.watch(loadMaterial);

const loadLists = async () => {
  try {
    const lists = /** @type {const} */ ([api.materials(), api.patterns(), api.extensions()]);
    const [{ materials }, { patterns }, { largest_charts }] = await Promise.all(lists);
    studio.materials.value = materials;
    studio.largest.value = largest_charts;
    await nextTask();
    studio.shelf.value = patterns
      .filter(({ repeat }) => isChartText(repeat.replaceAll("/", "\n")))
      .map(({ id, name, repeat, note }) => new Ink(id, name, motifGrid(repeat), note));
  } catch (error) {
    if (!(error instanceof ApiError)) throw error;
    missed(error);
  }
};
await nextTask();
void loadLists();
void import("./services/account.js").then(({ showUser }) => showUser(studio));

watchConnection(studio, () => {
  void loadLists();
  loadMaterial();
  predictAgain();
  showAgain();
});

await nextTask();
const elsewhere = openAddressed(studio, keeper);
if (!kept && !elsewhere) {
  offerTour(byId("topbar"), context);
  // On a small screen the drawer of the test would cover the chart.
  if (!matchMedia("(max-width: 900px)").matches)
    void stretcher.run("wale", { strain: FIRST_STRAIN }).then(() => {
      if (!matchMedia("(prefers-reduced-motion: reduce)").matches) stretcher.play();
    });
}
