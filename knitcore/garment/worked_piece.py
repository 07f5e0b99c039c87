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
from knitcore.chart.stitch_kinds import BY_CODE, STITCHES
from knitcore.chart.symbol_chart import CONTINUED, SymbolChart
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
    stitches : what the knitter works, in order: places in
        :data:`knitcore.chart.stitch_kinds.STITCHES`, of which False is a knit and True a purl.
    yarns : for each column in working order, the index of its yarn.
    """

    side: Side
    first: int
    last: int
    stitches: tuple[int, ...]
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
    >>> {row.stitches for row in garter}
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


def symbol_rows(
    chart: SymbolChart,
    construction: Construction = Construction.FLAT,
    *,
    first_side: Side = Side.RS,
) -> tuple[PieceRow, ...]:
    """Work a chart of any stitches out row by row, as :func:`piece_rows` does.

    Examples
    --------
    >>> lace = symbol_rows(SymbolChart.parse("O)K"), first_side=Side.WS)
    >>> [STITCHES[stitch].words for stitch in lace[0].stitches]
    ['yo', 'k2tog', 'p']
    """
    first = Side.RS if construction is Construction.ROUND else first_side
    rows = []
    for index, line in enumerate(chart.cells):
        side = side_of_row(index, construction, first)
        faces = [int(place) for place in line if place != CONTINUED]
        worked = faces[::-1] if side is Side.RS else map(_from_behind, faces)
        rows.append(PieceRow(side, 0, 0, tuple(worked), (0,) * chart.columns))
    return tuple(rows)


def all_rows(
    chart: StitchChart | Piece | SymbolChart,
    construction: Construction = Construction.FLAT,
    *,
    first_side: Side = Side.RS,
) -> tuple[PieceRow, ...]:
    """Work out a piece or a chart of any kind.

    Raises
    ------
    InputError
        As :func:`piece_rows`.
    """
    if isinstance(chart, SymbolChart):
        return symbol_rows(chart, construction, first_side=first_side)
    return piece_rows(chart, construction, first_side=first_side)


def symbols_from_rows(rows: Sequence[PieceRow]) -> SymbolChart:
    """Make the chart of rows of any stitches; the inverse of :func:`symbol_rows`.

    Raises
    ------
    InputError
        If rows do not follow each other; as :class:`SymbolChart`.
    """
    columns = len(rows[0].yarns)
    cells = []
    for number, row in enumerate(rows, start=1):
        rs = row.side is Side.RS
        faces = row.stitches[::-1] if rs else map(_from_behind, row.stitches)
        line = [at for place in faces for at in (place, *[CONTINUED] * (STITCHES[place].width - 1))]
        if len(line) != columns:
            problem = f"row {number} has {len(line)} stitches, {columns} are on the needle."
            raise InputError("rows", problem, "Correct the row.")
        cells.append(line)
    return SymbolChart(np.array(cells, dtype=np.int16))


def _from_behind(place: int) -> int:
    """The stitch whose back is this one."""
    return BY_CODE[STITCHES[place].turned_over.code]


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
    left, right = 0, len(rows[0].stitches)
    for row in rows:
        gains = (row.last, row.first) if row.side is Side.RS else (row.first, row.last)
        left, right = left - gains[0], right + gains[1]
        spans.append((left, right))
    for number, ((start, stop), row) in enumerate(zip(spans, rows, strict=True), start=1):
        if stop - start != len(row.stitches):
            raise InputError(
                "rows",
                f"row {number} has {len(row.stitches)} stitches, {stop - start} are on the needle.",
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
        worked = np.array(row.stitches)
        purl[index, place] = worked[::-1] if rs else ~worked
        yarn_of[index, place] = row.yarns[::-1] if rs else row.yarns
        stitch[index, place] = True
    return Piece(ShapedChart(StitchChart(purl), stitch), tuple(yarns), yarn_of)
