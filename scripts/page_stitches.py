"""Write the stitches as the page needs them (``make types``).

``frontend/grid/stitches.js`` has what each is; ``frontend/grid/names.js`` its words and
``frontend/chart/signs.js`` its symbols, which the page loads when it draws the first.

Both are made of :mod:`knitcore.chart.stitch_kinds`, so that a new stitch is one line there.
"""

import json
from itertools import pairwise
from pathlib import Path

from knitcore.chart.stitch_kinds import BY_CODE, STITCHES, Site, StitchType, YarnAct
from knitcore.chart.stitch_symbols import StitchSymbol, symbol_of

FRONTEND = Path(__file__).resolve().parent.parent / "frontend"
HEAD = "// Made from knitcore/chart by scripts/page_stitches.py (`make types`).\n\n"
GROUPS = ("plain", "lace", "cables", "slips", "tucks", "twisted")
STYLES = {"dots": {}, "dashes": {"dashes": True}, "japanese": {"japanese": True}}


def group_of(stitch: StitchType) -> str:
    """The part of the page's palette in which a stitch stands."""
    first = stitch.sites[0]
    if stitch.width > 1:
        return "cables"
    if first.act is YarnAct.MISS:
        return "slips"
    if first.act is YarnAct.OVER and first.sources:
        return "tucks"
    if first.turn:
        return "twisted"
    return "lace" if len(first.sources) != 1 else "plain"


def deed_of(stitch: StitchType) -> str:
    """The words for what a stitch does to the cloth."""
    if stitch.width > 1:
        return _crossing(stitch)
    (site,) = stitch.sites
    if site.act is YarnAct.MISS:
        side = "in front of it" if site.front else "behind it"
        return f"keeps the stitch below, the yarn passes {side}"
    if site.act is YarnAct.OVER and site.sources:
        side = "in front" if site.purl else "behind"
        return f"keeps the stitch below, the yarn is laid over it {side}"
    if not site.sources:
        return "makes a hole, 1 stitch more"
    deeds = []
    if len(site.sources) > 1:
        fewer = len(site.sources) - 1
        middle = site.sources[0] not in (0, len(site.sources) - 1)
        lean = "stands upright" if middle else f"leans {'left' if site.sources[0] else 'right'}"
        deeds += [lean, f"{fewer} stitch{'es' if fewer > 1 else ''} fewer"]
    if site.turn:
        deeds.insert(0, "twists the stitch below" + ("" if site.turn > 0 else " the other way"))
    if not deeds:
        return "a bump on the face" if site.purl else "smooth on the face"
    return ", ".join(deeds)


def _crossing(stitch: StitchType) -> str:
    front = [(at, site) for at, site in enumerate(stitch.sites) if site.layer > 0]
    side = "right" if front[0][0] > front[0][1].sources[0] else "left"
    behind = stitch.width - len(front)
    verb = "move" if len(front) > 1 else "moves"
    return f"{len(front)} {verb} to the {side} in front of {behind}"


def _shown(site: Site) -> str:
    """K or P as the face shows it; an H holds the stitch below and looks like that."""
    if site.act is YarnAct.THROUGH:
        return "P" if site.purl else "K"
    return "H" if site.sources else "K"


def _written(place: int, stitch: StitchType) -> str:
    """The stitch in few letters: the page loads all before anything is painted."""
    images = (stitch.mirrored, stitch.turned_over)
    parts = [
        stitch.code,
        "".join(map(_shown, stitch.sites)),
        "" if stitch.takes == stitch.width else str(stitch.takes),
        *(str(BY_CODE[image.code] - place) for image in images),
        str(GROUPS.index(group_of(stitch))),
    ]
    return "~".join(parts)


def stitches_module() -> str:
    """The module of what each stitch is, and its images are."""
    written = " ".join(_written(place, stitch) for place, stitch in enumerate(STITCHES))
    return (
        f"{HEAD}/** @type {{readonly string[]}} */\n"
        f"export const GROUPS = {json.dumps(GROUPS)};\n\n"
        "/**\n * Code, K or P shown by each site (H: as below), loops taken where they are not as "
        "many, steps to the\n * mirror image and to the back in this list, group.\n */\n"
        f"export const STITCHES = {json.dumps(written)};\n"
    )


def names_module() -> str:
    """The module of names, abbreviations and deeds by code."""
    names = {stitch.code: [stitch.name, stitch.words, deed_of(stitch)] for stitch in STITCHES}
    return (
        f"{HEAD}/**\n * Name, abbreviation and deed by code.\n *\n"
        " * @type {Record<string, [name: string, words: string, deed: string]>}\n */\n"
        f"export const NAMES = {json.dumps(names, indent=1)};\n"
    )


def drawn(symbol: StitchSymbol) -> str:
    """A symbol as text: strokes of points and dots in hundredths of a cell, y up from the foot.

    A stroke whose points turn a little each is smooth: the page draws it as curves.
    """
    strokes = [" ".join(f"{100 * x:.0f},{100 * y:.0f}" for x, y in line) for line in symbol.strokes]
    dots = [f"{100 * x:.0f},{100 * y:.0f}" for x, y in symbol.dots]
    return f"{';'.join(strokes)}|{';'.join(dots)}"


def signs_module() -> str:
    """The module of symbols: those of every style by the code of the stitch."""
    styles = {
        style: {stitch.code: drawn(symbol_of(stitch, **options)) for stitch in STITCHES}
        for style, options in STYLES.items()
    }
    # those of cables are the same in two styles; from the last, so that each is compared whole
    for before, after in reversed(list(pairwise(styles.values()))):
        for code in [code for code in after if after[code] == before.get(code)]:
            del after[code]
    return (
        f"{HEAD}/**\n * Strokes and dots by code; a style takes what it lacks from the one before "
        "it.\n *\n * @type {Record<string, Record<string, string>>}\n */\n"
        f"export const SIGNS = {json.dumps(styles, indent=1)};\n"
    )


def write() -> None:
    """Write the modules that differ from what is there."""
    for name, text in (
        ("grid/stitches.js", stitches_module()),
        ("grid/names.js", names_module()),
        ("chart/signs.js", signs_module()),
    ):
        file = FRONTEND / name
        if not file.is_file() or file.read_text(encoding="utf-8") != text:
            file.write_text(text, encoding="utf-8")


if __name__ == "__main__":
    write()
