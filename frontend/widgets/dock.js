/**
 * The place beside the chart where one panel at a time is open. A panel is made when it is opened
 * first (see panels/registry.js) and puts itself here.
 *
 * @import {Child} from "../elements/dom.js"
 * @import {Studio} from "../state/studio.js"
 */

import { byId, h } from "../elements/dom.js";
import { iconButton } from "./buttons.js";

/**
 * @param {Studio} studio
 * @param {string} name
 * @param {string} title
 * @param {...Child} content
 * @returns {() => void} opens the panel
 */
export function docked(studio, name, title, ...content) {
  const { panel } = studio.editing;
  const close = () => {
    panel.value = null;
    byId("chart").focus({ preventScroll: true });
  };
  const section = h(
    "section",
    {
      class: "dock-panel",
      id: `panel-${name}`,
      "aria-labelledby": `panel-${name}-title`,
      onkeydown: (/** @type {KeyboardEvent} */ event) => {
        if (event.key !== "Escape") return;
        event.preventDefault();
        close();
      },
    },
    h(
      "header",
      {},
      h("h2", { id: `panel-${name}-title`, tabIndex: -1 }, title),
      iconButton("close", `Close ${title.toLowerCase()}`, close),
    ),
    ...content,
  );
  const dock =
    document.getElementById("dock") ??
    h("aside", { id: "dock", class: "dock shrinks-y panelled", "aria-label": "Parts of the chart" });
  if (!dock.isConnected) byId("chart-host").before(dock);
  dock.append(section);
  panel.watch((open) => {
    section.hidden = open !== name;
    dock.hidden = [...dock.children].every((child) => child instanceof HTMLElement && child.hidden);
  });
  return () => (panel.value = name);
}

/**
 * A list of a panel, made anew whenever something changes; what had the focus keeps it.
 *
 * @param {HTMLElement} list
 * @param {() => Node[]} make
 */
export function refreshed(list, make) {
  const focused = list.contains(document.activeElement) ? document.activeElement?.id : "";
  list.replaceChildren(...make());
  if (focused) document.getElementById(focused)?.focus({ preventScroll: true });
}
