"""Symbols of stitches, as strokes and dots in cells: after the Craft Yarn Council, or Japanese.

They are drawn from what a stitch does, so that a new stitch has one: an oblique stroke is the loop
that lies in front, of a cable and of a decrease; what lies behind it ends at it or is broken. A
ring is a yarn over, a V a slipped stitch, an arch a tuck, crossed legs a twisted stitch. A purl
has a dot or a dash, which is below the other signs. In Japanese charts every decrease has all its
legs and a knit is an upright line.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache

from knitcore.chart.stitch_kinds import Site, StitchType, YarnAct

Point = tuple[float, float]
Stroke = tuple[Point, ...]
GAP = 0.28
"""Width, in cells, by which a strand keeps away from the one in front of it."""
SHORT = 0.02
"""Share of a strand that is not drawn."""


@dataclass(frozen=True)
class StitchSymbol:
    """A symbol in a box as many cells wide as its stitch; y runs up from 0 to 1.

    Attributes
    ----------
    strokes : lines from point to point.
    dots : middles of filled circles.
    """

    strokes: tuple[Stroke, ...] = ()
    dots: tuple[Point, ...] = ()

    def __add__(self, other: StitchSymbol) -> StitchSymbol:
        return StitchSymbol(self.strokes + other.strokes, self.dots + other.dots)


@cache
def symbol_of(stitch: StitchType, *, dashes: bool = False, japanese: bool = False) -> StitchSymbol:
    """Draw a stitch.

    Parameters
    ----------
    dashes : whether purls have a dash instead of a dot.
    japanese : whether it is drawn as in Japanese charts, which have dashes.
    """
    dashes = dashes or japanese
    if stitch.width > 1:
        return _cable(stitch, dashes=dashes)
    (site,) = stitch.sites
    if site.act is YarnAct.THROUGH:
        return _pulled(site, dashes=dashes, japanese=japanese)
    if site.act is YarnAct.MISS:
        bar = ((0.2, 0.8), (0.8, 0.8)) if japanese else ((0.22, 0.45), (0.78, 0.45))
        return StitchSymbol((((0.2, 0.8), (0.5, 0.2), (0.8, 0.8)), *([bar] if site.front else [])))
    if not site.sources:
        return StitchSymbol((_arc((0.5, 0.5), 0.29, 0, 360),))
    arch = ((0.2, 0.2), *_arc((0.5, 0.5), 0.3, 180, 0), (0.8, 0.2))
    return StitchSymbol((arch,)) + _purl(site, (0.5, 0.4), dashes=dashes)


def _pulled(site: Site, *, dashes: bool, japanese: bool) -> StitchSymbol:
    if len(site.sources) > 1:
        return _decrease(site, dashes=dashes, all_legs=japanese or len(site.sources) > 2)
    if site.turn:
        return _loop(site.turn) + _purl(site, (0.5, 0.66), dashes=dashes)
    if site.purl and not dashes:
        return StitchSymbol((), ((0.5, 0.5),))
    if site.purl:
        return StitchSymbol((((0.22, 0.5), (0.78, 0.5)),))
    return StitchSymbol((((0.5, 0.22), (0.5, 0.78)),) if japanese else ())


def _purl(site: Site, dot: Point, *, dashes: bool) -> StitchSymbol:
    if not site.purl:
        return StitchSymbol()
    return StitchSymbol((((0.25, 0.08), (0.75, 0.08)),)) if dashes else StitchSymbol((), (dot,))


def _decrease(site: Site, *, dashes: bool, all_legs: bool) -> StitchSymbol:
    """The leg in front runs through; the next one ends at it, and the last one before it."""
    last = len(site.sources) - 1
    foot = {i: 0.2 + 0.6 * i / last for i in site.sources}
    front = foot[site.sources[0]]
    strokes: list[Stroke] = [((front, 0.18), (1 - front, 0.86))]
    for order, source in enumerate(site.sources[1:] if all_legs else ()):
        share = 1.0 - 0.35 * order
        end = (foot[source] + (0.5 - foot[source]) * share, 0.18 + 0.34 * share)
        strokes.append(((foot[source], 0.18), end))
    corner = 0.22 if front <= 0.5 else 0.78
    marks = _purl(site, (corner, 0.74), dashes=dashes)
    twist = _loop(site.turn, (1 - corner, 0.3), 0.5) if site.turn else StitchSymbol()
    return StitchSymbol(tuple(strokes)) + marks + twist


def _loop(turn: int, middle: Point = (0.5, 0.5), scale: float = 1.0) -> StitchSymbol:
    """Crossed legs under a ring, the left foot in front for a positive turn."""
    side = 1 if turn > 0 else -1
    through = [(-0.24, -0.34), (0.2, 0.14), *_arc((0.0, 0.16), 0.2, 0, 180)]
    behind = [(-0.2, 0.14), (-0.1, 0.03)], [(0.1, -0.19), (0.24, -0.34)]
    strokes = (through, *behind)
    return StitchSymbol(
        tuple(
            tuple((middle[0] + side * scale * x, middle[1] + scale * y) for x, y in stroke)
            for stroke in strokes
        )
    )


def _cable(stitch: StitchType, *, dashes: bool) -> StitchSymbol:
    """Lines from where each loop comes to where it goes, those behind broken at those in front."""
    ways = [(site.sources[0] + 0.5, column + 0.5) for column, site in enumerate(stitch.sites)]
    front = [way for way, site in zip(ways, stitch.sites, strict=True) if site.layer > 0]
    symbol = StitchSymbol()
    for (below, above), site in zip(ways, stitch.sites, strict=True):
        parts = [(0.0, 1.0)]
        if site.layer < 0:  # both lines are straight: it is hidden between two heights
            rise = (above - below) - (front[0][1] - front[0][0])
            ends = (front[0][0] - GAP - below) / rise, (front[-1][0] + GAP - below) / rise
            parts = [(0.0, max(min(ends), 0.0)), (min(max(ends), 1.0), 1.0)]
        strokes = tuple(
            tuple((below + (above - below) * t, 0.1 + 0.8 * t) for t in part)
            for part in parts
            if part[1] - part[0] > SHORT
        )
        dash = ((above - 0.25, 0.9), (above + 0.25, 0.9))
        marks = ((dash,), ()) if dashes else ((), ((above, 0.86),))
        symbol += StitchSymbol(strokes) + (StitchSymbol(*marks) if site.purl else StitchSymbol())
    return symbol


def _arc(middle: Point, radius: float, start: int, stop: int) -> Stroke:
    """A part of a circle, from an angle to another, in degrees against the clock from the right."""
    steps = max(abs(stop - start) // 15, 1)
    angles = [math.radians(start + (stop - start) * k / steps) for k in range(steps + 1)]
    return tuple(
        (middle[0] + radius * math.cos(a), middle[1] + radius * math.sin(a)) for a in angles
    )
