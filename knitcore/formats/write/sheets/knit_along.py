"""A piece row by row for whoever knits it: each row's words, and its stitches as they are seen.

By hand the rows are those of the written pattern; on a home machine those of its plan.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

from knitcore.base.arrays import runs
from knitcore.chart.row_sides import Construction, Side
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.stitch_kinds import STITCHES
from knitcore.chart.symbol_chart import SymbolChart, knits_and_purls
from knitcore.formats.write.written_pattern import piece_row_words, written_sections
from knitcore.garment.piece import MAIN_YARN, Piece, PieceYarn, check_row
from knitcore.garment.worked_piece import PieceRow, all_rows, piece_rows
from knitcore.machine.home.hand_plan import hand_plan
from knitcore.machine.home.plan_rows import HandRow
from knitcore.machine.profile import MachineProfile

SIDES = {Side.RS: "right side", Side.WS: "wrong side"}


@dataclass(frozen=True)
class AlongRow:
    """A row.

    Attributes
    ----------
    number : from 1.
    heading : what is special of it, such as the side that faces the knitter.
    leftwards : whether it is worked from the knitter's right to the left.
    words : what to do, in order.
    stitches : from the knitter's left, P for a purl, or on a machine for a stitch that is latched
        up or on the ribber; K for all others.
    first : place of the leftmost stitch, from that of the widest row.
    yarns : stitches and number of the yarn of each stretch from the left.
    codes : of a chart with other stitches than knits and purls all of them as they are worked, from
        the knitter's left.
    """

    number: int
    heading: str
    leftwards: bool
    words: tuple[str, ...]
    stitches: str
    first: int
    yarns: tuple[tuple[int, int], ...]
    codes: tuple[str, ...] = ()


@dataclass(frozen=True)
class KnitAlong:
    """All rows of a piece.

    Attributes
    ----------
    opening, closing : what is done before the first row and after the last.
    round : whether rows are rounds.
    repeat_rows : rows after which the pattern begins again; all of them if it does not.
    marked : what the stitches P are.
    needles : names of all places, on a machine.
    """

    opening: tuple[str, ...]
    rows: tuple[AlongRow, ...]
    closing: tuple[str, ...]
    notes: tuple[str, ...]
    round: bool
    repeat_rows: int
    marked: str
    yarns: tuple[PieceYarn, ...]
    needles: tuple[str, ...] = ()


def knit_along(
    chart: StitchChart | Piece | SymbolChart,
    construction: Construction = Construction.FLAT,
    *,
    first_side: Side = Side.RS,
    machine: MachineProfile | None = None,
    from_row: int = 1,
) -> KnitAlong:
    """Work a piece out row by row.

    Parameters
    ----------
    chart : a piece, or a chart of any stitches, whose marks are those of its purl map.
    machine : a home machine; None for knitting by hand. On a machine the piece is flat.
    from_row : the first row, after a break.

    Raises
    ------
    InputError
        If it cannot be worked in the round or on the machine, or there is no such row. Machines
        are told knits and purls only.

    Examples
    --------
    >>> for row in knit_along(StitchChart.of_fabric("rib", rows=2, columns=4)).rows:
    ...     print(row.heading, row.words, row.stitches)
    right side ('*p1, k1; rep from * to end',) KPKP
    wrong side ('*p1, k1; rep from * to end',) KPKP
    """
    if isinstance(chart, SymbolChart):
        every: Piece | SymbolChart = chart
        piece = Piece.plain(chart.plain)
        if machine is not None:
            knits_and_purls(chart)
    else:
        every = piece = Piece.of(chart).cropped()
    check_row(from_row, piece.chart.rows)
    repeat = (piece.chart if isinstance(every, Piece) else every).repeat_cut().rows
    if machine is not None:
        plan = hand_plan(piece, machine).resumed(from_row)
        rows = tuple(_machine_row(row) for row in plan.rows)
        marked = "on the ribber" if plan.ribber else "to be latched up"
        texts = (plan.opening, rows, plan.closing, (*plan.notes, plan.time))
        return KnitAlong(*texts, False, repeat, marked, piece.yarns, plan.needles)
    opening, _ = written_sections(every, construction, first_side=first_side)
    said = all_rows(every, construction, first_side=first_side)
    worked = piece_rows(piece, construction, first_side=first_side)
    several = len(piece.yarns) > 1
    left = _lefts(piece, worked)
    in_round = construction is Construction.ROUND
    rows = tuple(
        _hand_row(number, row, piece_row_words(full, several=several), first, in_round=in_round)
        for number, (row, full, first) in enumerate(zip(worked, said, left, strict=True), start=1)
    )
    if isinstance(every, SymbolChart):
        rows = tuple(
            replace(row, codes=tuple(STITCHES[place].code for place in reversed(full.stitches)))
            for row, full in zip(rows, said, strict=True)
        )
    rows = rows[from_row - 1 :]
    notes = () if piece.yarns == (MAIN_YARN,) else tuple(opening[1:])
    return KnitAlong(
        tuple(opening[:1]), rows, ("Bind off.",), notes, in_round, repeat, "purls", piece.yarns
    )


def _hand_row(number: int, row: PieceRow, words: str, first: int, *, in_round: bool) -> AlongRow:
    stitches = "".join("P" if purl else "K" for purl in reversed(row.stitches))
    yarns = tuple((stop - start, yarn) for start, stop, yarn in runs(row.yarns[::-1]))
    heading = "" if in_round else SIDES[row.side]
    return AlongRow(number, heading, True, (words,), stitches, first, yarns)


def _lefts(piece: Piece, worked: tuple[PieceRow, ...]) -> list[int]:
    """Places of the leftmost stitches, as the knitter sees each row."""
    columns = piece.chart.columns
    return [
        start if row.side is Side.RS else columns - stop
        for (start, stop), row in zip(piece.shaped.spans, worked, strict=True)
    ]


def _machine_row(row: HandRow) -> AlongRow:
    stitches = "".join("P" if other else "K" for other in row.other)
    before, after = ([task.words for task in tasks] for tasks in (row.before, row.after))
    start = "right" if row.leftwards else "left"
    return AlongRow(
        row.number,
        f"carriage at the {start}",
        row.leftwards,
        (*before, "Knit 1 row.", *after),
        stitches,
        row.first,
        row.yarns,
    )
