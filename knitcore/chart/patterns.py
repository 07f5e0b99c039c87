"""Named repeats that knitters know, as seen from the face."""

from dataclasses import dataclass

from knitcore.chart.stitch_chart import StitchChart


@dataclass(frozen=True)
class Pattern:
    """A named repeat with a short description."""

    identifier: str
    name: str
    chart: StitchChart
    note: str


def _pattern(identifier: str, name: str, rows: str, note: str) -> Pattern:
    return Pattern(identifier, name, StitchChart.parse(rows.replace(" ", "\n")), note)


def rib(knits: int, purls: int) -> StitchChart:
    """One repeat of a knits x purls rib."""
    return StitchChart.parse("K" * knits + "P" * purls)


def welt(knits: int, purls: int) -> StitchChart:
    """One repeat of garter welts: rows of knits and rows of purls, the knits at the bottom."""
    return StitchChart.parse("\n".join(["P"] * purls + ["K"] * knits))


PATTERNS = (
    _pattern("stockinette", "Stockinette", "K", "Smooth, and the edges curl."),
    _pattern("garter", "Garter", "P K", "Ridges across: stretchy along the columns; lies flat."),
    _pattern("rib", "1×1 rib", "KP", "Upright ribs: stretchy along the rows; draws in."),
    _pattern("seed", "Seed", "KP PK", "A grain of single bumps: soft both ways; lies flat."),
    Pattern("rib-2-2", "2×2 rib", rib(2, 2), "Deeper ribs than 1×1: folds, and draws in more."),
    Pattern("rib-3-1", "3×1 rib", rib(3, 1), "A wide face with a narrow hinge."),
    Pattern("rib-3-3", "3×3 rib", rib(3, 3), "Folds deeply; draws in strongly."),
    Pattern(
        "welt-2-2", "2-row welts", welt(2, 2), "Ridges that shorten the cloth along its columns."
    ),
    _pattern("basket", "Basket 2×2", "PPKK PPKK KKPP KKPP", "Blocks of two; thick and springy."),
    _pattern("moss", "Moss", "PK PK KP KP", "Seed, with each row knitted twice."),
    _pattern("broken-rib", "Broken rib", "KK KP", "Rib every other row; lies flat."),
    _pattern(
        "diamonds",
        "Diamonds",
        "KKKKPKKK KKKPKPKK KKPKKKPK KPKKKKKP PKKKKKKK KPKKKKKP KKPKKKPK KKKPKPKK",
        "Purl lines on stockinette; soft along the lines.",
    ),
)
"""All patterns, in the order in which they are shown."""
