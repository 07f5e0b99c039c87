/**
 * The choice of the machine that a file is for.
 *
 * @import {Studio} from "../../state/studio.js"
 * @import {Machine} from "../../services/machines.js"
 */

import { h } from "../../elements/dom.js";
import { choices, isFile, isOwn } from "../../services/machines.js";
import { labelled, selectField } from "../../widgets/fields.js";

/** @param {Studio} studio @param {() => void} changed */
export function machineField(studio, changed) {
  /** @type {readonly Machine[]} */
  let machines = [];
  /** @type {"programs" | "plans"} */
  let use = "programs";
  const host = h("span", {});
  const file = h("input", { type: "file", accept: ".json,application/json", hidden: true });
  file.addEventListener("change", async () => {
    const profile = file.files?.[0];
    if (profile) studio.machine.value = (await profile.text()).replace(/^\ufeff/, "");
    file.value = "";
    show();
  });
  function show() {
    const { options, value } = choices(machines, studio.machine.value, use);
    const field = selectField({ class: "text", id: "export-machine", "aria-label": "Machine" }, options);
    field.value = value;
    field.addEventListener("change", () => {
      const { value: picked } = field;
      if (isFile(picked)) file.click();
      else if (!isOwn(picked)) studio.machine.value = picked;
      show();
    });
    host.replaceChildren(field);
    changed();
  }
  studio.machine.listen(show);
  return {
    element: h("div", {}, labelled("Machine", host), file),
    /** The machine on show: its name, or the text of a profile. @returns {string} */
    get value() {
      const { value } = choices(machines, studio.machine.value, use);
      return isOwn(value) ? (studio.machine.value ?? "") : value;
    },
    /** @param {"programs" | "plans"} chosen */
    showFor(chosen) {
      use = chosen;
      show();
    },
    /** @param {readonly Machine[]} known */
    offer(known) {
      machines = known;
      show();
    },
  };
}
