"""The stitch graph: what every loop is pulled through, held by or laid over, and in which order."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from knitcore.base.arrays import Codes, Indices, Mask
from knitcore.chart.stitch_kinds import YarnAct

Signs = NDArray[np.int8]


@dataclass(frozen=True, eq=False, repr=False)
class StitchGraph:
    """The sites of one repeat, which continues in both directions, and what each takes.

    A site is one needle in one row. It takes loops of the row below; what it takes but does not
    pull a loop through, it still holds, and its taker in the row above takes all of it.

    Parameters
    ----------
    act : array (rows, columns) of :class:`YarnAct`.
    purl : array (rows, columns); the loop is drawn to the back, a tuck's strand lies in front.
    front : array (rows, columns); the yarn passes in front of a slipped stitch.
    turn : array (rows, columns) of half turns of the loop that a site takes.
    first : array (rows, columns + 1); the sources of a site are ``source[first[j, i]:first[j, i +
        1]]``, the front of the fabric first.
    source : array (edges,) of columns in the row below, which may lie beyond the repeat's edge.
    layer : array (edges,), +1 where the loop passes in front of others that change places, -1
        behind, 0 where none cross.
    """

    act: Codes
    purl: Mask
    front: Mask
    turn: Signs
    first: Indices
    source: Indices
    layer: Signs

    @property
    def rows(self) -> int:
        """Number of rows of the repeat."""
        return int(self.act.shape[0])

    @property
    def columns(self) -> int:
        """Number of columns of the repeat."""
        return int(self.act.shape[1])

    def __repr__(self) -> str:
        return f"StitchGraph({self.rows} rows, {self.columns} columns)"

    def sources(self, row: int, column: int) -> Indices:
        """Columns of the row below that a site takes, the front of the fabric first.

        ``row`` and ``column`` may lie in any copy of the repeat.
        """
        copy, at = divmod(column, self.columns)
        first = self.first[row % self.rows]
        return self.source[first[at] : first[at + 1]] + copy * self.columns

    def layers(self, row: int, column: int) -> Signs:
        """Layer of each loop of :meth:`sources`."""
        first = self.first[row % self.rows]
        at = column % self.columns
        return self.layer[first[at] : first[at + 1]]

    def taker(self) -> Indices:
        """Column of the site in the row above that takes a site's loop, (rows, columns).

        It may lie beyond the repeat's edge, as sources may.
        """
        taker = np.empty(self.act.shape, dtype=np.intp)
        for row in range(self.rows):
            first = self.first[row]
            sites = np.repeat(np.arange(self.columns), np.diff(first))
            taken = self.source[first[0] : first[-1]]
            copy, below = np.divmod(taken, self.columns)
            taker[row - 1, below] = sites - copy * self.columns
        return taker

    def longest_float(self) -> int:
        """Most neighbouring stitches of a row that its yarn passes by, over the repeat's edge too.

        Examples
        --------
        >>> from knitcore.chart.symbol_chart import SymbolChart
        >>> SymbolChart.parse("VKKV;KKKK").graph.longest_float()
        2
        """
        missed = np.tile(self.act == YarnAct.MISS, 2).astype(int)
        run, longest = np.zeros(self.rows, dtype=int), 0
        for column in missed.T:
            run = (run + 1) * column
            longest = max(longest, int(run.max()))
        return min(longest, self.columns)

    def rows_held(self) -> Indices:
        """Rows that a site's loop is held for before a loop is pulled through it, (rows, columns).

        0 where the row above knits it; -1 where it is held for ever. A slipped site makes no loop;
        it holds what it takes, and its number is that of those loops from there on.
        """
        taker, through = self.taker(), self.act == YarnAct.THROUGH
        held = np.full(self.act.shape, -1, dtype=np.intp)
        row, column = np.indices(self.act.shape)
        waits = np.ones(self.act.shape, dtype=bool)
        for rows in range(self.act.size):
            row, column = (row + 1) % self.rows, taker[row, column] % self.columns
            ends = waits & through[row, column]
            held[ends] = rows
            waits &= ~ends
            if not waits.any():
                break
        return held
