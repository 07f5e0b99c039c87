"""Reading written rows: a strict dialect, so that what is read is what was meant.

See :mod:`knitcore.formats.written` for an example. Every row names its number; rows follow each
other without gaps. ``K3``, ``p2``, ``knit`` and ``purl`` (to the end of the row), brackets with
``twice`` or ``N times``, and one ``*…; rep from *`` with ``to end`` or ``to last N sts`` are known.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from knitcore.chart import MAX_STITCHES_PER_SIDE, StitchChart, check_size
from knitcore.errors import InputError
from knitcore.worked import Construction, Side, WorkedRow, WorkedRows, face_grid, side_of_row

Purls = tuple[bool, ...]

_CAST_ON = re.compile(r"cast on (\d{1,4}) sts?( and join in the round)?\.(.*)", re.IGNORECASE)
_WRONG_FIRST = re.compile(r"row 1 is a wrong-side row", re.IGNORECASE)
_ROW = re.compile(
    r"(rows?|rnds?|rounds?) (\d{1,4})(?:\s*[-–]\s*(\d{1,4}))?\s*(?:\((RS|WS)\))?\s*:\s*(.*)",
    re.IGNORECASE,
)
_REPEAT = re.compile(
    r"repeat (?:rows?|rnds?|rounds?) (\d{1,4})(?:\s*[-–]\s*(\d{1,4}))?", re.IGNORECASE
)
_COUNT = re.compile(r"\((\d{1,4}) sts?\)$", re.IGNORECASE)
_STITCHES = re.compile(r"([kp])(\d{1,4})", re.IGNORECASE)
_BRACKET = re.compile(r"\(([^()]*)\) (?:(twice)|(\d{1,4}) times)", re.IGNORECASE)
_STAR = re.compile(
    r"(.*?)\*([^*;]*); rep from \* (?:to (end)|to last (?:(\d{1,4}) sts|st))(?:, (.*))?",
    re.IGNORECASE,
)
_END = re.compile(r"bind off.*", re.IGNORECASE)


def looks_written(text: str) -> bool:
    """Whether a text is meant as written rows rather than as lines of K and P."""
    first = next((line.strip().lower() for line in text.splitlines() if line.strip()), "")
    return first.startswith(("cast on", "row", "rnd", "round"))


def read_rows(text: str) -> StitchChart:
    """The face grid of written instructions.

    Raises
    ------
    InputError
        Naming the line, what is wrong with it, and what would be read.

    Examples
    --------
    >>> print(read_rows("Cast on 3 sts. Worked flat.\\nRow 1: K1, p2.\\nRows 2-3: Knit."))
    KKK
    PPP
    PPK
    """
    lines = [
        _Line(number, " ".join(line.split()))
        for number, line in enumerate(text.lstrip("\ufeff").splitlines(), start=1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    cast_on = _CAST_ON.fullmatch(lines[0].text) if lines else None
    if cast_on is None:
        raise InputError(
            "rows",
            "the first line does not say how many stitches are cast on.",
            'Begin with "Cast on 20 sts." (add "and join in the round" for rounds).',
        )
    stitches = int(cast_on[1])
    check_size(1, stitches)
    construction = Construction.ROUND if cast_on[2] else Construction.FLAT
    wrong_first = _WRONG_FIRST.search(cast_on[3]) is not None
    reader = _Reader(stitches, construction, Side.WS if wrong_first else Side.RS)
    for line in lines[1:]:
        if _END.fullmatch(line.text):
            break
        reader.read(line)
    return reader.chart()


@dataclass(frozen=True)
class _Line:
    number: int
    text: str

    def wrong(self, problem: str, remedy: str) -> InputError:
        return InputError("rows", f"line {self.number}: {problem}", remedy)


class _Reader:
    def __init__(self, stitches: int, construction: Construction, first_side: Side) -> None:
        self._stitches = stitches
        self._construction = construction
        self._first_side = first_side
        self._rows: list[Purls] = []

    def chart(self) -> StitchChart:
        if not self._rows:
            raise InputError("rows", "there is no row.", 'Write rows such as "Row 1: Knit."')
        worked = [WorkedRow(self._side(i), purls) for i, purls in enumerate(self._rows)]
        return face_grid(WorkedRows(self._construction, self._first_side, tuple(worked)))

    def read(self, line: _Line) -> None:
        match = _ROW.fullmatch(line.text)
        if match is None:
            raise line.wrong(
                f"{line.text[:60]!r} is no row.", 'Write "Row 1 (RS): …" or "Rows 3-8: …".'
            )
        name, first, last, side, body = match.groups()
        start, stop = int(first), int(last or first)
        self._check_name(line, name)
        if start != len(self._rows) + 1 or stop < start:
            raise line.wrong(
                f"it is for row {start}, but row {len(self._rows) + 1} comes next.",
                "Number the rows from 1 without gaps.",
            )
        check_size(stop, self._stitches)
        if side is not None and Side(side.upper()) is not self._side(start - 1):
            raise line.wrong(
                f"row {start} is a {self._side(start - 1)} row.",
                "Correct the side, or say in the first line on which side row 1 is.",
            )
        repeat = _REPEAT.fullmatch(body.rstrip("."))
        if repeat is not None:
            self._repeat(line, int(repeat[1]), int(repeat[2] or repeat[1]), stop - start + 1)
        else:
            self._rows += [self._row(line, body)] * (stop - start + 1)

    def _check_name(self, line: _Line, name: str) -> None:
        is_round = name.lower().startswith(("rnd", "round"))
        if is_round != (self._construction is Construction.ROUND):
            raise line.wrong(
                "rows and rounds are mixed.",
                'Write "Rnd" after "join in the round", and "Row" in flat knitting.',
            )

    def _repeat(self, line: _Line, first: int, last: int, count: int) -> None:
        if not 1 <= first <= last <= len(self._rows):
            raise line.wrong(
                f"rows {first}-{last} are not all written before it.", "Repeat earlier rows."
            )
        unit = self._rows[first - 1 : last]
        self._rows += [unit[i % len(unit)] for i in range(count)]

    def _row(self, line: _Line, body: str) -> Purls:
        count = _COUNT.search(body)
        words = (body[: count.start()] if count else body).strip().rstrip(".").strip()
        purls = self._words(line, words)
        if len(purls) != self._stitches:
            raise line.wrong(
                f"it works {len(purls)} stitches, {self._stitches} are on the needle.",
                "Correct the row: stitches are neither increased nor decreased.",
            )
        if count is not None and int(count[1]) != self._stitches:
            raise line.wrong(
                f"it says {count[1]} sts, {self._stitches} are on the needle.", "Correct the count."
            )
        return purls

    def _words(self, line: _Line, words: str) -> Purls:
        star = _STAR.fullmatch(words)
        if star is None:
            return self._items(line, words)
        before, unit, end, last, after = star.groups()
        head = self._items(line, before.rstrip(", ")) if before.strip(", ") else ()
        body = self._items(line, unit)
        tail = self._items(line, after) if after else ()
        wanted = 0 if end else int(last or 1)
        if len(tail) != wanted:
            raise line.wrong(
                f"{len(tail)} stitches follow the repeat, it says {wanted}.",
                'Make "to last N sts" agree with what follows.',
            )
        room = self._stitches - len(head) - len(tail)
        if room < len(body) or room % len(body):
            raise line.wrong(
                f"the {len(body)} stitches after * do not fit {room} stitches exactly.",
                f"Cast on a multiple of {len(body)} plus {len(head) + len(tail)} stitches.",
            )
        return head + body * (room // len(body)) + tail

    def _items(self, line: _Line, words: str) -> Purls:
        """Stitches and brackets, separated by commas."""
        purls: Purls = ()
        rest = words.strip()
        while rest:
            bracket, stitches = _BRACKET.match(rest), _STITCHES.match(rest)
            if rest.lower() in ("knit", "purl"):
                found, used = (rest.lower() == "purl",) * (self._stitches - len(purls)), len(rest)
            elif bracket is not None:
                inside = self._items(line, bracket[1])
                times = 2 if bracket[2] else int(bracket[3])
                # More than a row can hold is told below; it need not be written out for that.
                found = inside * min(times, MAX_STITCHES_PER_SIDE + 1)
                used = bracket.end()
            elif stitches is not None:
                found, used = (stitches[1].lower() == "p",) * int(stitches[2]), stitches.end()
            else:
                raise line.wrong(
                    f"{rest[:30]!r} cannot be read.",
                    'Write k3, p2, (k1, p1) 3 times, or "*…; rep from * to end".',
                )
            purls += found
            if len(purls) > MAX_STITCHES_PER_SIDE:
                raise line.wrong("it has too many stitches.", f"Use {self._stitches}.")
            rest = self._after_comma(line, rest[used:])
        if not purls:
            raise line.wrong("a part of it is empty.", "Write stitches, such as k3.")
        return purls

    def _after_comma(self, line: _Line, rest: str) -> str:
        if rest and not re.match(r", ?\S", rest):
            raise line.wrong(
                f"{rest[:30]!r} follows a stitch without a comma.", "Separate stitches by commas."
            )
        return rest.lstrip(", ")

    def _side(self, index: int) -> Side:
        return side_of_row(index, self._construction, self._first_side)
