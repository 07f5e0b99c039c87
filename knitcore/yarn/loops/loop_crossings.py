"""The crossings of yarn over yarn: those that a graph asks for, and those of drawn curves.

Every crossing has the same place in both lists: the parts of the loops that cross, the upper one
first. Where loops only lie one behind the other, as in decreases and tucks, the graph asks for no
number of crossings, but none may be the other way round.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import combinations, product
from typing import NamedTuple

import numpy as np

from knitcore.base.arrays import Array, Indices
from knitcore.chart.stitch_graph import StitchGraph
from knitcore.chart.stitch_kinds import YarnAct
from knitcore.yarn.loops.held_loops import HeldLoops, YarnLoop
from knitcore.yarn.loops.loop_paths import FOOT_LEFT, FOOT_RIGHT, HEAD, LEG_LEFT, LEG_RIGHT, PARTS
from knitcore.yarn.solve.clasps import crossings

_LEGS = LEG_LEFT, LEG_RIGHT
_FEET = FOOT_LEFT, FOOT_RIGHT
_TILT = np.array([3.7e-4, 1.9e-4])
"""Direction of view: a little off the normal, so that no crossing lies on two points at once."""


class Strand(NamedTuple):
    """A part of a loop."""

    row: int
    column: int
    part: int


class Crossing(NamedTuple):
    """An upper strand and a lower one, of which the lower one is in the repeat itself."""

    upper: Strand
    lower: Strand


@dataclass(frozen=True, eq=False)
class Crossings:
    """The crossings that a graph asks for.

    Attributes
    ----------
    exact : how often each must be there.
    layered : pairs that may cross, in this order only.
    """

    exact: Counter[Crossing]
    layered: frozenset[Crossing]

    @classmethod
    def of(cls, graph: StitchGraph) -> Crossings:
        """List those of every site."""
        held, rows, columns = HeldLoops(graph), range(graph.rows), range(graph.columns)
        pairs = [pair for site in product(rows, columns) for pair in _at(held, YarnLoop(*site))]
        pairs += [pair for row in rows for pair in _of_cables(held, row)]
        repeat = graph.rows, graph.columns
        return cls(
            Counter(_within(repeat, *pair) for layered, *pair in pairs if not layered),
            frozenset(_within(repeat, *pair) for layered, *pair in pairs if layered),
        )

    def wrong(self, drawn: Counter[Crossing]) -> list[Crossing]:
        """Crossings that are missing, too many or on the wrong side."""
        return [
            crossing
            for crossing in sorted(self.exact.keys() | drawn.keys())
            if drawn[crossing] < self.exact[crossing]
            or (drawn[crossing] > self.exact[crossing] and crossing not in self.layered)
        ]


Pair = tuple[bool, Strand, Strand]


def _at(held: HeldLoops, site: YarnLoop) -> Iterator[Pair]:
    """Crossings on a needle, and of its loops with each other on their way to it."""
    act, behind, loops = held.act(*site), held.behind(*site), held.on_needle(*site)
    swapped = held.turn(*site) % 2 == 1
    for left in (True, False):
        foot = Strand(*site, FOOT_LEFT if left or act is YarnAct.MISS else FOOT_RIGHT)
        leg = Strand(*site, LEG_LEFT if left else LEG_RIGHT)
        for on in loops:
            passed = Strand(*on.loop, _leg_at(held, on.loop, site, left))
            yield (act is YarnAct.OVER, *_over(passed, foot, behind))
            if act is YarnAct.THROUGH:
                yield (False, *_over(leg, Strand(*on.loop, HEAD), behind))
    if swapped:
        yield from _twists(held, site)
    else:
        for front, back in combinations(loops, 2):
            parts = product((*_LEGS, HEAD), repeat=2)
            yield from ((True, Strand(*front.loop, a), Strand(*back.loop, b)) for a, b in parts)


def _over(front: Strand, back: Strand, behind: bool) -> tuple[Strand, Strand]:
    return (front, back) if behind else (back, front)


def _leg_at(held: HeldLoops, loop: YarnLoop, site: YarnLoop, left: bool) -> int:
    """The leg of a loop that is on the left, or right, of a needle."""
    at, swapped = loop, False
    while at != site:
        at = held.taken_by(*at)
        swapped ^= held.turn(*at) % 2 == 1
    return LEG_LEFT if left != swapped else LEG_RIGHT


def _twists(held: HeldLoops, site: YarnLoop) -> Iterator[Pair]:
    """Crossings of legs that turn half round: each with each other one."""
    loops = sorted(held.on_needle(*site), key=lambda on: on.half_width)
    right = [Strand(*on.loop, _leg_at(held, on.loop, site, True)) for on in loops]
    left = [Strand(*on.loop, _leg_at(held, on.loop, site, False)) for on in loops[::-1]]
    for first, then in combinations(left + right, 2):
        yield (False, *_over(then, first, held.turn(*site) > 0))


def _of_cables(held: HeldLoops, row: int) -> Iterator[Pair]:
    """Crossings of loops that change places on the way to a row's needles."""
    passing = [c for c in range(held.graph.columns) if held.passing(row, c)]
    for first, then in combinations(passing, 2):
        if held.graph.sources(row, first)[0] < held.graph.sources(row, then)[0]:
            continue
        in_front = held.passing(row, first) > 0
        for left, right in product(held.on_needle(row, first), held.on_needle(row, then)):
            for a, b in product(_LEGS, repeat=2):
                pair = Strand(*left.loop, a), Strand(*right.loop, b)
                yield (False, *_over(*pair, in_front))


def drawn_crossings(
    lines: Array, parts: Indices, width_mm: float, height_mm: float
) -> Counter[Crossing]:
    """Crossings of curves, seen from the face.

    Parameters
    ----------
    lines : (rows, points, 3) of the yarn of each row, once across the repeat, bottom row first.
    parts : (rows, points) which part of which site's loop each point begins
        (:class:`~knitcore.yarn.loops.loop_paths.YarnPath`).
    width_mm, height_mm : the repeat's period along the course and along the wale.
    """
    closed = np.concatenate([lines, lines[:, :1] + (width_mm, 0.0, 0.0)], axis=1)
    closed[..., :2] -= closed[..., 2:] * _TILT
    columns = int(parts.max()) // PARTS + 1
    drawn: Counter[Crossing] = Counter()
    last = parts.shape[1] - 1
    for low, low_at, up, up_at, across, above, _ in crossings(closed, width_mm, height_mm):
        lower = parts[int(low), min(int(low_at), last)]
        upper = parts[int(up), min(int(up_at), last)]
        drawn[
            Crossing(
                Strand(
                    int(up) + int(above) * len(lines),
                    int(upper) // PARTS + int(across) * columns,
                    int(upper) % PARTS,
                ),
                Strand(int(low), int(lower) // PARTS, int(lower) % PARTS),
            )
        ] += 1
    return drawn


def _within(repeat: tuple[int, int], upper: Strand, lower: Strand) -> Crossing:
    """The copy of a crossing whose lower strand is in the repeat."""
    up, across = (size * (place // size) for size, place in zip(repeat, lower[:2], strict=True))
    moved = [Strand(s.row - up, s.column - across, s.part) for s in (upper, lower)]
    return Crossing(*moved)
