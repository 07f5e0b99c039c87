"""Written instructions: rows as knitters write them, and a strict dialect read back.

::

    Cast on 7 sts. Worked flat; row 1 is a right-side row.
    Row 1 (RS): *K1, p1; rep from * to last st, k1. (7 sts)
    Row 2 (WS): P2, (k1, p1) twice, p1. (7 sts)
    Rows 3-10: Repeat rows 1-2.
    Rows 11-14: Knit. (7 sts)
    Bind off.

In the round rows are rounds (``Rnd 1: …``) and have no side. Outlines are shaped at the edges: one
stitch by a decrease or by ``m1``, more by casting on and binding off; where the working yarn is at
the other end of the row, by a separate strand. Several yarns are named before the first row, and
rows say ``with A k10, with B …``::

    Row 5 (RS): Bind off 3 sts, k9. (9 sts)
    Row 6 (WS): Ssk, k5, k2tog. (7 sts)
    Row 7 (RS): K1, m1, k5, m1, k1. (9 sts)
    Row 8 (WS): With a separate strand cast on 3 sts at the end, knit. (12 sts)
    Row 9 (RS): K9, bind off the last 3 sts with a separate strand. (9 sts)
"""

import re
from collections.abc import Iterator, Sequence
from functools import cache, lru_cache
from itertools import groupby, pairwise

import numpy as np

from knitcore.base.arrays import runs
from knitcore.chart.row_sides import Construction, Side
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.stitch_kinds import STITCHES
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.garment.piece import MAIN_YARN, Piece, yarn_name
from knitcore.garment.worked_piece import PieceRow, all_rows

LATER_USE = 2
"""Least number of repetitions that are written as a bracket."""
MIN_TO_INCREASE = 4
"""Rows of fewer stitches than this cast on instead of making one between two stitches."""


def write_rows(
    chart: StitchChart | Piece | SymbolChart,
    construction: Construction = Construction.FLAT,
    *,
    first_side: Side = Side.RS,
) -> str:
    """The instructions of a chart; :mod:`knitcore.formats.read.written_reader` reads them.

    A row on the wrong side says what is worked there: a ``k2tog`` of the face as ``p2tog``.

    Raises
    ------
    InputError
        If its outline or yarns cannot be worked in the round.

    Examples
    --------
    >>> print(write_rows(StitchChart.of_fabric("garter", rows=30, columns=20)))
    Cast on 20 sts. Worked flat; row 1 is a right-side row.
    Rows 1-30: Knit. (20 sts)
    Bind off.
    <BLANKLINE>
    """
    piece = chart if isinstance(chart, SymbolChart) else Piece.of(chart)
    opening, (rows,) = written_sections(piece, construction, first_side=first_side)
    return "\n".join([*opening, *rows, "Bind off.", ""])


def written_sections(
    piece: Piece | SymbolChart,
    construction: Construction = Construction.FLAT,
    *,
    first_side: Side = Side.RS,
    breaks: Sequence[int] = (),
) -> tuple[list[str], list[list[str]]]:
    """Write the lines before the first row, and the rows of each section.

    Sections begin at row 0 and at each of the ``breaks``, in rising order; the rows of
    one section are never written as a repetition of another's.

    Raises
    ------
    InputError
        If the outline or yarns cannot be worked in the round.
    """
    rows = all_rows(piece, construction, first_side=first_side)
    yarns = (MAIN_YARN,) if isinstance(piece, SymbolChart) else piece.yarns
    count = _stitches(len(rows[0].yarns))
    if construction is Construction.ROUND:
        opening = [f"Cast on {count} and join in the round."]
    else:
        side = "right" if first_side is Side.RS else "wrong"
        opening = [f"Cast on {count}. Worked flat; row 1 is a {side}-side row."]
    if yarns != (MAIN_YARN,):
        opening += [
            f"Yarn {yarn_name(index)}: {yarn.name} ({yarn.colour})"
            for index, yarn in enumerate(yarns)
        ]
    writer = _Writer(rows, construction, several=len(yarns) > 1)
    edges = pairwise([0, *breaks, len(rows)])
    return opening, [list(writer.block(start, stop)) for start, stop in edges]


