"""Reading written rows: those of this library, KnitSpeak, and patterns as others write them.

:mod:`knitcore.formats.read.written_lines` tells the lines apart and
:mod:`knitcore.formats.read.written_words` reads the words of a row; here the rows are put in order
and worked. The number of stitches is that cast on, or else the smallest for which all rows come
out. See :mod:`knitcore.formats.write.written_pattern` and :mod:`knitcore.formats.write.knitspeak`
for examples.
"""

import re
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace

import numpy as np

from knitcore.base.errors import InputError
from knitcore.chart.row_sides import Construction, Side, side_of_row
from knitcore.chart.stitch_chart import MAX_STITCHES_PER_SIDE, StitchChart, check_chart_size
from knitcore.chart.stitch_kinds import BY_CODE, STITCHES
from knitcore.chart.stitch_words import OPEN_TO_READING, SLIP
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.formats.read.written_lines import (
    PatternLines,
    RepeatLine,
    RowLine,
    again,
    looks_written,
    read_lines,
    row_of,
    times_in,
)
from knitcore.formats.read.written_row import Line, RowWords, Work, keeps_count, left
from knitcore.formats.read.written_words import is_ambiguous, read_row
from knitcore.garment.piece import MAIN_YARN, Piece, PieceYarn, yarn_name
from knitcore.garment.worked_piece import PieceRow, piece_from_rows, symbols_from_rows

__all__ = ["looks_written", "read_noted_rows", "read_piece_rows", "read_rows"]

_EVERY = {"even": 0, "odd": 1}
MAX_SHOWN = 3
"""Remarks that a note quotes."""


def read_rows(text: str) -> StitchChart:
    """The face grid of written instructions for a rectangle.

    Raises
    ------
    InputError
        Naming the line, the problem and an accepted form.

    Examples
    --------
    >>> print(read_rows("Cast on 3 sts. Worked flat.\\nRow 1: K1, p2.\\nRows 2-3: Knit."))
    KKK
    PPP
    PPK
    >>> print(read_rows("Rows 1 and 2: [k1, p1] twice."))
    PKPK
    PKPK
    """
    piece = read_piece_rows(text)
    if not piece.is_rectangle:
        raise InputError("rows", "they do not make a rectangle.", "Read them with read_piece_rows.")
    return piece.chart


def read_stitch_rows(text: str) -> SymbolChart:
    """The chart of written instructions for a rectangle of any stitches.

    Raises
    ------
    InputError
        As :func:`read_rows`.

    Examples
    --------
    >>> print(read_stitch_rows("Row 1 (RS): [K2tog, yo] twice. Row 2: P3, sl1."))
    KKKV
    O/O/
    """
    content = read_noted_rows(text)[0]
    if isinstance(content, SymbolChart):
        return content
    return SymbolChart.of(read_rows(text))


def read_piece_rows(text: str) -> Piece:
    """The chart, the outline and the yarns of written instructions.

    Raises
    ------
    InputError
        As :func:`read_rows`.
    """
    return Piece.of(read_noted_rows(text)[0])


def read_noted_rows(text: str) -> tuple[Piece | SymbolChart, tuple[str, ...]]:
    """The piece, or the chart of other stitches, of written instructions; and notes on what was
    left out or taken as one of several.

    Raises
    ------
    InputError
        As :func:`read_rows`.
    """
    pattern = read_lines(text)
    is_open = any(isinstance(row, RowLine) and is_ambiguous(row.body) for row in pattern.rows)
    try:
        piece, notes = _Reader(pattern, often_more=True).read()
        said = "once and then as often as it says"
    except InputError as error:
        if not is_open:
            raise
        try:
            piece, notes = _Reader(pattern, often_more=False).read()
        except InputError:
            raise error from None
        said = "as often as it says in all"
    if is_open:
        notes.append(f'"Repeat from * … times" is worked {said}.')
    if isinstance(piece, SymbolChart):
        bodies = "\n".join(row.body for row in pattern.rows if isinstance(row, RowLine))
        for word, note in OPEN_TO_READING.items():
            notes += [note] if re.search(word, bodies, re.IGNORECASE) else []
    return piece, tuple(notes)


