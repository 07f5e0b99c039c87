"""Rows of a piece as they are worked, with increases and decreases at their edges.

They have a type of their own and are never mixed with the face grid;
:mod:`knitcore.chart.row_sides` has the rule.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from knitcore.base.errors import InputError
from knitcore.chart.row_sides import Construction, Side, side_of_row
from knitcore.chart.stitch_chart import StitchChart, check_chart_size
from knitcore.garment.piece import Piece, PieceYarn
from knitcore.garment.shaped import ShapedChart


@dataclass(frozen=True)
class PieceRow:
    """One row of a piece as the knitter works it.

    Attributes
    ----------
    side : which side faces the knitter.
    first, last : stitches that the row gains (or, negative, loses) where it begins and ends,
        against the row below.
    purls : for each stitch in working order, whether the knitter purls it.
    yarns : for each stitch in working order, the index of its yarn.
    """

    side: Side
    first: int
    last: int
    purls: tuple[bool, ...]
    yarns: tuple[int, ...]


def piece_rows(
    piece: StitchChart | Piece,
    construction: Construction = Construction.FLAT,
    *,
    first_side: Side = Side.RS,
) -> tuple[PieceRow, ...]:
    """Work a piece out row by row, as a knitter works it.

    Parameters
    ----------
    piece : the piece, or a chart in one yarn.
    construction : flat or in the round.
    first_side : the side of row 1 in flat knitting; in the round it is always RS.

    Examples
    --------
    >>> garter = piece_rows(StitchChart.of_fabric("garter", rows=4, columns=3))
    >>> {row.purls for row in garter}
    {(False, False, False)}

    Raises
    ------
    InputError
        If it cannot be worked in the round: yarns change within a round, or an edge moves by more
        than a stitch a round.
    """
    piece = Piece.of(piece)
    in_round = construction is Construction.ROUND
    first = Side.RS if in_round else first_side
    spans = piece.shaped.spans
    rows = []
    for index, (span, below) in enumerate(zip(spans, (spans[0], *spans[:-1]), strict=True)):
        side = side_of_row(index, construction, first)
        left, right = below[0] - span[0], span[1] - below[1]
        purls = piece.chart.purl[index, slice(*span)]
        yarns = piece.yarn_of[index, slice(*span)]
        if side is Side.RS:
            seen, order, gains = purls[::-1], yarns[::-1], (right, left)
        else:
            seen, order, gains = ~purls, yarns, (left, right)
        rows.append(PieceRow(side, *gains, tuple(seen.tolist()), tuple(order.tolist())))
    if in_round:
        _check_rounds(rows)
    return tuple(rows)


def _check_rounds(rows: Sequence[PieceRow]) -> None:
    for number, row in enumerate(rows, start=1):
        if len(set(row.yarns)) > 1:
            problem = f"round {number} has several yarns: intarsia leaves each at the wrong end."
            remedy = "Work it flat, or change yarns only between rounds."
            raise InputError("construction", problem, remedy)
        if max(abs(row.first), abs(row.last)) > 1:
            problem = f"round {number} gains or loses several stitches at one edge."
            remedy = "Work it flat, or change by one stitch at each edge of a round."
            raise InputError("construction", problem, remedy)


def piece_from_rows(rows: Sequence[PieceRow], yarns: Sequence[PieceYarn]) -> Piece:
    """The piece that rows make; the inverse of :func:`piece_rows`, without empty columns.

    Raises
    ------
    InputError
        If rows do not follow each other, or the outline is in several parts.
    """
    spans: list[tuple[int, int]] = []
    left, right = 0, len(rows[0].purls)
    for row in rows:
        gains = (row.last, row.first) if row.side is Side.RS else (row.first, row.last)
        left, right = left - gains[0], right + gains[1]
        spans.append((left, right))
    for number, ((start, stop), row) in enumerate(zip(spans, rows, strict=True), start=1):
        if stop - start != len(row.purls):
            raise InputError(
                "rows",
                f"row {number} has {len(row.purls)} stitches, {stop - start} are on the needle.",
                "Correct the row.",
            )
    offset = min(start for start, _ in spans)
    width = max(stop for _, stop in spans) - offset
    check_chart_size(len(rows), width)
    purl = np.zeros((len(rows), width), dtype=bool)
    stitch, yarn_of = purl.copy(), np.zeros(purl.shape, dtype=np.intp)
    for index, ((start, stop), row) in enumerate(zip(spans, rows, strict=True)):
        place = slice(start - offset, stop - offset)
        rs = row.side is Side.RS
        worked = np.array(row.purls)
        purl[index, place] = worked[::-1] if rs else ~worked
        yarn_of[index, place] = row.yarns[::-1] if rs else row.yarns
        stitch[index, place] = True
    return Piece(ShapedChart(StitchChart(purl), stitch), tuple(yarns), yarn_of)
