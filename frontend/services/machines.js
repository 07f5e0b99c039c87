/**
 * The machines to choose from: the service's, and a profile of the user's own. The choice is kept with the design.
 *
 * @import {Machines} from "../types.js"
 *
 * @typedef {Pick<Machines["machines"][number], "identifier" | "name" | "reads_programs">} Machine
 */

import { api } from "../api.js";
import { loadSettings, saveSettings } from "../design/store.js";

/** Machines of designs that name none: for programs, and for plans by hand. */
const USUAL = { programs: "swg091n2", plans: "brother" };
const OWN = "own";
const FILE = "file";

/** The service's machines; those of before while it is away. @returns {Promise<Machine[]>} */
export async function knownMachines() {
  const { machines: before } = loadSettings({ machines: /** @type {Machine[]} */ ([]) });
  try {
    const { machines } = await api.machines();
    const short = machines.map(({ identifier, name, reads_programs }) => ({ identifier, name, reads_programs }));
    saveSettings({ machines: short });
    return short;
  } catch (error) {
    if (before.length) return before;
    throw error;
  }
}

/** The machine of a profile's text; null for a machine's name. @param {string | null} text @returns {Machine | null} */
export function ownMachine(text) {
  if (!text?.trimStart().startsWith("{")) return null;
  try {
    const { name, identifier, dialect } = JSON.parse(text);
    const reads_programs = dialect !== "hand";
    return { identifier: String(identifier ?? OWN), name: String(name || "Your own profile"), reads_programs };
  } catch {
    return { identifier: OWN, name: "Your own profile", reads_programs: true };
  }
}

/**
 * What can be chosen for a kind of file.
 *
 * @param {readonly Machine[]} machines
 * @param {string | null} chosen what the design keeps: a name, or the text of a profile
 * @param {"programs" | "plans"} use
 * @returns {{options: Record<string, string>, value: string}}
 */
export function choices(machines, chosen, use) {
  const fit = machines.filter(({ reads_programs }) => reads_programs === (use === "programs"));
  const options = Object.fromEntries(fit.map(({ identifier, name }) => [identifier, name]));
  const own = ownMachine(chosen);
  let value = USUAL[use];
  if (own && own.reads_programs === (use === "programs")) {
    value = OWN;
    options[OWN] = own.name;
  } else if (!own && chosen && (chosen in options || machines.every(({ identifier }) => identifier !== chosen))) {
    value = chosen;
  }
  options[value] ??= value;
  return { options: { ...options, [FILE]: "A profile of your own …" }, value };
}

export const isOwn = (/** @type {string} */ value) => value === OWN;
export const isFile = (/** @type {string} */ value) => value === FILE;
