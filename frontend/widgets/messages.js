/**
 * Messages above the chart, at the foot of a narrow page, and the banner while the service is away.
 *
 * @import {Studio} from "../state/studio.js"
 */

import { h } from "../elements/dom.js";
import { icon } from "../elements/icons.js";
import { iconButton } from "./buttons.js";
import { problemText } from "./problem.js";

const INFO_MS = 5000;

/** @param {HTMLElement} host @param {HTMLElement} banner @param {Studio} studio */
export function messages(host, banner, studio) {
  studio.message.listen((message) => {
    if (!message) return;
    const { kind } = message;
    const close = () => box.remove();
    const box = h(
      "div",
      { class: `message raised flex shadowed gap-10 ${kind}` },
      icon(kind === "error" ? "warning" : "info"),
      problemText(message),
      iconButton("close", "Close this message", close),
    );
    host.replaceChildren(box);
    if (kind === "info") setTimeout(close, INFO_MS);
    studio.message.value = null;
  });

  studio.online.watch((online) => {
    banner.hidden = online;
    if (!online) {
      banner.replaceChildren(
        icon("warning"),
        h("strong", {}, "The service cannot be reached."),
        "Your chart is safe in this browser and you can go on painting. Numbers and 3D return by themselves; if not, start the service again.",
      );
    }
  });
}
