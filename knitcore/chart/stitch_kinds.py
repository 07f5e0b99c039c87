"""The registry of stitches: what each does with the yarn, its code, and its words.

A stitch stands over ``width`` sites, each a needle in a row, and takes ``takes`` loops of the row
below. Adding a stitch is adding a line here: charts, graphs, words and programs are made of it.
Sources count from the left as the face shows them; those of a decrease stand in the order in
which they lie, the front of the fabric first.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import IntEnum
from functools import cache
from itertools import product

MAX_CABLE_STITCHES = 6
"""Most stitches on either side of a cable."""


class YarnAct(IntEnum):
    """The three things that a site does with the yarn of its row."""

    THROUGH = 0
    """Pull a loop through the loops that the site holds."""
    OVER = 1
    """Lay a loop over them: a yarn over, where it holds none, or a tuck."""
    MISS = 2
    """Pass by: a slipped stitch."""


@dataclass(frozen=True, slots=True)
class Site:
    """One needle in one row.

    Parameters
    ----------
    act : what it does.
    sources : loops of the row below that it takes, counted from the stitch's left, front first.
    purl : the new loop is drawn to the back; a tuck's strand lies in front.
    front : the yarn passes in front of a slipped stitch.
    turn : half turns of the loop below; +1 as through the back loop.
    layer : +1 where its loop passes in front of others that change places, -1 behind.
    """

    act: YarnAct = YarnAct.THROUGH
    sources: tuple[int, ...] = (0,)
    purl: bool = False
    front: bool = False
    turn: int = 0
    layer: int = 0

    def mirrored(self, takes: int) -> Site:
        """Reflect left to right in a stitch that takes ``takes`` loops."""
        return replace(self, sources=tuple(takes - 1 - i for i in self.sources), turn=-self.turn)

    def turned_over(self, takes: int) -> Site:
        """Look at it from the back."""
        through = self.act is YarnAct.THROUGH
        return replace(
            self,
            sources=tuple(takes - 1 - i for i in reversed(self.sources)),
            purl=not self.purl
            if through or (self.sources and self.act is YarnAct.OVER)
            else self.purl,
            front=not self.front if self.act is YarnAct.MISS else self.front,
            layer=-self.layer,
        )


@dataclass(frozen=True, slots=True)
class StitchType:
    """A kind of stitch.

    Parameters
    ----------
    code : in a chart's text: one sign, or several in brackets.
    name : in a knitter's words.
    words : its abbreviation where the row is worked from the face.
    sites : from the left of the face.
    """

    code: str
    name: str
    words: str
    sites: tuple[Site, ...]

    @property
    def width(self) -> int:
        """Stitches that it leaves: columns of the chart."""
        return len(self.sites)

    @property
    def takes(self) -> int:
        """Loops of the row below that it takes."""
        return sum(len(site.sources) for site in self.sites)

    @property
    def mirrored(self) -> StitchType:
        """The stitch reflected left to right."""
        return _of_sites(tuple(site.mirrored(self.takes) for site in reversed(self.sites)))

    @property
    def turned_over(self) -> StitchType:
        """The same stitch seen from the back of the fabric; a row on the wrong side works it."""
        return _of_sites(tuple(site.turned_over(self.takes) for site in reversed(self.sites)))


def _single(code: str, name: str, words: str, site: Site = Site()) -> StitchType:
    return StitchType(code, name, words, (site,))


def _pulled(order: tuple[int, ...] = (0,), *, purl: bool = False, turn: int = 0) -> Site:
    return Site(sources=order, purl=purl, turn=turn)


KNIT = _single("K", "knit", "k")
PURL = _single("P", "purl", "p", _pulled(purl=True))

_SINGLES = (
    KNIT,
    PURL,
    _single("B", "knit through the back loop", "k tbl", _pulled(turn=1)),
    _single("b", "purl through the back loop", "p tbl", _pulled(purl=True, turn=1)),
    _single("[B']", "knit, twisted the other way", "k tw", _pulled(turn=-1)),
    _single("[b']", "purl, twisted the other way", "p tw", _pulled(purl=True, turn=-1)),
    _single("O", "yarn over", "yo", Site(YarnAct.OVER, ())),
    _single("V", "slip, yarn in back", "sl1 wyib", Site(YarnAct.MISS)),
    _single("v", "slip, yarn in front", "sl1 wyif", Site(YarnAct.MISS, front=True)),
    _single("T", "tuck", "tuck", Site(YarnAct.OVER)),
    _single("t", "tuck, yarn in front", "tuck wyif", Site(YarnAct.OVER, purl=True)),
    _single("/", "knit 2 together", "k2tog", _pulled((0, 1))),
    _single("\\", "slip, slip, knit", "ssk", _pulled((1, 0))),
    _single(")", "purl 2 together", "p2tog", _pulled((0, 1), purl=True)),
    _single("(", "slip, slip, purl", "ssp", _pulled((1, 0), purl=True)),
    _single(
        "[K10']", "knit 2 together through the back loops", "k2tog tbl", _pulled((1, 0), turn=1)
    ),
    _single(
        "[P10']",
        "purl 2 together through the back loops",
        "p2tog tbl",
        _pulled((1, 0), purl=True, turn=1),
    ),
    _single(
        "[K01']", "knit 2 together, twisted the other way", "k2tog tw", _pulled((0, 1), turn=-1)
    ),
    _single(
        "[P01']",
        "purl 2 together, twisted the other way",
        "p2tog tw",
        _pulled((0, 1), purl=True, turn=-1),
    ),
    _single("^", "centred double decrease", "s2kp2", _pulled((1, 2, 0))),
    _single("[P201]", "centred double decrease, purled", "s2pp2", _pulled((2, 0, 1), purl=True)),
    _single("L", "slip 1, knit 2 together, pass over", "sk2p", _pulled((2, 0, 1))),
    _single("[P120]", "slip 1, purl 2 together, pass over", "sp2p", _pulled((1, 2, 0), purl=True)),
    _single("R", "knit 3 together", "k3tog", _pulled((0, 1, 2))),
    _single("J", "purl 3 together", "p3tog", _pulled((0, 1, 2), purl=True)),
    _single("[K210]", "slip, slip, slip, knit", "sssk", _pulled((2, 1, 0))),
    _single("[P210]", "slip, slip, slip, purl", "sssp", _pulled((2, 1, 0), purl=True)),
    _single("[K102]", "centred double decrease, left under", "s2kp2 left", _pulled((1, 0, 2))),
    _single(
        "[P021]",
        "centred double decrease, left under, purled",
        "s2pp2 left",
        _pulled((0, 2, 1), purl=True),
    ),
    _single("[K021]", "knit 3 together, right under", "k3tog right", _pulled((0, 2, 1))),
    _single("[P102]", "purl 3 together, right under", "p3tog right", _pulled((1, 0, 2), purl=True)),
)


def cable(over: int, under: int, *, right: bool, purl_over: bool, purl_under: bool) -> StitchType:
    """Make a cable in which ``over`` stitches pass in front of ``under`` others.

    In a right cross those in front move to the right. Written ``[2/1RP]``: those behind are
    purled; ``PP``: all are; ``PK``: only those in front are.
    """
    front = [Site(purl=purl_over, layer=1, sources=(i,)) for i in range(over)]
    behind = [Site(purl=purl_under, layer=-1, sources=(i,)) for i in range(under)]
    first, last = (behind, front) if right else (front, behind)
    shifted = [*(replace(site, sources=(site.sources[0] + len(last),)) for site in first), *last]
    purls = {(False, False): "", (False, True): "P", (True, True): "PP", (True, False): "PK"}
    suffix = purls[purl_over, purl_under]
    side = "R" if right else "L"
    words = f"{over}/{under} {side}{suffix}C"
    name = f"{over}/{under} {'right' if right else 'left'} cross"
    extra = {"": "", "P": ", purled behind", "PP": ", purled", "PK": ", purled in front"}[suffix]
    return StitchType(f"[{over}/{under}{side}{suffix}]", name + extra, words, tuple(shifted))


def _cables() -> list[StitchType]:
    counts = range(1, MAX_CABLE_STITCHES + 1)
    sides = (False, True)
    return [
        cable(over, under, right=right, purl_over=purl_over, purl_under=purl_under)
        for over, under in product(counts, counts)
        for right, purl_over, purl_under in product((True, False), sides, sides)
    ]


STITCHES: tuple[StitchType, ...] = (*_SINGLES, *_cables())
"""All stitches; a chart's cells hold their places here, knit and purl first."""

BY_CODE = {stitch.code: place for place, stitch in enumerate(STITCHES)}
"""The place of each code in :data:`STITCHES`."""


@cache
def _places() -> dict[tuple[Site, ...], int]:
    return {stitch.sites: place for place, stitch in enumerate(STITCHES)}


def place_of(sites: tuple[Site, ...]) -> int | None:
    """Find the stitch of these sites: its place in :data:`STITCHES`, None if there is none."""
    return _places().get(sites)


def _of_sites(sites: tuple[Site, ...]) -> StitchType:
    return STITCHES[_places()[sites]]
