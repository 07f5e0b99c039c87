"""Charts with an outline; cells outside it are "no stitch"."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from knitcore.base import showing
from knitcore.base.arrays import Mask
from knitcore.base.errors import InputError
from knitcore.chart.phases import continued
from knitcore.chart.stitch_chart import StitchChart, size_in_words

INSIDE, OUTSIDE = "x", "."


@dataclass(frozen=True, eq=False)
class ShapedChart:
    """A chart and which of its cells are stitches.

    Parameters
    ----------
    chart : K/P of every cell; its value at "no stitch" has no meaning.
    stitch : bool (rows, columns), row 0 at the bottom.

    Raises
    ------
    InputError
        If the outline cannot be knitted as one piece: an empty row, a row in two parts, or a row
        that does not overlap the one below.
    """

    chart: StitchChart
    stitch: Mask

    def __post_init__(self) -> None:
        inside = np.array(self.stitch, dtype=bool)
        check_outline_size(inside, self.chart)
        check_outline(inside)
        inside.setflags(write=False)
        object.__setattr__(self, "stitch", inside)

    def __str__(self) -> str:
        size = size_in_words(self.chart.columns, self.chart.rows)
        return f"{np.count_nonzero(self.stitch)} stitches in {size}"

    @classmethod
    def rectangle(cls, chart: StitchChart) -> ShapedChart:
        """A chart without "no stitch"."""
        return cls(chart, np.ones_like(chart.purl))

    @classmethod
    def parse(cls, chart: str, outline: str) -> ShapedChart:
        """Read K/P lines and lines of ``x`` (stitch) and ``.`` (no stitch), the top row first."""
        return cls(StitchChart.parse(chart), outline_marks(outline))

    @property
    def outline(self) -> str:
        """Lines of ``x`` and ``.``, the top row first; :meth:`parse` reads them back."""
        rows = self.stitch[::-1]
        return "\n".join("".join(INSIDE if s else OUTSIDE for s in row) for row in rows)

    @property
    def is_rectangle(self) -> bool:
        """True if every cell is a stitch."""
        return bool(self.stitch.all())

    @property
    def stitches(self) -> int:
        """Number of stitches."""
        return int(np.count_nonzero(self.stitch))

    @property
    def spans(self) -> tuple[tuple[int, int], ...]:
        """First column and one past the last of every row, from the bottom."""
        first = self.stitch.argmax(axis=1)
        last = self.chart.columns - self.stitch[:, ::-1].argmax(axis=1)
        return tuple(zip(first.tolist(), last.tolist(), strict=True))

    def continued(self) -> StitchChart:
        """The chart :func:`~knitcore.chart.phases.continued` beyond its outline."""
        return continued(self.chart, self.stitch)

    def rectangle_inside(self) -> StitchChart:
        """The largest rectangle of stitches, for which effective moduli can be given."""
        if self.is_rectangle:
            return self.chart
        return StitchChart(self.chart.purl[largest_rectangle(self.stitch)])

    def _repr_html_(self) -> str:
        size = f"{self.stitches} stitches in {self.chart.columns} columns × {self.chart.rows} rows"
        return showing.captioned(showing.stitches(self.chart.purl, self.stitch), size)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, ShapedChart) or not np.array_equal(self.stitch, other.stitch):
            return False
        return np.array_equal(self.chart.purl[self.stitch], other.chart.purl[other.stitch])

    def __hash__(self) -> int:
        return hash((self.stitch.tobytes(), self.chart.purl[self.stitch].tobytes()))


def outline_marks(outline: str) -> Mask:
    """Read an outline as a mask (rows, columns) of stitches, row 0 at the bottom.

    Raises
    ------
    InputError
        If it is not a grid of ``x`` and ``.``.
    """
    marks = [line.strip() for line in outline.splitlines() if line.strip()]
    if not marks or len({len(line) for line in marks}) > 1 or set("".join(marks)) - set("x."):
        raise InputError("outline", "it is not a grid of x and dots.", "Write x or . per stitch.")
    return np.array([[mark == INSIDE for mark in line] for line in marks[::-1]])


def check_outline_size(stitch: Mask, chart: StitchChart) -> None:
    """Refuse an outline of another size than the chart."""
    if stitch.shape != chart.purl.shape:
        size = f"{stitch.shape[-1]}x{stitch.shape[0]} cells, the chart {chart.columns}x{chart.rows}"
        raise InputError(
            "outline", f"it has {size}.", "Give one mark for every stitch of the chart."
        )


def check_outline(stitch: Mask) -> None:
    """Refuse an outline in several parts, naming the row."""
    spans = []
    for row, inside in enumerate(stitch, start=1):
        columns = np.flatnonzero(inside)
        if len(columns) == 0:
            raise InputError(
                "outline", f"row {row} has no stitch.", "Crop the chart, or fill the row."
            )
        if columns[-1] - columns[0] + 1 != len(columns):
            problem = f"row {row} is in two parts, which one yarn cannot knit in one row."
            raise InputError("outline", problem, "Close the gap, or make it two pieces.")
        spans.append((int(columns[0]), int(columns[-1])))
    for row, (below, above) in enumerate(pairwise(spans), start=1):
        if above[0] > below[1] or above[1] < below[0]:
            problem = f"row {row + 1} does not stand on row {row}: the outline is in several parts."
            remedy = "Let neighbouring rows overlap by at least one stitch."
            raise InputError("outline", problem, remedy)


def largest_rectangle(stitch: Mask) -> tuple[slice, slice]:
    """Rows and columns of the rectangle with the most stitches that lies wholly inside.

    Row by row, each column has a height: the stitches without a gap down from this row. The
    largest rectangle with its top in the row is the largest one under these heights, found with a
    stack of columns whose heights rise. If several are equal, the lowest is taken.

    Parameters
    ----------
    stitch : bool (rows, columns), where there is a stitch; empty slices if there is none.
    """
    most, best = 0, (slice(0, 0), slice(0, 0))
    heights = np.zeros(stitch.shape[1] + 1, dtype=int)  # the last one ends every rectangle
    for row, inside in enumerate(stitch, start=1):
        heights[:-1] = np.where(inside, heights[:-1] + 1, 0)
        rising: list[tuple[int, int]] = []  # first column and height
        for column, height in enumerate(heights.tolist()):
            first = column
            while rising and rising[-1][1] >= height:
                first, tall = rising.pop()
                if tall * (column - first) > most:
                    most = tall * (column - first)
                    best = slice(row - tall, row), slice(first, column)
            rising.append((first, height))
    return best
