/** All keys and tools. */

import { byHand, shown } from "../../core/pointing.js";
import { ACTIONS } from "../../actions/registry.js";
import { api } from "../../api.js";
import { h, remark } from "../../elements/dom.js";
import { TOOLS } from "../../tools/tools.js";
import { dialog } from "../../widgets/dialog.js";

export function create() {
  const hints = new Map(TOOLS.map((tool) => [`tool-${tool.id}`, tool.hint]));
  const groups = [...new Set(ACTIONS.map(({ group }) => group))];
  const version = h("p", { class: "muted" });
  const element = dialog(
    "help-dialog",
    "Keys and tools",
    remark(
      `Paint stitches in the chart; its colours show what each will do, and the panel beside it what the whole cloth will do. ${byHand(
        "The right mouse button paints the opposite stitch. The wheel zooms, Space and drag moves. With the chart focused, arrow keys move and Enter paints.",
        "Two fingers move and zoom.",
      )}`,
    ),
    h(
      "div",
      { class: "help-columns" },
      ...groups.map((group) =>
        h(
          "section",
          {},
          h("h3", {}, group),
          h(
            "dl",
            { class: "keys stack" },
            ...ACTIONS.filter((action) => action.group === group).flatMap((action) => [
              h("dt", { class: "flex wrap gap-4" }, ...action.keys.slice(0, 2).map((key) => h("kbd", {}, shown(key)))),
              h(
                "dd",
                {},
                action.label,
                hints.has(action.id) && h("span", { class: "muted" }, ` – ${hints.get(action.id)}`),
              ),
            ]),
          ),
        ),
      ),
    ),
    version,
  );
  return async () => {
    element.showModal();
    const release = await api.version().catch(() => undefined); // unreachable: the line is left out
    if (release) version.replaceChildren(`Knitcore ${release.version} · `, h("a", { href: "/docs" }, "API reference"));
  };
}
