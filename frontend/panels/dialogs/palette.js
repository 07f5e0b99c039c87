/**
 * Every tool and command, yarn, pattern, colouring, plot and pose, found by its name.
 *
 * @import {ActionContext} from "../../actions/action.js"
 * @import {Studio} from "../../state/studio.js"
 * @import {IconName} from "../../elements/icons.js"
 * @import {Pose} from "../../state/seeing.js"
 *
 * @typedef {{label: string, words: string, icon?: IconName, key?: string, perform: () => void}} Entry
 */

import { shown } from "../../core/pointing.js";
import { ACTIONS } from "../../actions/registry.js";
import { loadSigns } from "../../chart/symbols.js";
import { stitchInk } from "../../design/ink.js";
import { NAMES } from "../../grid/names.js";
import { KINDS } from "../../grid/kinds.js";
import { OVERLAYS } from "../../state/overlays.js";
import { POSES } from "../../state/seeing.js";
import { byId, h } from "../../elements/dom.js";
import { icon } from "../../elements/icons.js";
import { dialog } from "../../widgets/dialog.js";

/** Search words that an action's name does not contain. @type {Record<string, string>} */
const WORDS = {
  stitches: "yarn over eyelet lace cable cross slip tuck twisted symbols motif",
  garments: "measure measurements pressure glove sock sleeve brace plan",
  "open-find": "pressure search target stretch stiffness",
  "open-fill": "target wish stiffness softer stiffer relax region",
  "open-atlas": "repeats patterns",
  stretch: "pull test force load strain lock-up",
  versions: "history",
  yarns: "material own test files measure fit add",
  compare: "difference side by side versions regions yarns",
  exports: "print pdf knitout written download save",
};

/** Poses of the cloth, and what else they are called. @type {Partial<Record<Pose, string>>} */
const POSE_WORDS = { flat: "relaxed", lying: "relax curl rest free", worn: "limb hand tube pressure" };

/** Plots beside the numbers: their tabs, names and other words. */
const PLOTS = /** @type {const} */ ([
  ["tab-rigidity", "Stiffness among all yarns", "plot map modulus"],
  ["tab-curve", "Stress–strain curves", "plot stretch force"],
  ["tab-limb", "Pressure on a limb", "worn fit ease compression"],
  ["tab-drape", "Drape, bending and weight", "hang overhang"],
]);

/** @param {string} text as it is typed */
const plain = (text) => text.trim().toLowerCase().replaceAll("×", "x").replaceAll("–", "-");

/** @param {ActionContext} context @returns {Entry[]} */
function entries(context) {
  const { studio } = context;
  const patterns = studio.shelf.value.filter(({ repeat }) => repeat);
  return [
    ...ACTIONS.filter(({ id, enabled }) => id !== "palette" && enabled?.(studio) !== false).map((action) => ({
      label: action.label,
      words: WORDS[action.id] ?? "",
      icon: action.icon,
      key: action.keys[0],
      perform: () => action.perform(context),
    })),
    ...KINDS.filter(({ code }) => code.length === 1).map(({ code, group }) => ({
      label: `Paint: ${NAMES[code][0]}`,
      words: `${NAMES[code][1]} ${group}`,
      perform: () => void loadSigns().then(() => studio.paintWith(stitchInk(code, NAMES[code]))),
    })),
    ...OVERLAYS.filter((overlay) => overlay.available(studio)).map((overlay) => ({
      label: `Colour the chart by: ${overlay.label.toLowerCase()}`,
      words: "colours show",
      perform: () => (studio.overlay.value = overlay),
    })),
    ...(studio.currentStretch() ? [studio.seeing.crosses] : []).map((crosses) => ({
      label: `${crosses.value ? "Hide" : "Show"} strain crosses`,
      words: "stretch narrow",
      perform: () => (crosses.value = !crosses.value),
    })),
    ...PLOTS.map(([id, label, words]) => ({ label, words, perform: () => byId(id).click() })),
    {
      label: "Your gauge: count your swatch",
      words: "gauge stitches rows per 10 cm",
      perform: () => byId("own-gauge-stitches").focus(),
    },
    ...Object.entries(POSE_WORDS).map(([pose, words]) => ({
      label: `Show the cloth: ${POSES[/** @type {Pose} */ (pose)].toLowerCase()}`,
      words: `3D pose ${words}`,
      perform: () => (studio.seeing.pose.value = /** @type {Pose} */ (pose)),
    })),
    ...patterns.map((ink) => ({
      label: `Paint with ${ink.name}`,
      words: "pattern",
      perform: () => (studio.ink.value = ink),
    })),
    ...studio.completeYarns.map(({ id, name }) => ({
      label: `Yarn: ${name}`,
      words: "material",
      icon: /** @type {IconName} */ ("yarn"),
      perform: () => (studio.materialId.value = id),
    })),
  ];
}

/** @param {Studio} _studio @param {ActionContext} context */
export function create(_studio, context) {
  const nothing = h("p", { class: "muted", role: "status" });
  const list = h("div", { class: "command-list stack", role: "listbox", "aria-label": "Commands" });
  const search = h("input", {
    type: "text",
    id: "command-search",
    class: "command-search framed rounded full-width",
    placeholder: "Find a command, yarn, pattern, plot …",
    "aria-label": "Find a tool or command",
    oninput: () => show(),
    onkeydown: (/** @type {KeyboardEvent} */ event) => {
      const items = /** @type {HTMLElement[]} */ ([...list.children]);
      const at = items.findIndex((item) => item.ariaSelected === "true");
      const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
      if (step && items.length) {
        event.preventDefault();
        items[at].ariaSelected = "false";
        const next = items[(at + step + items.length) % items.length];
        next.ariaSelected = "true";
        next.scrollIntoView({ block: "nearest" });
      } else if (event.key === "Enter") {
        event.preventDefault(); // otherwise it would press whatever has the focus after closing
        items[at]?.click();
      }
    },
  });
  const show = () => {
    const terms = plain(search.value).split(/\s+/);
    const all = entries(context);
    const has = (/** @type {string} */ text) => terms.every((word) => plain(text).includes(word));
    const named = all.filter(({ label }) => has(label));
    const meant = all.filter((entry) => !named.includes(entry) && has(`${entry.label} ${entry.words}`));
    const matching = [...named, ...meant];
    nothing.textContent = matching.length ? "" : "Nothing of that name. Try a tool, a yarn, a pattern or a colouring.";
    list.replaceChildren(
      ...matching.map((entry, i) =>
        h(
          "button",
          {
            class: "command bare line gap-10",
            role: "option",
            tabIndex: -1,
            "aria-selected": String(i === 0),
            onclick: () => {
              element.close();
              entry.perform();
            },
          },
          entry.icon ? icon(entry.icon) : h("span", { class: "icon" }),
          h("span", {}, entry.label),
          entry.key && h("kbd", {}, shown(entry.key)),
        ),
      ),
    );
  };
  const element = dialog("palette-dialog", "Commands", search, nothing, list);
  return () => {
    search.value = "";
    show();
    element.showModal();
    search.focus();
  };
}