class _Reader:
    """Puts the rows in order and works them."""

    def __init__(self, pattern: PatternLines, *, often_more: bool) -> None:
        self._pattern, self._often_more = pattern, often_more
        self._yarns: list[PieceYarn] = []
        self._rows: dict[int, RowWords | int] = {}
        """Words of each row, or the number of the row that it repeats; a set-up row is 0."""
        self._start = 1
        self._notes: list[str] = []

    def read(self) -> tuple[Piece | SymbolChart, list[str]]:
        for line, name, yarn, colour in self._pattern.yarns:
            self._add_yarn(line, name, PieceYarn(yarn, colour))
        self._construction = self._find_construction()
        numbered = list(self._numbered())
        self._first_side = self._find_first_side(numbered)
        for row, numbers in numbered:
            if isinstance(row, RepeatLine):
                self._repeat(row.line, row.first, row.last, numbers)
            elif numbers:
                self._add(row, numbers)
        self._fill_in([row for row, _ in numbered if isinstance(row, RowLine) and row.every])
        words = self._in_order()
        piece = self._piece(words, self._cast_on(words))
        return piece, [*self._notes, *self._remarks()]

    def _add_yarn(self, line: Line, name: str, yarn: PieceYarn) -> None:
        if name != yarn_name(len(self._yarns)) or yarn in self._yarns:
            raise line.wrong(
                f"yarn {name} cannot be named here.",
                f"Name the yarns before row 1, in order; the next is {yarn_name(len(self._yarns))}"
                ", and no two are alike.",
            )
        self._yarns.append(yarn)

    def _find_construction(self) -> Construction:
        """Flat or in the round: what the cast-on says, or else what the rows are called."""
        is_round = self._pattern.is_round
        for row in self._pattern.rows:
            if isinstance(row, RepeatLine) or row.is_round is None:
                continue
            if is_round is not None and is_round != row.is_round:
                remedy = 'Write "Rnd" after "join in the round", and "Row" in flat knitting.'
                raise row.line.wrong("rows and rounds are mixed.", remedy)
            is_round = row.is_round
        return Construction.ROUND if is_round else Construction.FLAT

    def _numbered(self) -> Iterator[tuple[RowLine | RepeatLine, tuple[int, ...]]]:
        """Every line with the numbers of its rows; a row without one comes next."""
        last = 0
        for row in self._pattern.rows:
            if isinstance(row, RepeatLine):
                if row.first < 0:
                    back = replace(row, first=last + 1 + row.first, last=last + 1 + row.last)
                    row = back  # noqa: PLW2901
                count = (row.last - row.first + 1) * row.times
                numbers = tuple(range(last + 1, last + 1 + max(count, 0)))
            else:
                numbers = row.numbers or (() if row.every else (last + 1,))
            last = max(last, *numbers) if numbers else last
            check_chart_size(max(last, 1), 1)
            yield row, numbers

    def _find_first_side(
        self, numbered: Iterable[tuple[RowLine | RepeatLine, tuple[int, ...]]]
    ) -> Side:
        stated = {
            row.side if number % 2 else row.side.other
            for row, numbers in numbered
            for number in numbers
            if isinstance(row, RowLine) and row.side is not None
        }
        if self._pattern.first_side is not None:
            stated.add(self._pattern.first_side)
        every = {row.every for row, _ in numbered if isinstance(row, RowLine)}
        is_round = self._construction is Construction.ROUND
        if len(stated) > 1 or (is_round and (Side.WS in stated or "ws" in every)):
            raise InputError(
                "rows",
                "right-side and wrong-side rows do not alternate.",
                "Correct RS and WS; rounds have no wrong side.",
            )
        return stated.pop() if stated else Side.RS

    def _side(self, number: int) -> Side:
        return side_of_row(number - 1, self._construction, self._first_side)

    def _add(self, row: RowLine, numbers: tuple[int, ...]) -> None:
        line = Line(row.line.number, row.line.text, row_of(numbers))
        if row.only is not None:
            numbers = tuple(number for number in numbers if self._side(number) is row.only)
        repeat = again(row.body)
        if repeat is not None and (not repeat[2] or times_in(repeat[2])):
            self._repeat(line, repeat[0], repeat[1], numbers)
            return
        words = self._words(row, line)
        for number in numbers:
            self._put(line, number, words)

    def _words(self, row: RowLine, line: Line) -> RowWords:
        words = read_row(line, row.body, len(self._yarns), again=self._often_more)
        return words.repeated() if row.is_ordinal else words

    def _repeat(self, line: Line, first: int, last: int, numbers: tuple[int, ...]) -> None:
        if not 1 <= first <= last < min(numbers, default=1):
            raise line.wrong(
                f"rows {first}-{last} are not all written before it.", "Repeat earlier rows."
            )
        for index, number in enumerate(numbers):
            self._put(line, number, first + index % (last - first + 1))

    def _put(self, line: Line, number: int, words: RowWords | int) -> None:
        if number in self._rows:
            raise line.wrong(f"row {number} is given twice.", "Write each row once.")
        self._rows[number] = words

    def _fill_in(self, lines: list[RowLine]) -> None:
        """Rows that are given as "all even rows"; one of them may follow the last row."""
        if not lines:
            return
        last = max(self._rows, default=0)
        if not last:
            is_round = self._construction is Construction.ROUND
            last = 1 if is_round and all(self._belongs(row, 1) for row in lines) else 2
        elif last % 2 and any(self._belongs(row, last + 1) for row in lines):
            last += 1
        check_chart_size(last, 1)
        for row in lines:
            words = self._words(row, row.line)
            for number in range(1, last + 1):
                if number not in self._rows and self._belongs(row, number):
                    self._rows[number] = words
        self._notes.append(
            f'Rows given as "all … rows" are read up to row {last}, where the pattern begins again.'
        )

    def _belongs(self, row: RowLine, number: int) -> bool:
        """Say whether a row is one of those that a line tells besides its numbers."""
        if row.every == "other":
            return number % 2 == row.numbers[-1] % 2
        if row.every in _EVERY:
            return number % 2 == _EVERY[row.every]
        return self._side(number).lower() in (row.every or "")

    def _in_order(self) -> list[RowWords]:
        count = max(self._rows, default=1)
        self._start = 0 if 0 in self._rows else 1
        numbers = range(self._start, count + 1)
        missing = next((number for number in numbers if number not in self._rows), None)
        if missing is not None:
            first = f": {self._pattern.remarks[0][:60]!r} is none" if self._pattern.remarks else ""
            name = f"row {missing} is missing" if self._rows else f"there are no rows{first}"
            raise InputError(
                "rows", f"{name}.", 'Number the rows from 1 without gaps: "Row 1: Knit."'
            )
        words: list[RowWords] = []
        for number in numbers:
            row = self._rows[number]
            words.append(words[row - self._start] if isinstance(row, int) else row)
        return words

    def _cast_on(self, words: list[RowWords]) -> int:
        """The stitches that are cast on: as it is said, or as few as fit all rows."""
        count = self._pattern.cast_on
        if count is not None:
            check_chart_size(1, count)
            return count
        counts = np.arange(1, MAX_STITCHES_PER_SIDE + 1)
        multiple, plus = self._pattern.multiple or (1, 0)
        fits = (counts % max(multiple, 1) == plus % max(multiple, 1)) & (counts > plus)
        gain = 0
        for number, row in enumerate(words, start=self._start):
            before = fits
            fits = fits & row.fits(counts + gain)
            if not fits.any():
                problem = f"no number of stitches fits row {number} and those before it"
                if before.sum() == 1 and number > 1:
                    needle = int(counts[before][0]) + gain
                    row.work(needle)
                raise row.line.wrong(f"{problem}.", "Correct it, or say what is cast on.")
            gain += row.gain
        count = int(counts[fits][0])
        plural = "stitch is" if count == 1 else "stitches are"
        self._notes.append(
            f"No cast-on is given: {count} {plural} the fewest with which all rows come out."
        )
        return count

    def _piece(self, words: list[RowWords], needle: int) -> Piece | SymbolChart:
        rows, lines, others = [], [], []
        known: dict[tuple[int, int], Work] = {}
        for number, row in enumerate(words, start=self._start):
            key = id(row), needle
            if key not in known:
                known[key] = row.work(needle)
            work = known[key]
            if number == self._start and (work.first or work.last):
                self._notes.append(
                    f"Row {number} makes {len(work.stitches)} of the {needle} stitches cast on: the"
                    " chart begins with it."
                )
                work = Work(0, 0, work.stitches)
            needle = left(work.stitches)
            side = self._side(number)
            places = tuple(
                BY_CODE["V" if side is Side.RS else "v"] if s.form == SLIP else s.place
                for s in work.stitches
            )
            yarns = tuple(s.yarn for s in work.stitches for _ in range(s.leaves))
            rows.append(PieceRow(side, work.first, work.last, places, yarns))
            lines.append(row.line)
            others.append(keeps_count(work.stitches) and any(s.form for s in work.stitches))
        end = self._pattern.bound_off
        if end is not None and end[1] not in (None, needle):
            problem = f"it binds off {end[1]} stitches, but {needle} are on the needle."
            raise end[0].wrong(problem, "Correct it.")
        if any(others):
            self._check_rectangle(rows, lines)
            return symbols_from_rows(rows)
        purled = [
            replace(row, stitches=tuple(STITCHES[place].sites[0].purl for place in row.stitches))
            for row in rows
        ]
        return piece_from_rows(purled, self._yarns or [MAIN_YARN])

    def _check_rectangle(self, rows: Sequence[PieceRow], lines: Sequence[Line]) -> None:
        """Refuse an outline or several yarns beside lace, cables, tucks or slipped stitches."""
        for row, line in zip(rows, lines, strict=True):
            if row.first or row.last:
                raise line.wrong(
                    "it changes the number of stitches, beside rows of lace, cables, tucks or "
                    "slipped stitches.",
                    "Give the part in which all rows have as many stitches.",
                )
            if len(self._yarns) > 1:
                remedy = "Write it in one yarn; knits and purls may have several."
                raise line.wrong("colours and other stitches than k and p are mixed.", remedy)

    def _remarks(self) -> Iterator[str]:
        if self._pattern.remarks:
            shown = "; ".join(repr(r[:60]) for r in self._pattern.remarks[:MAX_SHOWN])
            more = len(self._pattern.remarks) - MAX_SHOWN
            yield f"Left out as remarks: {shown}{f' and {more} more' if more > 0 else ''}."
        for said in self._pattern.open_repeats:
            yield f"Read once: {said[:80]!r} does not say how often, or which rows."
