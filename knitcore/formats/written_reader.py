"""Reading written rows: a strict dialect, so that what is read is what was meant.

See :mod:`knitcore.formats.written` for an example. Every row names its number; rows follow each
other without gaps. ``K3``, ``p2``, ``knit`` and ``purl`` (to the end of the row), brackets with
``twice`` or ``N times``, and one ``*…; rep from *`` with ``to end`` or ``to last N sts`` are known,
and at the edges decreases, ``m1``, casting on and binding off.
"""

from __future__ import annotations

import re
from dataclasses import dataclass

from knitcore.chart import MAX_STITCHES_PER_SIDE, StitchChart, check_size
from knitcore.errors import InputError
from knitcore.garment.piece import MAIN_YARN, Piece, PieceYarn, yarn_name
from knitcore.garment.worked_piece import PieceRow, piece_from_rows
from knitcore.worked import Construction, Side, side_of_row

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
_YARN = re.compile(r"yarn ([A-Z]{1,2}): (.*) \((#[0-9a-f]{6})\)", re.IGNORECASE)
_WITH = re.compile(r"(?:^|, )with ([A-Z]{1,2}) ", re.IGNORECASE)
_SHAPED = re.compile(r"(ssk|ssp|k2tog|p2tog|k3tog|p3tog|m1p?)(?![\w])", re.IGNORECASE)
_GAIN = re.compile(r"(cast on|bind off) (\d{1,4}) sts?, ", re.IGNORECASE)
_GAIN_AT_END = re.compile(
    r"with a separate strand cast on (\d{1,4}) sts? at the end, ", re.IGNORECASE
)
_LOSS_AT_END = re.compile(
    r", bind off the last (\d{1,4}) sts? with a separate strand$", re.IGNORECASE
)
_USES = {"": 1, "m1": 0, "m1p": 0, "k3tog": 3, "p3tog": 3}
"""Stitches of the row below that a stitch takes; all others are decreases of two."""


def looks_written(text: str) -> bool:
    """Whether a text is meant as written rows rather than as lines of K and P."""
    first = next((line.strip().lower() for line in text.splitlines() if line.strip()), "")
    return first.startswith(("cast on", "row", "rnd", "round"))


def read_rows(text: str) -> StitchChart:
    """The face grid of written instructions for a rectangle.

    Raises
    ------
    InputError
        Naming the line, what is wrong with it, and what would be read.

    Examples
    --------
    >>> print(read_rows("Cast on 3 sts. Worked flat.\nRow 1: K1, p2.\\nRows 2-3: Knit."))
    KKK
    PPP
    PPK
    """
    piece = read_piece_rows(text)
    if not piece.is_rectangle:
        raise InputError("rows", "they make no rectangle.", "Read them as a piece with an outline.")
    return piece.chart


