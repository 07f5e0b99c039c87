/**
 * The choice of the machine that a program is for: one that the service knows, or a profile of the
 * user's own. It is kept with the design.
 *
 * @import {Studio} from "../../state/studio.js"
 * @import {Machines} from "../../types.js"
 */

import { h } from "../../elements/dom.js";
import { labelled, selectField } from "../../widgets/fields.js";

/** The machine of designs that name none. */
export const DEFAULT = "swg091n2";
const OWN = "own";
const FILE = "file";

/**
 * Machines to choose from, by what a design keeps of them.
 *
 * @param {Pick<Machines["machines"][number], "identifier" | "name" | "reads_programs">[]} machines
 * @param {string | null} chosen what the design keeps: a name, or the text of a profile
 * @returns {{options: Record<string, string>, value: string}}
 */
export function choices(machines, chosen) {
  const known = machines.filter((machine) => machine.reads_programs);
  const value = chosen === null ? DEFAULT : isProfile(chosen) ? OWN : chosen;
  const options = Object.fromEntries(known.map(({ identifier, name }) => [identifier, name]));
  if (value === OWN) options[OWN] = nameOf(chosen ?? "");
  options[value] ??= value;
  return { options: { ...options, [FILE]: "A profile of your own …" }, value };
}

/** @param {string} text */
const isProfile = (text) => text.trimStart().startsWith("{");

/** The name in a profile. @param {string} text */
function nameOf(text) {
  try {
    const { name } = JSON.parse(text);
    return typeof name === "string" && name ? name : "Your own profile";
  } catch {
    return "Your own profile";
  }
}

/** @param {Studio} studio */
export function machineField(studio) {
  /** @type {Machines["machines"]} */
  let machines = [];
  const host = h("span", {});
  const file = h("input", { type: "file", accept: ".json,application/json", hidden: true });
  file.addEventListener("change", async () => {
    const profile = file.files?.[0];
    if (profile) studio.machine.value = (await profile.text()).replace(/^\ufeff/, "");
    file.value = "";
    show();
  });
  function show() {
    const { options, value } = choices(machines, studio.machine.value);
    const field = selectField({ class: "text", id: "export-machine", "aria-label": "Machine" }, options);
    field.value = value;
    field.addEventListener("change", () => {
      const { value: picked } = field;
      if (picked !== FILE) studio.machine.value = picked;
      else file.click();
      show();
    });
    host.replaceChildren(field);
  }
  studio.machine.listen(show);
  return {
    element: h("div", {}, labelled("Machine", host), file),
    show,
    /** @param {Machines["machines"]} known */
    offer(known) {
      machines = known;
      show();
    },
  };
}
