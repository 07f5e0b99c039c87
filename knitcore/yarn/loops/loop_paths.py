"""The first shape of the yarn of any stitches, every crossing on its intended side.

Every row has a zone of nodes. There a new loop comes from behind what its needle holds (a knit) or
from before it (a purl), passes through it and leaves on the other side; the yarn of slipped and
tucked stitches passes behind or in front of it. Between two rows lies a zone in which loops lean
to their new columns. A loop is in its layer before it leans and stays there until it has arrived.
The zone is the higher the farther a loop of the repeat leans, so that no leg lies flat.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy

from knitcore.base.arrays import Array, Indices
from knitcore.chart.stitch_kinds import YarnAct
from knitcore.yarn.loops.held_loops import INNER, HeldLoop, HeldLoops, YarnLoop

FOOT_LEFT, LEG_LEFT, HEAD, LEG_RIGHT, FOOT_RIGHT = range(5)
"""Parts of a loop; the yarn of a slipped stitch is a left foot."""
PARTS = 5

_NODES = 0.3
"""Half the height of the zone of nodes, in heights of a plain row."""
_FEET = -0.12
_LEGS = 0.02
"""Height at which legs are through, below all heads."""
_LOWEST_HEAD, _HIGHEST_HEAD = 0.1, 0.2
_CORNER = 0.06
"""Depth of a head below which its legs are upright."""
_ROUND = 0.75
"""Part of a head's width that is level."""
_SETTLED = 0.1
"""Height over which a loop changes its layer."""
_LEAN = 0.3
"""Height of the zone between rows where no loop leans, and its least slope beyond that."""
_SLOPE = 0.8
_BEFORE = 0.47
"""Distance from a needle, in wales, at which the yarn of its row has its layer."""
_FINE = 12
"""Points of the curve from one given point to the next."""


Point = tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class YarnPath:
    """The yarn of one row, once across the repeat.

    Attributes
    ----------
    points : (n, 3) in wales, heights of a plain row and layers; the end is not repeated.
    part : (n,) column times :data:`PARTS` and the part of the site's yarn from each point on.
    columns : of the repeat.
    """

    points: Array
    part: Indices
    columns: int