def read_piece_rows(text: str) -> Piece:
    """The chart, the outline and the yarns of written instructions.

    Raises
    ------
    InputError
        As :func:`read_rows`.
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
        yarn = _YARN.fullmatch(line.text)
        if yarn is not None:
            reader.add_yarn(line, yarn[1].upper(), PieceYarn(yarn[2], yarn[3].lower()))
        else:
            reader.read(line)
    return reader.piece()


@dataclass(frozen=True)
class _Line:
    number: int
    text: str

    def wrong(self, problem: str, remedy: str) -> InputError:
        return InputError("rows", f"line {self.number}: {problem}", remedy)


@dataclass(frozen=True)
class _Stitch:
    """A stitch of a row: purled or knitted, how it is made ("" if just worked), of which yarn."""

    purl: bool
    form: str = ""
    yarn: int = 0

    @property
    def uses(self) -> int:
        return _USES.get(self.form, 2)


@dataclass(frozen=True)
class _Work:
    """What a line says of a row, wherever it stands."""

    first: int
    last: int
    stitches: tuple[_Stitch, ...]


Stitches = tuple[_Stitch, ...]


def _used(stitches: Stitches) -> int:
    return sum(stitch.uses for stitch in stitches)


class _Reader:
    def __init__(self, stitches: int, construction: Construction, first_side: Side) -> None:
        self._needle = stitches
        self._construction = construction
        self._first_side = first_side
        self._yarns: list[PieceYarn] = []
        self._rows: list[_Work] = []

    def piece(self) -> Piece:
        if not self._rows:
            raise InputError("rows", "there is no row.", 'Write rows such as "Row 1: Knit."')
        rows = [
            PieceRow(
                self._side(index),
                work.first,
                work.last,
                tuple(stitch.purl for stitch in work.stitches),
                tuple(stitch.yarn for stitch in work.stitches),
            )
            for index, work in enumerate(self._rows)
        ]
        return piece_from_rows(rows, self._yarns or [MAIN_YARN])

    def add_yarn(self, line: _Line, name: str, yarn: PieceYarn) -> None:
        if name != yarn_name(len(self._yarns)) or self._rows or yarn in self._yarns:
            raise line.wrong(
                f"yarn {name} cannot be named here.",
                f"Name the yarns before row 1, in order; the next is {yarn_name(len(self._yarns))}"
                ", and no two are alike.",
            )
        self._yarns.append(yarn)

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
        check_size(stop, self._needle)
        if side is not None and Side(side.upper()) is not self._side(start - 1):
            raise line.wrong(
                f"row {start} is a {self._side(start - 1)} row.",
                "Correct the side, or say in the first line on which side row 1 is.",
            )
        repeat = _REPEAT.fullmatch(body.rstrip("."))
        if repeat is not None:
            self._repeat(line, int(repeat[1]), int(repeat[2] or repeat[1]), stop - start + 1)
        else:
            work = self._row(line, body)
            for _ in range(stop - start + 1):
                self._add(line, work)

    def _add(self, line: _Line, work: _Work) -> None:
        if self._needle + work.first + work.last != len(work.stitches):
            raise line.wrong(
                f"it needs other than the {self._needle} stitches that are on the needle.",
                "Write out rows whose count differs.",
            )
        self._rows.append(work)
        self._needle = len(work.stitches)

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
        for index in range(count):
            self._add(line, unit[index % len(unit)])

    def _row(self, line: _Line, body: str) -> _Work:
        count = _COUNT.search(body)
        words = (body[: count.start()] if count else body).strip().rstrip(".").strip()
        first, last, words = self._edges(line, words)
        worked = self._needle + first + last
        if worked < 1:
            raise line.wrong("it leaves no stitch.", "Bind off fewer.")
        stitches = self._yarn_words(line, words, worked)
        if _used(stitches) != worked:
            raise line.wrong(
                f"it works {_used(stitches)} stitches, {worked} are on the needle.",
                "Correct the row, or cast on, bind off, increase or decrease at its edges.",
            )
        first, last = self._shaped(line, stitches, first, last)
        if count is not None and int(count[1]) != len(stitches):
            raise line.wrong(
                f"it says {count[1]} sts, {len(stitches)} are on the needle.", "Correct the count."
            )
        return _Work(first, last, stitches)

    def _edges(self, line: _Line, words: str) -> tuple[int, int, str]:
        """Stitches cast on and bound off at both ends, and the rest of the words."""
        first = last = 0
        gain = _GAIN.match(words)
        if gain is not None:
            first = int(gain[2]) * (1 if gain[1].lower() == "cast on" else -1)
            words = words[gain.end() :]
        if (at_end := _GAIN_AT_END.match(words)) is not None:
            last, words = int(at_end[1]), words[at_end.end() :]
        if (loss := _LOSS_AT_END.search(words)) is not None:
            last, words = last - int(loss[1]), words[: loss.start()]
        check_size(1, max(self._needle + max(first, 0) + max(last, 0), 1))
        return first, last, words

    def _shaped(self, line: _Line, stitches: Stitches, first: int, last: int) -> tuple[int, int]:
        """Gains and losses with the increases and decreases, which stand only at the edges."""
        end = len(stitches) - 1
        for index, form in ((i, s.form) for i, s in enumerate(stitches) if s.form):
            if form in ("k3tog", "p3tog") and end == 0:
                first, last = first - 1, last - 1
            elif form in ("ssk", "ssp") and index == 0:
                first -= 1
            elif form in ("k2tog", "p2tog") and index == end:
                last -= 1
            elif form in ("m1", "m1p") and index == 1 and end > 2:
                first += 1
            elif form in ("m1", "m1p") and index == end - 1 and end > 2:
                last += 1
            else:
                raise line.wrong(
                    f"{form} is stitch {index + 1} of {end + 1}.",
                    "Shape at the edges only: ssk first, k2tog last, m1 beside the edge stitch.",
                )
        return first, last

    def _yarn_words(self, line: _Line, words: str, worked: int) -> Stitches:
        if len(self._yarns) < 2:
            return self._words(line, words, worked)
        names = list(_WITH.finditer(words))
        if not names or names[0].start() != 0:
            raise line.wrong("it does not say with which yarn it begins.", 'Write "with A …".')
        stitches: Stitches = ()
        known = [yarn_name(index) for index in range(len(self._yarns))]
        for place, name in enumerate(names):
            if name[1].upper() not in known:
                raise line.wrong(f"there is no yarn {name[1]}.", f"Use {', '.join(known)}.")
            stop = names[place + 1].start() if place + 1 < len(names) else len(words)
            part, room = words[name.end() : stop], worked - _used(stitches)
            read = (
                self._words(line, part, room) if len(names) == 1 else self._items(line, part, room)
            )
            yarn = known.index(name[1].upper())
            stitches += tuple(_Stitch(s.purl, s.form, yarn) for s in read)
        return stitches

    def _words(self, line: _Line, words: str, worked: int) -> Stitches:
        star = _STAR.fullmatch(words)
        if star is None:
            return self._items(line, words, worked)
        before, unit, end, last, after = star.groups()
        head = self._items(line, before.rstrip(", "), worked) if before.strip(", ") else ()
        body = self._items(line, unit, worked)
        tail = self._items(line, after, worked) if after else ()
        wanted = 0 if end else int(last or 1)
        if _used(tail) != wanted:
            raise line.wrong(
                f"{_used(tail)} stitches follow the repeat, it says {wanted}.",
                'Make "to last N sts" agree with what follows.',
            )
        room = worked - _used(head) - _used(tail)
        if any(stitch.form for stitch in body) or room < len(body) or room % len(body):
            raise line.wrong(
                f"the {len(body)} stitches after * do not fit {room} stitches exactly.",
                f"Cast on a multiple of {len(body)} plus {_used(head) + _used(tail)} stitches.",
            )
        return head + body * (room // len(body)) + tail

    def _items(self, line: _Line, words: str, worked: int) -> Stitches:
        """Stitches and brackets, separated by commas."""
        stitches: Stitches = ()
        rest = words.strip()
        while rest:
            bracket, run, shaped = (p.match(rest) for p in (_BRACKET, _STITCHES, _SHAPED))
            if rest.lower() in ("knit", "purl"):
                found = (_Stitch(rest.lower() == "purl"),) * (worked - _used(stitches))
                used = len(rest)
            elif bracket is not None:
                inside = self._items(line, bracket[1], worked)
                times = 2 if bracket[2] else int(bracket[3])
                # More than a row can hold is told below; it need not be written out for that.
                found = inside * min(times, MAX_STITCHES_PER_SIDE + 1)
                used = bracket.end()
            elif shaped is not None:
                form = shaped[1].lower()
                purl = form in ("ssp", "p2tog", "p3tog", "m1p")
                found, used = (_Stitch(purl, form),), shaped.end()
            elif run is not None:
                found, used = (_Stitch(run[1].lower() == "p"),) * int(run[2]), run.end()
            else:
                raise line.wrong(
                    f"{rest[:30]!r} cannot be read.",
                    'Write k3, p2, (k1, p1) 3 times, or "*…; rep from * to end".',
                )
            stitches += found
            if len(stitches) > MAX_STITCHES_PER_SIDE:
                raise line.wrong("it has too many stitches.", f"Use {worked}.")
            rest = self._after_comma(line, rest[used:])
        if not stitches:
            raise line.wrong("a part of it is empty.", "Write stitches, such as k3.")
        return stitches

    def _after_comma(self, line: _Line, rest: str) -> str:
        if rest and not re.match(r", ?\S", rest):
            raise line.wrong(
                f"{rest[:30]!r} follows a stitch without a comma.", "Separate stitches by commas."
            )
        return rest.lstrip(", ")

    def _side(self, index: int) -> Side:
        return side_of_row(index, self._construction, self._first_side)
