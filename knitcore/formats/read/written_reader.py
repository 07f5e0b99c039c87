"""Reading written rows: a strict dialect without ambiguity.

See :mod:`knitcore.formats.write.written_pattern` for an example. Every row names its number; rows
follow each other without gaps. ``K3``, ``p2``, ``knit`` and ``purl`` (to the end of the row),
brackets with ``twice`` or ``N times``, and one ``*…; rep from *`` with ``to end`` or ``to last N
sts`` are known, and at the edges decreases, ``m1``, casting on and binding off.
"""

import re

from knitcore.base.errors import InputError
from knitcore.chart.row_sides import Construction, Side, side_of_row
from knitcore.chart.stitch_chart import StitchChart, check_chart_size
from knitcore.formats.read.written_words import Line, Work, lines_of, read_row
from knitcore.garment.piece import MAIN_YARN, Piece, PieceYarn, yarn_name
from knitcore.garment.worked_piece import PieceRow, piece_from_rows

_CAST_ON = re.compile(r"cast on (\d{1,4}) sts?( and join in the round)?\.(.*)", re.IGNORECASE)
_WRONG_FIRST = re.compile(r"row 1 is a wrong-side row", re.IGNORECASE)
_ROW = re.compile(
    r"(rows?|rnds?|rounds?) (\d{1,4})(?:\s*[-–]\s*(\d{1,4}))?\s*(?:\((RS|WS)\))?\s*:\s*(.*)",
    re.IGNORECASE,
)
_REPEAT = re.compile(
    r"repeat (?:rows?|rnds?|rounds?) (\d{1,4})(?:\s*[-–]\s*(\d{1,4}))?", re.IGNORECASE
)
_END = re.compile(r"bind off.*", re.IGNORECASE)
_YARN = re.compile(r"yarn ([A-Z]{1,2}): (.*) \((#[0-9a-f]{6})\)", re.IGNORECASE)


def looks_written(text: str) -> bool:
    """Say whether a text is meant as written rows rather than as lines of K and P."""
    first = next(lines_of(text), None)
    return first is not None and first.text.lower().startswith(("cast on", "row", "rnd", "round"))


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
    """
    piece = read_piece_rows(text)
    if not piece.is_rectangle:
        raise InputError("rows", "they do not make a rectangle.", "Read them with read_piece_rows.")
    return piece.chart


def read_piece_rows(text: str) -> Piece:
    """The chart, the outline and the yarns of written instructions.

    Raises
    ------
    InputError
        As :func:`read_rows`.
    """
    lines = list(lines_of(text))
    cast_on = _CAST_ON.fullmatch(lines[0].text) if lines else None
    if cast_on is None:
        problem = "the first line does not say how many stitches are cast on."
        remedy = 'Begin with "Cast on 20 sts." (add "and join in the round" for rounds).'
        raise InputError("rows", problem, remedy)
    stitches = int(cast_on[1])
    check_chart_size(1, stitches)
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


class _Reader:
    def __init__(self, stitches: int, construction: Construction, first_side: Side) -> None:
        self._needle = stitches
        self._construction = construction
        self._first_side = first_side
        self._yarns: list[PieceYarn] = []
        self._rows: list[Work] = []

    def piece(self) -> Piece:
        if not self._rows:
            raise InputError("rows", "there are no rows.", 'Write rows such as "Row 1: Knit."')
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

    def add_yarn(self, line: Line, name: str, yarn: PieceYarn) -> None:
        if name != yarn_name(len(self._yarns)) or self._rows or yarn in self._yarns:
            raise line.wrong(
                f"yarn {name} cannot be named here.",
                f"Name the yarns before row 1, in order; the next is {yarn_name(len(self._yarns))}"
                ", and no two are alike.",
            )
        self._yarns.append(yarn)

    def read(self, line: Line) -> None:
        match = _ROW.fullmatch(line.text)
        if match is None:
            raise line.wrong(
                f"{line.text[:60]!r} is not a row.", 'Write "Row 1 (RS): …" or "Rows 3-8: …".'
            )
        name, first, last, side, body = match.groups()
        start, stop = int(first), int(last or first)
        self._check_name(line, name)
        if start != len(self._rows) + 1 or stop < start:
            problem = f"it is for row {start}, but row {len(self._rows) + 1} comes next."
            raise line.wrong(problem, "Number the rows from 1 without gaps.")
        check_chart_size(stop, self._needle)
        if side is not None and Side(side.upper()) is not self._side(start - 1):
            remedy = "Correct the side, or say in the first line on which side row 1 is."
            raise line.wrong(f"row {start} is a {self._side(start - 1)} row.", remedy)
        repeat = _REPEAT.fullmatch(body.rstrip("."))
        if repeat is not None:
            self._repeat(line, int(repeat[1]), int(repeat[2] or repeat[1]), stop - start + 1)
        else:
            work = read_row(line, body, self._needle, len(self._yarns))
            for _ in range(stop - start + 1):
                self._add(line, work)

    def _add(self, line: Line, work: Work) -> None:
        if self._needle + work.first + work.last != len(work.stitches):
            problem = f"it does not fit the {self._needle} stitches on the needle."
            raise line.wrong(problem, "Write out rows with another count.")
        self._rows.append(work)
        self._needle = len(work.stitches)

    def _check_name(self, line: Line, name: str) -> None:
        is_round = name.lower().startswith(("rnd", "round"))
        if is_round != (self._construction is Construction.ROUND):
            remedy = 'Write "Rnd" after "join in the round", and "Row" in flat knitting.'
            raise line.wrong("rows and rounds are mixed.", remedy)

    def _repeat(self, line: Line, first: int, last: int, count: int) -> None:
        if not 1 <= first <= last <= len(self._rows):
            raise line.wrong(
                f"rows {first}-{last} are not all written before it.", "Repeat earlier rows."
            )
        unit = self._rows[first - 1 : last]
        for index in range(count):
            self._add(line, unit[index % len(unit)])

    def _side(self, index: int) -> Side:
        return side_of_row(index, self._construction, self._first_side)
