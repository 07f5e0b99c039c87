"""A piece of knitting: a chart, its outline, and which yarn knits each stitch (intarsia)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final

import numpy as np

from knitcore.base.arrays import Indices, Mask, runs
from knitcore.base.errors import InputError
from knitcore.chart.result import Result
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.symbol_chart import SymbolChart, knits_and_purls
from knitcore.garment.shaped import ShapedChart
from knitcore.prediction.size import RelaxedSize


@dataclass(frozen=True)
class PieceYarn:
    """A yarn of a piece: its name, and its colour as ``#rrggbb``."""

    name: str
    colour: str


MAIN_YARN: Final = PieceYarn("main yarn", "#efe9dd")
"""Yarn of stitches for which none is named."""


@dataclass(frozen=True)
class YarnRun:
    """Adjacent stitches of one yarn in a row: columns ``start`` … ``stop - 1``."""

    start: int
    stop: int
    yarn: int


@dataclass(frozen=True, eq=False, repr=False)
class Piece(Result):
    """A piece to be knitted.

    Parameters
    ----------
    shaped : chart and outline.
    yarns : those that are used, each once.
    yarn_of : int (rows, columns), index into ``yarns``; 0 outside the outline.
    gauge : relaxed size of its mean stitch, if known.

    Raises
    ------
    InputError
        If the yarns have another size than the chart.
    """

    shaped: ShapedChart
    yarns: tuple[PieceYarn, ...]
    yarn_of: Indices
    gauge: RelaxedSize | None = None

    def __post_init__(self) -> None:
        if self.yarn_of.shape != self.shaped.stitch.shape:
            raise InputError(
                "yarns", "their size is not that of the chart.", "Give a yarn for every cell."
            )
        used = np.unique(self.yarn_of[self.shaped.stitch]).tolist()
        renumbered = np.zeros(len(self.yarns), dtype=np.intp)
        renumbered[used] = np.arange(len(used))
        inside = np.where(self.shaped.stitch, renumbered[self.yarn_of], 0)
        inside.setflags(write=False)
        object.__setattr__(self, "yarn_of", inside)
        object.__setattr__(self, "yarns", tuple(self.yarns[index] for index in used))

    @classmethod
    def plain(cls, chart: StitchChart | ShapedChart, yarn: PieceYarn = MAIN_YARN) -> Piece:
        """A piece of one yarn."""
        shaped = chart if isinstance(chart, ShapedChart) else ShapedChart.rectangle(chart)
        return cls(shaped, (yarn,), np.zeros(shaped.stitch.shape, dtype=np.intp))

    @classmethod
    def of(cls, chart: StitchChart | SymbolChart | Piece) -> Piece:
        """The piece itself, or a chart as a piece of one yarn.

        Raises
        ------
        InputError
            If the chart has other stitches than knits and purls.
        """
        return chart if isinstance(chart, Piece) else cls.plain(knits_and_purls(chart))

    @property
    def chart(self) -> StitchChart:
        """K/P of every cell."""
        return self.shaped.chart

    @property
    def is_rectangle(self) -> bool:
        """True if every cell is a stitch."""
        return self.shaped.is_rectangle

    @property
    def is_plain(self) -> bool:
        """True for a rectangle of the main yarn, with nothing beyond its chart."""
        return self.is_rectangle and self.yarns == (MAIN_YARN,)

    def runs(self, row: int) -> tuple[YarnRun, ...]:
        """The yarns of a row from left to right."""
        first, last = self.shaped.spans[row]
        row_runs = runs(self.yarn_of[row, first:last])
        return tuple(YarnRun(first + start, first + stop, yarn) for start, stop, yarn in row_runs)

    def cells(self, yarn: int) -> Mask:
        """The stitches of one yarn."""
        cells: Mask = self.shaped.stitch & (self.yarn_of == yarn)
        return cells

    def from_row(self, number: int) -> Piece:
        """The piece from a row on, counted from 1, without columns that have no stitch.

        Raises
        ------
        InputError
            If there is no such row.
        """
        check_row(number, self.chart.rows)
        if number == 1:
            return self
        rows = slice(number - 1, None)
        shaped = ShapedChart(StitchChart(self.chart.purl[rows]), self.shaped.stitch[rows])
        return Piece(shaped, self.yarns, self.yarn_of[rows], self.gauge).cropped()

    def cropped(self) -> Piece:
        """The piece without columns that have no stitch."""
        used = np.flatnonzero(self.shaped.stitch.any(axis=0))
        columns = slice(int(used[0]), int(used[-1]) + 1)
        shaped = ShapedChart(
            StitchChart(self.chart.purl[:, columns]), self.shaped.stitch[:, columns]
        )
        return Piece(shaped, self.yarns, self.yarn_of[:, columns])

    def mirrored(self) -> Piece:
        """The piece with left and right exchanged."""
        shaped = ShapedChart(StitchChart(self.chart.purl[:, ::-1]), self.shaped.stitch[:, ::-1])
        return Piece(shaped, self.yarns, self.yarn_of[:, ::-1], self.gauge)

    def __eq__(self, other: object) -> bool:
        """Equal if every stitch has the same kind, and a yarn of the same name and colour."""
        if not isinstance(other, Piece) or self.shaped != other.shaped:
            return False
        mine, theirs = set(self.yarns), set(other.yarns)
        return mine == theirs and all(
            np.array_equal(self.cells(self.yarns.index(y)), other.cells(other.yarns.index(y)))
            for y in mine
        )

    def __hash__(self) -> int:
        return hash((self.shaped, frozenset(self.yarns)))


def check_row(number: int, rows: int) -> None:
    """Refuse to begin at a row that there is not.

    Raises
    ------
    InputError
    """
    if not 1 <= number <= rows:
        problem = f"there is no row {number}: the piece has {rows}."
        raise InputError("from_row", problem, f"Begin at row 1 to {rows}.", most=rows)


def yarn_name(index: int) -> str:
    """Knitters' short name of a yarn: A, B, … Z, AA, …

    Examples
    --------
    >>> [yarn_name(i) for i in (0, 25, 26)]
    ['A', 'Z', 'AA']
    """
    letters = ""
    index += 1
    while index:
        index, rest = divmod(index - 1, 26)
        letters = chr(ord("A") + rest) + letters
    return letters
