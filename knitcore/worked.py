"""Rows as they are worked: a type of its own, never mixed with the face grid.

In flat knitting right-side (RS) rows are worked from the right edge of the face to the left, and
wrong-side (WS) rows from left to right with the opposite stitch, because the knitter looks at the
back. In the round every row is worked on the right side, from right to left.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from knitcore.chart import StitchChart
from knitcore.errors import InputError


class Construction(StrEnum):
    """How the cloth is worked."""

    FLAT = "flat"
    ROUND = "round"


class Side(StrEnum):
    """Which side faces the knitter."""

    RS = "RS"
    WS = "WS"

    @property
    def other(self) -> Side:
        """The back of this side."""
        return Side.WS if self is Side.RS else Side.RS


@dataclass(frozen=True)
class WorkedRow:
    """One row as the knitter works it.

    Attributes
    ----------
    side : which side faces the knitter.
    purls : for each stitch in working order, whether the knitter purls it.
    """

    side: Side
    purls: tuple[bool, ...]


@dataclass(frozen=True)
class WorkedRows:
    """All rows of a chart as they are worked, the first row first."""

    construction: Construction
    first_side: Side
    rows: tuple[WorkedRow, ...]


def as_worked(
    chart: StitchChart,
    construction: Construction = Construction.FLAT,
    *,
    first_side: Side = Side.RS,
) -> WorkedRows:
    """How a knitter works a chart.

    Parameters
    ----------
    chart : the face grid.
    construction : flat or in the round.
    first_side : the side of row 1 in flat knitting; in the round it is always RS.

    Examples
    --------
    >>> garter = as_worked(StitchChart.of_fabric("garter", rows=4, columns=3))
    >>> {row.purls for row in garter.rows}
    {(False, False, False)}
    """
    first = Side.RS if construction is Construction.ROUND else first_side
    rows = [
        _row(chart.purl[index], side_of_row(index, construction, first))
        for index in range(chart.rows)
    ]
    return WorkedRows(construction, first, tuple(rows))


def face_grid(worked: WorkedRows) -> StitchChart:
    """The chart that worked rows make; the inverse of :func:`as_worked`.

    Raises
    ------
    InputError
        If rows differ in length.
    """
    lengths = [len(row.purls) for row in worked.rows]
    if len(set(lengths)) > 1:
        odd = next(i for i, n in enumerate(lengths) if n != lengths[0])
        raise InputError(
            "rows",
            f"row {odd + 1} has {lengths[odd]} stitches, row 1 has {lengths[0]}.",
            "Work every row over the same number of stitches.",
        )
    return StitchChart(np.array([_face(row) for row in worked.rows], dtype=bool))


def side_of_row(index: int, construction: Construction, first_side: Side) -> Side:
    """The side that faces the knitter in row ``index`` (from 0)."""
    if construction is Construction.ROUND or index % 2 == 0:
        return first_side
    return first_side.other


def _row(face: np.ndarray[tuple[int, ...], np.dtype[np.bool_]], side: Side) -> WorkedRow:
    seen = face[::-1] if side is Side.RS else ~face
    return WorkedRow(side, tuple(seen.tolist()))


def _face(row: WorkedRow) -> Sequence[bool]:
    return row.purls[::-1] if row.side is Side.RS else [not purl for purl in row.purls]
