/**
 * All stitches that are neither knit nor purl, and small motifs of them: chosen here, they are painted like knits
 * and purls.
 *
 * @import {Motif} from "../../design/motifs.js"
 * @import {Kind} from "../../grid/kinds.js"
 * @import {Studio} from "../../state/studio.js"
 */

import { besides } from "../../core/pointing.js";
import { onTheme } from "../../state/palette.js";
import { loadSigns } from "../../chart/symbols.js";
import { codesInk, stitchInk } from "../../design/ink.js";
import { MOTIFS } from "../../design/motifs.js";
import { h, remark } from "../../elements/dom.js";
import { NAMES } from "../../grid/names.js";
import { KINDS, KIND_GROUPS } from "../../grid/kinds.js";
import { pencil, stamp } from "../../tools/tools.js";
import { docked } from "../../widgets/dock.js";
import { signElement } from "../../widgets/sign.js";
import { motifPicture } from "./picture.js";

/** Wider cables, those with purls in front, and seldom decreases are shown when they are searched for. */
const MOST_WIDE = 6;
/** @type {Record<string, string>} */
const HEADINGS = { lace: "Lace", cables: "Cables", slips: "Slipped", tucks: "Tucked", twisted: "Twisted" };
/** What else they are called. @type {Record<string, string>} */
const ALSO = {
  lace: "eyelet hole increase decrease yo",
  cables: "cross twist travelling aran",
  slips: "slip mosaic float",
  tucks: "fisherman brioche",
  twisted: "tbl",
};

/** @param {Kind} kind */
const isUsual = ({ group, width, code }) =>
  group === "cables"
    ? width <= MOST_WIDE && Math.abs(Number(code[1]) - Number(code[3])) < 2 && /[RL]P?]$/.test(code)
    : code.length === 1;

/** @param {Studio} studio */
export function create(studio) {
  const { editing } = studio;
  const list = h("div", { class: "stitch-list stack gap-10" });
  const search = h("input", {
    type: "search",
    class: "text full-width",
    id: "stitch-search",
    placeholder: "Name or abbreviation",
    "aria-label": "Find a stitch by name or abbreviation",
    oninput: () => show(),
  });

  /** @param {import("../../design/ink.js").Ink} ink @param {import("../../tools/tool.js").Tool} tool */
  const choose = (ink, tool) => {
    studio.ink.value = ink;
    studio.tool.value = tool;
  };
  /** @param {Kind} kind */
  const stitch = ({ code, group }) => {
    const [name, words, deed] = NAMES[code];
    return h(
      "button",
      {
        class: `stitch bare rounded small ${group}`,
        id: `stitch-${code}`,
        title: `${name}: ${deed}`,
        "aria-label": `${name}, ${words}: ${deed}`,
        onclick: () => choose(stitchInk(code, NAMES[code]), pencil),
      },
      h("span", { class: "stitch-ground rounded" }, signElement(code, editing.symbols.value)),
      h("span", { class: "ellipsis" }, words),
    );
  };
  /** @param {Motif} motif */
  const motif = ({ name, codes, note }) => {
    const ink = codesInk(`motif-${name.replace(/\W+/g, "-")}`, name, codes, note);
    return h(
      "button",
      {
        class: "stitch motif bare rounded small",
        id: ink.id,
        title: `${name}: ${note}`,
        "aria-label": `${name}, ${ink.repeat?.columns} × ${ink.repeat?.rows} stitches: ${note}`,
        onclick: () => choose(ink, stamp),
      },
      h("img", { class: "thumbnail", alt: "", src: motifPicture(ink, editing.symbols.value) }),
      h("span", {}, name),
    );
  };
  /** @param {string} title @param {string} group @param {HTMLElement[]} motifs @param {HTMLElement[]} stitches */
  const section = (title, group, motifs, stitches) =>
    h(
      "section",
      { class: "stack gap-4", "aria-labelledby": `stitches-${group}` },
      h("h3", { id: `stitches-${group}` }, title),
      stitches.length > 0 && h("div", { class: "stitch-grid" }, ...stitches),
      motifs.length > 0 && h("div", { class: "stitch-grid motifs" }, ...motifs),
    );

  const show = () => {
    const sought = search.value.trim().toLowerCase().split(/\s+/);
    const usual = !search.value.trim();
    /** @param {string} text */
    const fits = (text) => sought.every((word) => text.toLowerCase().includes(word));
    /** @param {(group: string) => string} also what else the stitches of a group are called */
    const sectionsFor = (also) =>
      KIND_GROUPS.flatMap((group) => {
        const own = KINDS.filter((kind) => kind.group === group);
        const kinds = own.filter((kind) =>
          usual ? isUsual(kind) : fits(`${NAMES[kind.code].slice(0, 2).join(" ")} ${kind.code} ${also(group)}`),
        );
        const motifs = MOTIFS.filter(
          (each) => each.group === group && fits(`${each.name} ${each.note} ${also(group)}`),
        );
        if (!kinds.length && !motifs.length) return [];
        return [section(HEADINGS[group] ?? group, group, motifs.map(motif), kinds.map(stitch))];
      });
    const named = sectionsFor(() => "");
    const sections = named.length ? named : sectionsFor((group) => `${group} ${ALSO[group]}`);
    if (usual) sections.push(remark("Wider cables, purled ones and rarer decreases: find them by name."));
    list.replaceChildren(...(sections.length ? sections : [remark("No stitch has this name.")]));
    mark();
  };
  const mark = () => {
    const { id } = studio.ink.value;
    for (const button of list.querySelectorAll("button")) button.ariaPressed = String(button.id === id);
  };
  studio.ink.listen(mark);
  editing.symbols.listen(show);
  onTheme(show);
  void loadSigns().then(show);
  const open = docked(
    studio,
    "stitches",
    "Stitches",
    h(
      "div",
      { class: "stack gap-8 stitches-head" },
      search,
      remark(`${besides("Choose a stitch to paint, or a motif to stamp", "the right button takes stitches away")}.`),
    ),
    list,
  );
  return () => {
    show();
    open();
  };
}
