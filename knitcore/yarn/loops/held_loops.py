"""The loops that every needle holds, their order, and where they lie side by side.

A row has two levels. On the *nodes* a new loop meets those that it is pulled through, and held
loops meet the yarn that passes them. *Between* a row and the next every loop changes over to the
column of the site that takes it, some in front of others.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple, TypeVar

import numpy as np

from knitcore.base.arrays import Indices
from knitcore.base.errors import InputError
from knitcore.chart.stitch_graph import StitchGraph
from knitcore.chart.stitch_kinds import YarnAct

Value = TypeVar("Value")

INNER = 0.14
"""Half the width of a new loop where it is pulled through others, in wales."""
_OUTER, _WIDEST = 0.29, 0.40
"""Half the width of the loops that are held, the youngest and the oldest, in wales."""
_ASIDE = 0.05
"""Distance between loops of neighbouring columns on one needle, in wales."""


class YarnLoop(NamedTuple):
    """A loop of yarn, named by the site that made it, in any copy of the repeat."""

    row: int
    column: int


class HeldLoop(NamedTuple):
    """A loop on a needle.

    Attributes
    ----------
    loop : the loop.
    layer : its place from the front, between 1 - n and n - 1 in steps of 2 for n loops.
    aside : how far its middle lies to the right of the needle, in wales.
    half_width : half its width, in wales.
    rise : place of its head among the others', 0 the lowest.
    """

    loop: YarnLoop
    layer: int
    aside: float
    half_width: float
    rise: int


@dataclass(frozen=True, eq=False)
class HeldLoops:
    """The loops on all needles of a graph.

    Raises
    ------
    InputError
        If loops that are knitted together are twisted, which is not drawn.
    """

    graph: StitchGraph

    def __post_init__(self) -> None:
        together = np.diff(self.graph.first, axis=1) > 1
        for row, column in np.argwhere(together & (self.graph.turn != 0)):
            raise InputError(
                "chart",
                f"row {row + 1}, stitch {column + 1} twists loops that it knits together, which "
                "the yarn level does not draw.",
                "Knit them together without a twist.",
            )

    @cached_property
    def taker(self) -> Indices:
        """Column of the site above that takes a site's loops, (rows, columns)."""
        return self.graph.taker()

    def taken_by(self, row: int, column: int) -> YarnLoop:
        """The site that takes what a site hands up."""
        takers = self._takers[row % len(self._takers)]
        copy, at = divmod(column, len(takers))
        return YarnLoop(row + 1, takers[at] + copy * len(takers))

    def act(self, row: int, column: int) -> YarnAct:
        """The act of a site."""
        return self._at(self._acts, row, column)

    def turn(self, row: int, column: int) -> int:
        """Half turns of what a site takes."""
        return self._at(self._turns, row, column)

    def behind(self, row: int, column: int) -> bool:
        """Tell whether a site's yarn comes from behind the loops that it holds."""
        return self._at(self._behind, row, column)

    @staticmethod
    def _at(values: list[list[Value]], row: int, column: int) -> Value:
        """A site's value in any copy of the repeat."""
        line = values[row % len(values)]
        return line[column % len(line)]

    # Lists of Python's own numbers: single values of arrays take ten times as long.

    @cached_property
    def _acts(self) -> list[list[YarnAct]]:
        return [[YarnAct(act) for act in row] for row in self.graph.act.tolist()]

    @cached_property
    def _turns(self) -> list[list[int]]:
        turns: list[list[int]] = self.graph.turn.tolist()
        return turns

    @cached_property
    def _behind(self) -> list[list[bool]]:
        missed = self.graph.act == YarnAct.MISS
        behind: list[list[bool]] = (~np.where(missed, self.graph.front, self.graph.purl)).tolist()
        return behind

    @cached_property
    def _takers(self) -> list[list[int]]:
        takers: list[list[int]] = self.taker.tolist()
        return takers

    def on_needle(self, row: int, column: int) -> tuple[HeldLoop, ...]:
        """The loops that a site takes, the front of the fabric first."""
        copy, at = divmod(column, self.graph.columns)
        row_copy, row = divmod(row, self.graph.rows)
        if copy == row_copy == 0:
            return self._needles[row][at]
        shift = row_copy * self.graph.rows, copy * self.graph.columns
        return tuple(
            held._replace(loop=YarnLoop(held.loop.row + shift[0], held.loop.column + shift[1]))
            for held in self._needles[row][at]
        )

    @cached_property
    def _needles(self) -> list[list[tuple[HeldLoop, ...]]]:
        shape = self.graph.rows, self.graph.columns
        return [
            [self._placed(row, column) for column in range(shape[1])] for row in range(shape[0])
        ]

    def _taken(self, row: int, column: int) -> list[tuple[YarnLoop, int]]:
        """Loops that a site takes, from the front, with the column that each comes from."""
        taken = [
            (loop, int(source))
            for source in self.graph.sources(row, column)
            for loop in self._handed_up(row - 1, int(source))
        ]
        return taken[::-1] if self.turn(row, column) % 2 else taken

    def _handed_up(self, row: int, column: int) -> list[YarnLoop]:
        own, act = [YarnLoop(row, column)], self.act(row, column)
        if act is YarnAct.THROUGH:
            return own
        held = [loop for loop, _ in self._taken(row, column)]
        if act is YarnAct.MISS:
            return held
        return held + own if self.behind(row, column) else own + held

    def _placed(self, row: int, column: int) -> tuple[HeldLoop, ...]:
        """The loops on a needle, laid side by side: old ones around young ones."""
        taken = self._taken(row, column)
        count = len(taken)
        if not count:
            return ()
        sources = sorted({source for _, source in taken})
        rows = sorted({loop.row for loop, _ in taken}, reverse=True)
        middle, wider = 0.5 * (len(sources) - 1), (_WIDEST - _OUTER) / max(len(rows) - 1, 1)
        # the head nearest to the new loop's legs is the highest of those of one age
        nearest = range(count) if self.behind(row, column) else range(count - 1, -1, -1)
        rise = sorted(nearest, key=lambda k: (-taken[k][0].row, -nearest.index(k)))
        return tuple(
            HeldLoop(
                loop,
                count - 1 - 2 * k,
                _ASIDE * (sources.index(source) - middle),
                _OUTER + wider * rows.index(loop.row),
                rise.index(k),
            )
            for k, (loop, source) in enumerate(taken)
        )

    def depth(self, row: int, column: int) -> int:
        """Layer of what lies behind, or in front of, all loops on a needle."""
        return len(self._at(self._needles, row, column))

    def passing(self, row: int, column: int) -> int:
        """1 where the loops that a site takes pass in front of others on their way, -1 behind."""
        return int(self.graph.layers(row, column)[:1].sum())
