/**
 * What to do where a row takes more or fewer stitches than the row below has: said over the foot of the chart, with
 * ways to mend it.
 *
 * @import {Studio} from "../../state/studio.js"
 */

import { balanceWords, remediesOf } from "../../design/balance.js";
import { h } from "../../elements/dom.js";
import { icon } from "../../elements/icons.js";
import { textButton } from "../../widgets/buttons.js";

/** @param {HTMLElement} host @param {Studio} studio */
export function balancebar(host, studio) {
  const { document: chart, balance } = studio;
  const words = h("span", { role: "status", id: "balance-words" });
  const buttons = h("span", { class: "flex wrap gap-5" });
  const bar = h(
    "div",
    { class: "balance-bar raised line wrap gap-8 rounded small shadowed", id: "balance", hidden: true },
    icon("warning"),
    words,
    buttons,
  );
  host.append(bar);
  balance.watch((rows) => {
    bar.hidden = !rows.length;
    const [first] = rows;
    if (!first) return void words.replaceChildren();
    const more = rows.length > 1 ? ` ${rows.length - 1} more row${rows.length > 2 ? "s" : ""} like this.` : "";
    words.textContent = `${balanceWords(first, chart.grid.columns)}${more}`;
    buttons.replaceChildren(
      ...remediesOf(chart, first).map(({ words: label, cells, put }, k) =>
        textButton(null, label, () => chart.set(cells, label, "stitches", put), {
          class: "button small",
          id: `balance-remedy-${k + 1}`,
        }),
      ),
    );
  });
}
