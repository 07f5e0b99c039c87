"""One image of a repeat for all: shifted, mirrored or turned over, it is the same cloth.

Where yarn lies depends on the smallest of changes wherever cloth may fold in several ways, so that
images of a repeat would rest differently. One of them is relaxed for all.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Array
from knitcore.chart.symbol_chart import CONTINUED, SymbolChart


@dataclass(frozen=True)
class ChartImage:
    """An image of a repeat.

    Attributes
    ----------
    chart : the image.
    row, column : where it begins in the repeat that was mirrored and turned.
    mirrored, turned : whether the repeat was mirrored, and turned over.
    """

    chart: SymbolChart
    row: int
    column: int
    mirrored: bool
    turned: bool

    @classmethod
    def least(cls, chart: SymbolChart) -> ChartImage:
        """The image that is relaxed for all: the first by its text."""
        return min(_images(chart), key=lambda image: image.chart.text)

    def rows_back(self, values: Array) -> Array:
        """Values of the image's rows in the order of the repeat's."""
        return np.asarray(np.roll(values, self.row, axis=0))

    def lines_back(self, lines: Array, course_mm: float, wale_mm: float) -> Array:
        """Lay the centre lines of the image, (rows, points, 3), mm, where the repeat has them."""
        rows = self.chart.rows
        placed = self.rows_back(lines).copy()
        placed[..., 0] += self.column * course_mm
        climbed = np.arange(rows) - (np.arange(rows) - self.row) % rows
        placed[..., 1] += wale_mm * climbed[:, None]
        if self.turned:
            placed[..., 2] *= -1.0
        if self.mirrored != self.turned:
            placed[..., 0] = self.chart.columns * course_mm - placed[..., 0]
            placed = placed[:, ::-1]
        return np.asarray(placed)


def _images(chart: SymbolChart) -> Iterator[ChartImage]:
    for turned in (False, True):
        side = chart.turn_over() if turned else chart
        for mirrored in (False, True):
            seen = side.mirror() if mirrored else side
            for column in _cuts(seen):
                for row in range(chart.rows):
                    cells = np.roll(seen.cells, (-row, -column), axis=(0, 1))
                    yield ChartImage(SymbolChart(cells), row, column, mirrored, turned)


def _cuts(chart: SymbolChart) -> list[int]:
    """Columns at which every row has taken just the loops below, and cuts no cable."""
    first = chart.graph.first
    taken = first[:, :-1] - first[:, :1] == np.arange(chart.columns)
    whole = (taken & (chart.cells != CONTINUED)).all(axis=0)
    return np.flatnonzero(whole).tolist()
