"""KnitSpeak, the language of stitch patterns that Stitch Maps and others read: a subset.

::

    Row 1 (RS): [K1, p1] 3 times, k1.
    Row 2 (WS): *P1, k1, repeat from * to last st, p1.
    Rows 3 and 5 (RS): Knit.
    Rows 4, 6-8: Knit to last 2 sts, p2.

KnitSpeak does not mention casting on: the number of stitches follows from the rows. So the first
row is written without ``*``. Read are rows and rounds in any order and grouping, ``k``, ``p``,
``knit`` and ``purl`` (also ``to last N sts``), ``[…] twice`` and ``[…] N times``, and one
``*…, repeat from *`` (or ``rep from *``), nested brackets included; other stitches than knits and
purls are refused by name. Reference: https://stitch-maps.com/about/knitspeak/
"""

import re
from collections.abc import Iterable
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from knitcore.base.errors import InputError
from knitcore.chart.row_sides import Construction, Side, side_of_row
from knitcore.chart.stitch_chart import MAX_STITCHES_PER_SIDE, StitchChart, check_chart_size
from knitcore.formats.read.written_words import MAX_CHARACTERS, Line, lines_of
from knitcore.formats.write.written_pattern import in_brackets, row_words
from knitcore.garment.piece import MAIN_YARN
from knitcore.garment.worked_piece import PieceRow, piece_from_rows, piece_rows

Purls = tuple[bool, ...]

_LINE = re.compile(
    r"(rows?|rounds?|rnds?) ([\d ,\-–and]+?)(?: ?\((RS|WS)\))? ?: ?(.*)", re.IGNORECASE
)
_NUMBERS = re.compile(r"(\d{1,4})(?:\s?[-–]\s?(\d{1,4}))?")
_TO_END = r"(?: to (?:end|last (?:(\d{1,4}) sts|st)))?"
_STAR = re.compile(
    rf"(?:(.*?), ?)?\*([^*]*?)[,;] ?rep(?:eat)? from \*{_TO_END}(?:, ?(.*))?", re.IGNORECASE
)
_ALL = re.compile(rf"(?:(.*?), ?)?(knit|purl){_TO_END}(?:, ?(.*))?", re.IGNORECASE)
_TIMES = re.compile(r"\] ?(?:(twice)|(\d{1,4}) times)", re.IGNORECASE)
_STITCHES = re.compile(r"([kp])(\d{0,4})(?![\w])", re.IGNORECASE)


def write_knitspeak(
    chart: StitchChart,
    construction: Construction = Construction.FLAT,
    *,
    first_side: Side = Side.RS,
) -> str:
    """A chart in KnitSpeak; :func:`read_knitspeak` reads it back.

    Examples
    --------
    >>> print(write_knitspeak(StitchChart.of_fabric("rib", rows=4, columns=5)))
    Row 1 (RS): [K1, p1] twice, k1.
    Rows 2 and 4 (WS): *P1, k1, repeat from * to last st, p1.
    Row 3 (RS): *K1, p1, repeat from * to last st, k1.
    <BLANKLINE>
    """
    flat = construction is Construction.FLAT
    groups: dict[tuple[str, Side], list[int]] = {}
    for index, row in enumerate(piece_rows(chart, construction, first_side=first_side)):
        words = row_words(row.purls).replace("; rep from *", ", repeat from *")
        words = words.removesuffix(" to end")
        if index == 0:
            words = in_brackets(row.purls).replace("(", "[").replace(")", "]")
        groups.setdefault((words, row.side), []).append(index + 1)
    name = "Row" if flat else "Round"
    lines = []
    for (words, side), numbers in groups.items():
        start = next(i for i, letter in enumerate(words) if letter.isalpha())
        said = f"{words[:start]}{words[start].upper()}{words[start + 1 :]}"
        which = f" ({side})" if flat else ""
        plural = "s" if len(numbers) > 1 else ""
        lines.append(f"{name}{plural} {_listed(numbers)}{which}: {said}.")
    return "\n".join([*lines, ""])


def _listed(numbers: list[int]) -> str:
    """Row numbers in words: ``1-4, 7 and 9``."""
    edges = [0, *(i for i, (a, b) in enumerate(pairwise(numbers), 1) if b != a + 1), len(numbers)]
    parts = []
    for start, stop in pairwise(edges):
        first, last = numbers[start], numbers[stop - 1]
        parts.append(f"{first}-{last}" if last > first else str(first))
    return " and ".join(filter(None, [", ".join(parts[:-1]), parts[-1]]))


def looks_knitspeak(text: str) -> bool:
    """Say whether a text begins with rows of KnitSpeak, without casting on."""
    first = next(lines_of(text), None)
    return first is not None and _LINE.match(first.text) is not None