class _Writer:
    """Rows, and how long each repeats the rows a period before it."""

    def __init__(
        self, rows: Sequence[PieceRow], construction: Construction, *, several: bool
    ) -> None:
        self._rows, self._several = rows, several
        self._flat = construction is Construction.FLAT
        self._name = "Row" if self._flat else "Rnd"
        known: dict[tuple[object, ...], int] = {}
        keys = [(row.first, row.last, row.stitches, row.yarns) for row in rows]
        codes = np.array([known.setdefault(key, len(known)) for key in keys])
        # A flat repeat of an odd number of rows would turn right-side rows to wrong-side ones.
        periods = [p for p in range(1, len(rows) // 2 + 1) if p == 1 or not (self._flat and p % 2)]
        self._runs = {p: _run_lengths(codes[p:] == codes[:-p]) for p in periods}

    def block(self, start: int, stop: int) -> Iterator[str]:
        """The lines of rows start … stop - 1."""
        row = start
        while row < stop:
            period, repeated = self._best(row, stop)
            if period == 0:
                yield self._line(row, row + 1)
                row += 1
            elif period == 1:
                yield self._line(row, row + 1 + repeated)
                row += 1 + repeated
            else:
                yield from self.block(row, row + period)
                name = self._name.lower() + "s"
                again = self._range(row + period, row + period + repeated)
                yield f"{again}: Repeat {name} {row + 1}-{row + period}."
                row += period + repeated

    def _best(self, row: int, stop: int) -> tuple[int, int]:
        """The period that saves most rows from here on, and how many; (0, 0) if none does."""
        best = (0, 0)
        for period, lengths in self._runs.items():
            if row + period >= stop:
                break
            repeated = min(int(lengths[row]), stop - row - period)
            if repeated >= period and repeated > best[1]:
                best = (period, repeated)
        return best

    def _line(self, start: int, stop: int) -> str:
        row = self._rows[start]
        side = f" ({row.side})" if self._flat and stop - start == 1 else ""
        words = piece_row_words(row, several=self._several)
        count = _stitches(len(row.yarns))
        return f"{self._range(start, stop)}{side}: {words[0].upper()}{words[1:]}. ({count})"

    def _range(self, start: int, stop: int) -> str:
        if stop - start == 1:
            return f"{self._name} {start + 1}"
        return f"{self._name}s {start + 1}-{stop}"


def piece_row_words(row: PieceRow, *, several: bool) -> str:
    """One row of a piece in words; with ``several`` yarns each stretch names its own."""
    forms, before, after = _edge_forms(row)
    parts = list(before)
    stretches = runs(row.yarns)
    for start, stop, yarn in stretches:
        plain = len(stretches) == 1 and not after and not any(forms)
        words = row_words(row.stitches) if plain else _bracketed(row.stitches, forms, start, stop)
        parts.append(f"with {yarn_name(yarn)} {words}" if several else words)
    return ", ".join([*parts, *after])


def _edge_forms(row: PieceRow) -> tuple[list[str], list[str], list[str]]:
    """How each stitch is made ("" if simply worked), and the words before and after."""
    count = len(row.stitches)
    forms = [""] * count
    before: list[str] = []
    after: list[str] = []
    if row.first == row.last == -1 and count == 1:
        return ["k3tog"], before, after
    increase = count >= MIN_TO_INCREASE
    if row.first == -1:
        forms[0] = "ssk"
    elif row.first == 1 and increase:
        forms[1] = "m1"
    elif row.first:
        verb = "cast on" if row.first > 0 else "bind off"
        before.append(f"{verb} {_stitches(abs(row.first))}")
    if row.last == -1:
        forms[-1] = "k2tog"
    elif row.last == 1 and increase:
        forms[-2] = "m1"
    elif row.last > 0:
        before.append(f"with a separate strand cast on {_stitches(row.last)} at the end")
    elif row.last:
        after.append(f"bind off the last {_stitches(-row.last)} with a separate strand")
    return forms, before, after


_PURLED = {"ssk": "p2tog", "k2tog": "ssp", "k3tog": "p3tog", "m1": "m1p"}
"""The same act on a purl, leaning the same way as the row is worked: along the edge."""


def _bracketed(stitches: Sequence[int], forms: Sequence[str], start: int, stop: int) -> str:
    """A stretch of a row with its repeat in brackets, which gives the number of stitches."""
    parts, plain = [], start
    for index in range(start, stop):
        if forms[index]:
            parts += [in_brackets(tuple(stitches[plain:index]))] if index > plain else []
            parts.append(_PURLED[forms[index]] if stitches[index] else forms[index])
            plain = index + 1
    parts += [in_brackets(tuple(stitches[plain:stop]))] if stop > plain else []
    return ", ".join(parts)


@lru_cache(maxsize=4096)
def in_brackets(stitches: tuple[int, ...]) -> str:
    """A row with its longest repeat in brackets, which gives the number of stitches.

    Examples
    --------
    >>> in_brackets((False, True, False, True, False))
    '(k1, p1) twice, k1'
    """
    start, period, times = _longest_repeat(stitches)
    if times < LATER_USE:
        return _plain(stitches)
    unit, end = stitches[start : start + period], start + period * times
    often = "twice" if times == 2 else f"{times} times"
    parts = [_plain(stitches[:start]), f"({_plain(unit)}) {often}", _plain(stitches[end:])]
    return ", ".join(part for part in parts if part)


@lru_cache(maxsize=4096)
def row_words(stitches: tuple[int, ...]) -> str:
    """One row in words, its longest repeat starred.

    Examples
    --------
    >>> row_words((False, True, False, True, False))
    '*k1, p1; rep from * to last st, k1'
    >>> row_words((True, True, True))
    'purl'
    """
    if set(stitches) in ({0}, {1}):
        return "purl" if stitches[0] else "knit"
    start, period, times = _longest_repeat(stitches)
    if times < LATER_USE:
        return _plain(stitches)
    before, unit = stitches[:start], stitches[start : start + period]
    if sum(STITCHES[stitch].takes - STITCHES[stitch].width for stitch in unit):
        return in_brackets(stitches)  # a repeat to the end leaves as many as it takes
    after = stitches[start + period * times :]
    parts = [_plain(before)] if before else []
    left = sum(STITCHES[stitch].takes for stitch in after)
    end = "to end" if not after else f"to last {_stitches(left, alone='st')}"
    parts.append(f"*{_plain(unit)}; rep from * {end}")
    if after:
        parts.append(_plain(after))
    return ", ".join(parts)


def _longest_repeat(stitches: tuple[int, ...]) -> tuple[int, int, int]:
    """Start, period and count of the repeat that saves most words; count 0 if none saves any."""
    row = np.array(stitches)
    best, saved = (0, 0, 0), 0
    for period in range(1, len(stitches) // 2 + 1):
        lengths = _run_lengths(row[period:] == row[:-period])
        # A repeat best begins where a run of like stitches does.
        for start in _starts(stitches):
            if start >= len(lengths):
                break
            times = (int(lengths[start]) + period) // period
            if times < LATER_USE:
                continue
            unit, written = (
                stitches[start : start + period],
                stitches[start : start + period * times],
            )
            gain = len(_tokens(written)) - len(_tokens(unit)) - 1
            if gain > saved:
                best, saved = (start, period, times), gain
    return best


@lru_cache(maxsize=64)
def _starts(stitches: tuple[int, ...]) -> tuple[int, ...]:
    return (0, *(i for i in range(1, len(stitches)) if stitches[i] != stitches[i - 1]))


def _run_lengths(equal: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]) -> np.ndarray:
    """For each position, how many entries from there on are true without a break."""
    breaks = np.flatnonzero(~equal)
    following = np.append(breaks, len(equal))[np.searchsorted(breaks, np.arange(len(equal)))]
    return following - np.arange(len(equal))


def _tokens(stitches: Sequence[int]) -> list[tuple[int, int]]:
    """Stitches and how often they follow each other; those that take no number, each alone."""
    runs_of = [(stitch, len(list(alike))) for stitch, alike in groupby(stitches)]
    return [
        token
        for stitch, count in runs_of
        for token in ([(stitch, count)] if counted(stitch, 1) else [(stitch, 1)] * count)
    ]


_COUNTED = re.compile(r"(k|p|sl)1?((?: .*)?)$")


@cache
def counted(stitch: int, count: int) -> str:
    """Words of a run of a stitch, such as k3, k3 tbl and sl3 wyib; none if it takes no number."""
    name = _COUNTED.match(STITCHES[stitch].words)
    return f"{name[1]}{count}{name[2]}" if name else ""


def _plain(stitches: Sequence[int]) -> str:
    tokens = _tokens(stitches)
    return ", ".join(counted(stitch, n) or STITCHES[stitch].words for stitch, n in tokens)


def _stitches(count: int, *, alone: str = "1 st") -> str:
    return alone if count == 1 else f"{count} sts"
