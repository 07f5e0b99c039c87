/**
 * Inverse design beside the chart: the atlas of all repeats and the search for a fabric. It lies over the
 * fabric and the inspector, so that the chart stays in sight.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {Studio} from "../../state/studio.js"
 */

import { byId, h } from "../../elements/dom.js";
import { iconButton } from "../../widgets/buttons.js";
import { atlasTab } from "./atlas.js";
import { findTab } from "./find.js";

const TABS = [
  { id: "atlas", label: "Atlas" },
  { id: "find", label: "Find a fabric" },
];

/** @typedef {"atlas" | "find"} TabName */

/** One panel for both. @type {WeakMap<Studio, (tab: TabName) => void>} */
const panels = new WeakMap();

/** @param {TabName} tab @returns {(studio: Studio, context: ActionContext) => () => void} */
export const opening = (tab) => (studio, context) => {
  let show = panels.get(studio);
  if (!show) {
    show = panel(studio, context);
    panels.set(studio, show);
  }
  const open = show;
  return () => open(tab);
};

/** @param {Studio} studio @param {ActionContext} context */
function panel(studio, context) {
  const atlas = atlasTab(studio, context);
  const find = findTab(studio, context);
  /** @type {Record<TabName, HTMLElement>} */
  const contents = { atlas: atlas.element, find: find.element };

  const close = () => {
    section.hidden = true;
    byId("chart").focus({ preventScroll: true });
  };
  const tabs = h(
    "div",
    { class: "flex wrap shrinks-x gap-2", role: "tablist", "aria-label": "Inverse design" },
    ...TABS.map(({ id, label }) =>
      h(
        "button",
        {
          class: "inverse-tab-button bare nowrap muted",
          role: "tab",
          id: `inverse-${id}`,
          "aria-controls": `inverse-${id}-content`,
          onclick: () => show(/** @type {TabName} */ (id)),
          onkeydown: (/** @type {KeyboardEvent} */ event) => {
            const step = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
            if (!step) return;
            event.preventDefault();
            event.stopPropagation();
            const next = TABS[(TABS.findIndex((tab) => tab.id === id) + step + TABS.length) % TABS.length];
            show(/** @type {TabName} */ (next.id));
            byId(`inverse-${next.id}`).focus();
          },
        },
        label,
      ),
    ),
  );
  const yarn = h("span", { class: "muted ellipsis inverse-yarn small shrinks-x grows" });
  const section = h(
    "section",
    {
      class: "inverse beside stack panelled",
      id: "inverse",
      "aria-label": "Inverse design",
      onkeydown: (/** @type {KeyboardEvent} */ event) => {
        if (event.key !== "Escape") return;
        event.preventDefault();
        event.stopPropagation();
        close();
      },
    },
    h("header", {}, tabs, yarn, iconButton("close", "Close inverse design", close, { id: "inverse-close" })),
    ...TABS.map(({ id }) => {
      const content = contents[/** @type {TabName} */ (id)];
      content.id = `inverse-${id}-content`;
      content.setAttribute("role", "tabpanel");
      content.setAttribute("aria-labelledby", `inverse-${id}`);
      return content;
    }),
  );
  byId("inspector").parentElement?.append(section);

  const nameYarn = () => {
    yarn.textContent = studio.yarn?.name ?? studio.materialId.value;
  };
  /** @type {TabName} */ let current = "atlas";
  studio.materials.watch(nameYarn);
  studio.materialId.listen(() => {
    nameYarn();
    if (!section.hidden && current === "atlas") atlas.open();
  });
  new MutationObserver(atlas.retheme).observe(document.documentElement, { attributeFilter: ["data-theme"] });

  const show = (/** @type {TabName} */ tab) => {
    current = tab;
    section.hidden = false;
    for (const { id } of TABS) {
      contents[/** @type {TabName} */ (id)].hidden = id !== tab;
      const button = byId(`inverse-${id}`);
      button.setAttribute("aria-selected", String(id === tab));
      button.tabIndex = id === tab ? 0 : -1;
    }
    if (tab === "atlas") atlas.open();
    byId(`inverse-${tab}`).focus({ preventScroll: true });
    section.scrollIntoView(); // where the page scrolls: on phones, and zoomed in
  };
  return show;
}