@dataclass(frozen=True, eq=False)
class LoopPaths:
    """The paths of the yarn of a repeat.

    Parameters
    ----------
    held : the loops on its needles.
    yarn_over : half the width of the foot of a yarn over, in wales.
    """

    held: HeldLoops
    yarn_over: float = INNER

    @cached_property
    def heights(self) -> Array:
        """(rows + 1,) height of each row's nodes, and of those of the next repeat."""
        graph = self.held.graph
        lean = np.zeros(graph.rows)
        for row in range(graph.rows):
            sites = np.repeat(np.arange(graph.columns), np.diff(graph.first[row]))
            source = graph.source[graph.first[row, 0] : graph.first[row, -1]]
            lean[row - 1] = np.abs(source - sites).max()
            if graph.turn[row].any():
                lean[row - 1] = max(lean[row - 1], 1)
        steps = 2.0 * (_NODES + _SETTLED) + np.maximum(_LEAN, _SLOPE * lean)
        return np.concatenate([[0.0], np.cumsum(steps)])

    def height(self, row: int) -> float:
        """Height of a row's nodes in any copy of the repeat."""
        copy, at = divmod(row, self.held.graph.rows)
        return self._heights[at] + copy * self._heights[-1]

    @cached_property
    def _heights(self) -> list[float]:
        heights: list[float] = self.heights.tolist()
        return heights

    def of_row(self, row: int) -> YarnPath:
        """The path of a row's yarn."""
        columns = self.held.graph.columns
        given, part = self.knots(row)
        period = np.array([columns, 0.0, 0.0])
        around = np.concatenate([given[-2:] - period, given, given[:3] + period])
        place = np.arange(len(around)) - 2.0
        fine = np.arange(len(given) * _FINE) / _FINE
        curve = scipy.interpolate.PchipInterpolator(place, around)(fine)
        return YarnPath(curve, np.repeat(part, _FINE), columns)

    def knots(self, row: int) -> tuple[Array, Indices]:
        """Points (n, 3) through which a row's yarn goes, and the part that each begins."""
        knots: list[Point] = []
        part: list[int] = []
        for column in range(self.held.graph.columns):
            for name, points in enumerate(self._site(row, column)):
                knots += points
                part += [column * PARTS + name] * len(points)
        return np.array(knots), np.array(part)

    def _site(self, row: int, column: int) -> list[list[Point]]:
        """Points of each part of a site's yarn, from the middle between it and the last."""
        y = self.height(row) + _FEET
        z = self._feet(row, column)
        start = (column - 0.5, y, 0.5 * (z + self._feet(row, column - 1)))
        if self.held.act(row, column) is YarnAct.MISS:
            return [[start, (column - _BEFORE, y, z), (column + _BEFORE, y, z)]]
        *left, corner, level = self._leg(row, column, -1)
        *right, last_corner, last_level = self._leg(row, column, 1)
        inner = self._inner(row, column)
        return [
            [start, (column - _BEFORE, y, z)],
            [(column - inner, y, z), *left],
            [corner, level, last_level],
            [last_corner, *right[::-1]],
            [(column + inner, y, z), (column + _BEFORE, y, z)],
        ]

    def _inner(self, row: int, column: int) -> float:
        """Half the width of a loop at its foot."""
        is_pulled_through = self.held.depth(row, column) > 0
        return INNER if is_pulled_through else self.yarn_over

    def _feet(self, row: int, column: int) -> float:
        """Layer of the feet of a site, or of the yarn that passes it."""
        depth = self.held.depth(row, column)
        return float(-depth if self.held.behind(row, column) else depth)

    def _leg(self, row: int, column: int, side: int) -> list[Point]:
        """Points of one leg of a loop, from its foot up; the last two are of the head."""
        loop, at, base = YarnLoop(row, column), YarnLoop(row, column), self.height(row)
        x, z = column + side * self._inner(row, column), self._feet(row, column)
        points: list[Point] = []
        if self.held.act(row, column) is YarnAct.THROUGH:
            z = -z
            points.append((x, base + _LEGS, z))
        while True:
            points.append((x, base + _NODES, z))
            at = self.held.taken_by(*at)
            held = next(held for held in self.held.on_needle(*at) if held.loop == loop)
            passing = self._passing(at, held, side)
            points.append((x, base + _NODES + _SETTLED, passing))
            if self.held.turn(*at) % 2:
                side = -side
            base, z = self.height(at.row), float(held.layer)
            x = at.column + held.aside + side * held.half_width
            points.append((x, base - _NODES - _SETTLED, passing))
            points.append((x, base - _NODES, z))
            if self.held.act(*at) is YarnAct.THROUGH:
                break
        rise = (_HIGHEST_HEAD - _LOWEST_HEAD) * held.rise / max(self.held.depth(*at) - 1, 1)
        top = base + _LOWEST_HEAD + rise
        level = at.column + held.aside + _ROUND * side * held.half_width
        return [*points, (x, top - _CORNER, z), (level, top, z)]

    def _passing(self, taker: YarnLoop, held: HeldLoop, side: int) -> float:
        """Layer of a leg on its way to its taker's needle."""
        turn = self.held.turn(*taker)
        if turn % 2 == 0:
            depth = self.held.depth(*taker)
            return float(held.layer + 2 * depth * self.held.passing(*taker))
        # legs from the right pass in front of those from the left, or behind
        legs = sorted(s * h.half_width for h in self.held.on_needle(*taker) for s in (-1, 1))
        rank = legs.index(side * held.half_width)
        return float(np.sign(turn) * (2 * rank + 1 - len(legs)))
