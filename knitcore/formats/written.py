"""Written instructions: rows as knitters write them, and a strict dialect read back.

::

    Cast on 7 sts. Worked flat; row 1 is a right-side row.
    Row 1 (RS): *K1, p1; rep from * to last st, k1. (7 sts)
    Row 2 (WS): P2, (k1, p1) twice, p1. (7 sts)
    Rows 3-10: Repeat rows 1-2.
    Rows 11-14: Knit. (7 sts)
    Bind off.

In the round rows are rounds (``Rnd 1: …``) and have no side.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import lru_cache

import numpy as np

from knitcore.chart import StitchChart
from knitcore.worked import Construction, Side, as_worked

LATER_USE = 2
"""A bracket is used where its stitches occur at least so often."""


def write_rows(
    chart: StitchChart,
    construction: Construction = Construction.FLAT,
    *,
    first_side: Side = Side.RS,
) -> str:
    """The instructions of a chart; :func:`knitcore.formats.written_reader.read_rows` reads them.

    Examples
    --------
    >>> print(write_rows(StitchChart.of_fabric("garter", rows=30, columns=20)))
    Cast on 20 sts. Worked flat; row 1 is a right-side row.
    Rows 1-30: Knit. (20 sts)
    Bind off.
    <BLANKLINE>
    """
    worked = as_worked(chart, construction, first_side=first_side)
    rows = [row.purls for row in worked.rows]
    count = _stitches(chart.columns)
    if construction is Construction.ROUND:
        lines = [f"Cast on {count} and join in the round."]
    else:
        side = "right" if first_side is Side.RS else "wrong"
        lines = [f"Cast on {count}. Worked flat; row 1 is a {side}-side row."]
    sides = [row.side for row in worked.rows]
    lines += _Writer(rows, sides, construction).block(0, len(rows))
    return "\n".join([*lines, "Bind off.", ""])


class _Writer:
    """Rows, and how long each repeats the rows a period before it."""

    def __init__(
        self,
        rows: Sequence[tuple[bool, ...]],
        sides: Sequence[Side],
        construction: Construction,
    ) -> None:
        self._rows, self._sides = rows, sides
        self._flat = construction is Construction.FLAT
        self._name = "Row" if self._flat else "Rnd"
        known: dict[tuple[bool, ...], int] = {}
        codes = np.array([known.setdefault(row, len(known)) for row in rows])
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
        for period, runs in self._runs.items():
            if row + period >= stop:
                break
            repeated = min(int(runs[row]), stop - row - period)
            if repeated >= period and repeated > best[1]:
                best = (period, repeated)
        return best

    def _line(self, start: int, stop: int) -> str:
        side = f" ({self._sides[start]})" if self._flat and stop - start == 1 else ""
        words = row_words(self._rows[start])
        count = _stitches(len(self._rows[start]))
        return f"{self._range(start, stop)}{side}: {words[0].upper()}{words[1:]}. ({count})"

    def _range(self, start: int, stop: int) -> str:
        if stop - start == 1:
            return f"{self._name} {start + 1}"
        return f"{self._name}s {start + 1}-{stop}"


@lru_cache(maxsize=4096)
def row_words(purls: tuple[bool, ...]) -> str:
    """One row in words, its longest repeat starred.

    Examples
    --------
    >>> row_words((False, True, False, True, False))
    '*k1, p1; rep from * to last st, k1'
    >>> row_words((True, True, True))
    'purl'
    """
    if len(set(purls)) == 1:
        return "purl" if purls[0] else "knit"
    start, period, times = _longest_repeat(purls)
    if times < LATER_USE:
        return _plain(purls)
    before, unit = purls[:start], purls[start : start + period]
    after = purls[start + period * times :]
    parts = [_plain(before)] if before else []
    end = "to end" if not after else f"to last {_stitches(len(after), alone='st')}"
    parts.append(f"*{_plain(unit)}; rep from * {end}")
    if after:
        parts.append(_plain(after))
    return ", ".join(parts)


def _longest_repeat(purls: tuple[bool, ...]) -> tuple[int, int, int]:
    """Start, period and count of the repeat that saves most words; count 0 if none saves any."""
    row = np.array(purls)
    best, saved = (0, 0, 0), 0
    for period in range(LATER_USE, len(purls) // 2 + 1):
        runs = _run_lengths(row[period:] == row[:-period])
        # A repeat best begins where a run of like stitches does.
        for start in _starts(purls):
            if start >= len(runs):
                break
            times = (int(runs[start]) + period) // period
            if times < LATER_USE:
                continue
            unit = purls[start : start + period]
            gain = (times - 1) * len(_tokens(unit)) - 1
            if gain > saved:
                best, saved = (start, period, times), gain
    return best


@lru_cache(maxsize=64)
def _starts(purls: tuple[bool, ...]) -> tuple[int, ...]:
    return (0, *(i for i in range(1, len(purls)) if purls[i] != purls[i - 1]))


def _run_lengths(equal: np.ndarray[tuple[int, ...], np.dtype[np.bool_]]) -> np.ndarray:
    """For each position, how many entries from there on are true without a break."""
    breaks = np.flatnonzero(~equal)
    following = np.append(breaks, len(equal))[np.searchsorted(breaks, np.arange(len(equal)))]
    lengths: np.ndarray = following - np.arange(len(equal))
    return lengths


def _tokens(purls: Sequence[bool]) -> list[tuple[bool, int]]:
    tokens: list[tuple[bool, int]] = []
    for purl in purls:
        if tokens and tokens[-1][0] == purl:
            tokens[-1] = (purl, tokens[-1][1] + 1)
        else:
            tokens.append((purl, 1))
    return tokens


def _plain(purls: Sequence[bool]) -> str:
    return ", ".join(f"{'p' if purl else 'k'}{count}" for purl, count in _tokens(purls))


def _stitches(count: int, *, alone: str = "1 st") -> str:
    return alone if count == 1 else f"{count} sts"