@dataclass(frozen=True)
class _Row:
    """A row's stitches; those of ``unit`` are repeated as often as there is room, if any."""

    line: Line
    head: Purls
    unit: Purls
    tail: Purls

    def worked(self, count: int) -> Purls | None:
        room = count - len(self.head) - len(self.tail)
        if not self.unit:
            return self.head if room == 0 else None
        if room < len(self.unit) or room % len(self.unit):
            return None
        return self.head + self.unit * (room // len(self.unit)) + self.tail


def read_knitspeak(text: str) -> StitchChart:
    """The face grid of a pattern in KnitSpeak.

    Raises
    ------
    InputError
        Naming the line, the problem and an accepted form.

    Examples
    --------
    >>> print(read_knitspeak("Rows 1 and 2: [k1, p1] twice."))
    PKPK
    PKPK
    """
    rows: dict[int, _Row] = {}
    stated: dict[int, Side] = {}
    rounds = None
    for line in lines_of(text):
        if len(line.text) > MAX_CHARACTERS:
            raise line.wrong(f"it has {len(line.text)} characters.", "Write it with repeats.")
        match = _LINE.fullmatch(line.text)
        if match is None:
            raise line.wrong(f"{line.text[:60]!r} is not a row.", 'Write "Row 1 (RS): k1, p1."')
        name, numbers, side, words = match.groups()
        is_round = not name.lower().startswith("row")
        if rounds is not None and rounds != is_round:
            raise line.wrong("rows and rounds are mixed.", "Use one of them.")
        rounds = is_round
        row = _row(line, words.rstrip(". "))
        for index in _numbers(line, numbers):
            if index in rows:
                raise line.wrong(f"row {index} is given twice.", "Write each row once.")
            rows[index] = row
            if side is not None:
                stated[index] = Side(side.upper())
    missing = next((i for i in range(1, len(rows) + 1) if i not in rows), None)
    if not rows or missing:
        raise InputError(
            "rows", f"row {missing or 1} is missing.", "Number the rows from 1 without gaps."
        )
    construction = Construction.ROUND if rounds else Construction.FLAT
    first_side = _first_side(stated, construction)
    count = _count(list(rows.values()))
    worked = []
    for index in range(1, len(rows) + 1):
        purls = rows[index].worked(count)
        if purls is None:
            raise rows[index].line.wrong(
                f"row {index} does not fit {count} stitches.", "Correct it."
            )
        side = side_of_row(index - 1, construction, first_side)
        worked.append(PieceRow(side, 0, 0, purls, (0,) * count))
    return piece_from_rows(worked, [MAIN_YARN]).chart


def _numbers(line: Line, text: str) -> Iterable[int]:
    numbers: list[int] = []
    for match in _NUMBERS.finditer(text):
        first, last = int(match[1]), int(match[2] or match[1])
        if not 1 <= first <= last <= MAX_STITCHES_PER_SIDE:
            raise line.wrong(f"rows {match[0]} cannot be made.", "Number them from 1 up.")
        numbers += range(first, last + 1)
    if not numbers:
        raise line.wrong("it numbers no row.", 'Write "Row 1:" or "Rows 2, 4 and 6-8:".')
    return numbers


def _first_side(stated: dict[int, Side], construction: Construction) -> Side:
    first_sides = {side if index % 2 else side.other for index, side in stated.items()}
    if len(first_sides) > 1 or (construction is Construction.ROUND and Side.WS in stated.values()):
        raise InputError(
            "rows", "right-side and wrong-side rows do not alternate.", "Correct RS and WS."
        )
    return first_sides.pop() if first_sides else Side.RS


def _count(rows: list[_Row]) -> int:
    """The smallest number of stitches that fits all rows."""
    fixed = [row for row in rows if not row.unit]
    if fixed:
        check_chart_size(1, len(fixed[0].head))
        return len(fixed[0].head)
    fits = (n for n in range(1, MAX_STITCHES_PER_SIDE + 1) if all(row.worked(n) for row in rows))
    count = next(fits, None)
    if count is None:
        raise InputError("rows", "no number of stitches fits all rows.", "Correct the repeats.")
    return count


def _row(line: Line, words: str) -> _Row:
    star = _STAR.fullmatch(words)
    if star is not None:
        before, body, last, after = star.groups()
        unit = _stitches(line, body)
        to_last = "to last" in words.lower()
    elif (everything := _ALL.fullmatch(words)) is not None:
        before, kind, last, after = everything.groups()
        unit, to_last = (kind.lower() == "purl",), "to last" in words.lower()
    else:
        return _Row(line, _stitches(line, words), (), ())
    head, tail = _stitches(line, before or ""), _stitches(line, after or "")
    stated = int(last or 1) if to_last else 0
    if not unit or len(tail) != stated:
        problem = f"{len(tail)} stitches follow the repeat, but it says {stated}."
        raise line.wrong(problem, 'Make "to last N sts" agree with what follows.')
    return _Row(line, head, unit, tail)


def _stitches(line: Line, words: str) -> Purls:
    """Stitches and brackets, separated by commas; brackets may hold brackets."""
    stack: list[list[bool]] = [[]]
    rest = words.strip()
    while rest:
        times, run = _TIMES.match(rest), _STITCHES.match(rest)
        if rest.startswith("["):
            stack.append([])
            rest = rest[1:].lstrip()
            continue
        if times is not None and len(stack) > 1:
            inside = stack.pop()
            often = 2 if times[1] else int(times[2])
            # more than a row can hold is refused below without being written out
            stack[-1] += inside * min(often, MAX_STITCHES_PER_SIDE + 1)
            rest = rest[times.end() :]
        elif run is not None and run[2] != "0":
            stack[-1] += [run[1].lower() == "p"] * int(run[2] or 1)
            rest = rest[run.end() :]
        else:
            raise line.wrong(
                f"{rest[:30]!r} is not a knit or a purl.",
                "Write k3, p2, [k1, p1] 3 times or *…, repeat from *; no lace, cables or shaping.",
            )
        if len(stack[-1]) > MAX_STITCHES_PER_SIDE:
            raise line.wrong("it has too many stitches.", f"Use {MAX_STITCHES_PER_SIDE}.")
        rest = rest.lstrip(" ,")
    if len(stack) > 1:
        raise line.wrong("a bracket is not closed.", 'Write "[k1, p1] twice".')
    return tuple(np.array(stack[0], dtype=bool).tolist())
