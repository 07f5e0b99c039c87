"""Charts drawn with letters and signs: K and P, the signs of printed charts, squares, and blanks.

Read are the signs of the Craft Yarn Council and of JIS L 0201 (a blank square or ``|`` is a knit;
``•``, ``-``, ``—``, ``·`` or ``ー`` a purl), squares (``□ ■``), row numbers at either side, numbers
of columns, borders, tables, and a legend (``x = purl``). A sign with another meaning in those
systems is refused with its name. Whatever is left out, or could be read otherwise, is noted.
"""

import re
import unicodedata
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise

from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import MAX_STITCHES_PER_SIDE, StitchChart, check_chart_size

MAX_CHARACTERS = 4 * MAX_STITCHES_PER_SIDE**2
"""The largest chart with a space and a bar beside every stitch."""
BLANK = " "
_KNIT = frozenset("Kk|│∣□☐▢⬜◻▯◽▫")
_PURL = frozenset("Pp•–-—−―ー─━_·∙・●⚫■▪⬛◼▮◾⬤")
_EMPTY, _MARKED = frozenset(".~○◯oO0"), frozenset("xX×✕✗#@*+=1")
"""Signs that mean a knit, or a purl, only beside one of the other kind."""
_YARN_OVERS = frozenset("○◯oO0")
_FILLED = frozenset("●⚫■▪⬛◼▮◾⬤")
_NAMES = {
    **dict.fromkeys("○◯oO", "a yarn over"),
    **dict.fromkeys("/⟋╱／⁄", "k2tog, a decrease"),
    **dict.fromkeys("\\⟍╲＼", "ssk, a decrease"),
    **dict.fromkeys("∧⋀Λ^▲△⋏⩚", "a double decrease"),
    **dict.fromkeys("VvＶ∨⋁", "a slipped stitch or an increase"),
    **dict.fromkeys("Mm", "an increase"),
    **dict.fromkeys("QqℓϘ⊗Tt", "a twisted stitch"),
    **dict.fromkeys("◎⊙Bb", "a bobble"),
    **dict.fromkeys("<>≷≶⤫⤬", "a cable or a crossing"),
    **dict.fromkeys("░▒▓█▩", "no stitch"),
}
_NUMBER = r"(?:row\s?|r)?(\d{1,4})"
_LEFT = re.compile(rf"\s*{_NUMBER}[.:)]?(?=[\s|│┃║KkPp□■•\-])", re.IGNORECASE)
_RIGHT = re.compile(rf"(?<=[\s|│┃║KkPp□■•\-])[.:(]?{_NUMBER}\s*$", re.IGNORECASE)
_BARS = "|│┃║"
_CORNERS = "┌┐└┘├┤┬┴┼╔╗╚╝╠╣╦╩╬┏┓┗┛┣┫┳┻╋"
_BORDER = re.compile(rf"(?=.*[+═|{_CORNERS}])[-+─━═=_{_CORNERS}|\s:]+")
_RULE = re.compile(
    r"\s*\|?(?:\s*:?[-=]{2,}:?\s*\||\s*:-:\s*\|)+(?:\s*:?-{2,}:?)?\s*|\s*[-=]{3,}\s*"
)
_DIGITS = re.compile(r'[\d\s|│,;"]*')
_CELL = re.compile(r"\|\s\S\s\|")
_LEGEND = re.compile(
    r"\s*(?P<sign>\S|blank|empty|\(blank\)|\(empty\))(?:\s*[=:→]+\s*|\s+[-–]\s+|\s+)(?P<words>.*[A-Za-z\u3040-\u30fb\u30fd-\u9fff].*)",
    re.IGNORECASE,
)
_HEADING = re.compile(r"\s*(?:legend|key|symbols?)\b.{0,20}", re.IGNORECASE)
_KIND = re.compile(r"(?P<knit>\bknit|\bk\b|表)|(?P<purl>\bpurl|\bp\b|裏)", re.IGNORECASE)
_WORDS = ("knit", "purl")
_NUMBER_CELL = r'"?(?:row\s?|r)?(?P<count>\d{1,4})"?[.:)]?'
_NUMBER_CELLS = [
    re.compile(pattern, re.IGNORECASE)
    for pattern in (
        rf"^(?P<border>)\s*{_NUMBER_CELL}\s*[,;\t]",
        rf"^(?P<border>\s*[{_BARS}])\s*{_NUMBER_CELL}\s*[{_BARS}]",
        rf"[,;\t]\s*{_NUMBER_CELL}\s*(?P<border>)$",
        rf"[{_BARS}]\s*{_NUMBER_CELL}\s*(?P<border>[{_BARS}]\s*)$",
    )
]
"""A number in the first or the last cell of a row of a table."""
_SEPARATORS = re.compile(r"[,;\t]")


def read_text_chart(text: str) -> tuple[StitchChart, tuple[str, ...]]:
    """The chart of a text, the top row first, and notes on how its signs were read.

    Raises
    ------
    InputError
        Naming the line and the stitch.

    Examples
    --------
    >>> chart, notes = read_text_chart("- -\\n -")
    >>> print(chart)
    PKP
    KPK
    >>> notes
    ('The 3 blank squares are read as knits, as in printed charts.',)
    """
    lines = text.lstrip("\ufeff").splitlines()
    if len(text) > MAX_CHARACTERS:
        remedy = f"Use at most {MAX_STITCHES_PER_SIDE} rows and {MAX_STITCHES_PER_SIDE} columns."
        raise InputError("chart", f"the text has {len(text)} characters.", remedy)
    if not any(_is_drawn_with_hashes(line) or _is_framed(line) for line in lines):
        try:
            return StitchChart.parse(text), tuple(_mixed(text))
        except InputError as strict:
            return _Reader(lines, strict).read()
    return _Reader(lines, None).read()


@dataclass(frozen=True)
class _Row:
    """A row of the drawing: its line, its number if it has one, and its signs."""

    line: int
    number: int | None
    signs: str


class _Reader:
    def __init__(self, lines: Sequence[str], strict: InputError | None) -> None:
        self._lines, self._strict = lines, strict
        self._notes: list[str] = []
        self._legend: dict[str, bool] = {}
        self._named: dict[str, str] = {}
        """Other stitches of the legend."""
        self._has_border = False

    def read(self) -> tuple[StitchChart, tuple[str, ...]]:
        drawn = list(self._drawn())
        if not drawn:
            raise self._strict or InputError(
                "chart", "the chart has no stitches.", "Give at least one row of K/P."
            )
        check_chart_size(len(drawn), 1)
        rows = self._squares(self._numbered(drawn))
        rows = self._ordered(rows)
        width = max(len(row.signs) for row in rows)
        check_chart_size(len(rows), width)
        for row in rows:
            if len(row.signs) != width:
                problem = f"line {row.line} has {len(row.signs)} stitches, another has {width}."
                remedy = "Give every row the same number of stitches."
                raise InputError("chart", problem, remedy)
        purls = self._meanings(rows)
        text = "\n".join("".join("KP"[purls[s]] for s in row.signs) for row in rows)
        return StitchChart.parse(text), tuple(self._notes)

    def _drawn(self) -> Iterator[tuple[int, str]]:
        """Lines of the drawing; legend, titles, borders and numbers of columns are noted."""
        left_out: list[str] = []
        seen = False
        gap = underlined = 0
        has_cells = any(_CELL.search(line) for line in self._lines)
        has_signs = not all(_DIGITS.fullmatch(line) for line in self._lines)
        for number, raw in enumerate(self._lines, start=1):
            line = "".join(_plain(sign) for sign in raw).rstrip(BLANK)
            if not line.strip():
                gap = number if seen else 0
                continue
            if line.lstrip().startswith("#") and not _is_drawn_with_hashes(line):
                continue
            if self._is_legend(line):
                underlined = number + 1 if line.strip(" :").isalpha() else 0
                continue
            if _is_prose(line):
                left_out.append(line.strip())
                continue
            if _BORDER.fullmatch(line) and set(line) & set("+┌└├╔╚╠┏┗┣═"):
                self._has_border = True
                continue
            if (has_cells or number == underlined) and _RULE.fullmatch(line):
                continue
            if has_signs and _DIGITS.fullmatch(line) and set(line) & set("23456789"):
                self._note("The line of column numbers is left out.")
                continue
            if gap and self._is_blank_row(line):
                raise InputError(
                    "chart",
                    f"line {gap} is blank: a row of knits, or a gap.",
                    "Write its knits as |, or take the line out.",
                )
            gap, seen = 0, True
            yield number, line
        if left_out:
            shown = "; ".join(repr(words[:60]) for words in left_out[:3])
            more = f" and {len(left_out) - 3} more" if len(left_out) > 3 else ""
            self._notes.append(f"Left out as remarks: {shown}{more}.")

    def _note(self, note: str) -> None:
        if note not in self._notes:
            self._notes.append(note)

    def _is_blank_row(self, line: str) -> bool:
        """Say whether a blank line before this one may be a row of blank squares."""
        return not set(line) & (_KNIT | set(_BARS))

    def _is_legend(self, line: str) -> bool:
        match = _LEGEND.fullmatch(line)
        if match is None or _is_chart_words(match["words"]):
            return _HEADING.fullmatch(line) is not None
        sign = match["sign"] if len(match["sign"]) == 1 else BLANK
        kind = _KIND.search(match["words"])
        is_word = re.match(r"\s*(?:k|p|knit|purl|表|裏)", match["words"], re.IGNORECASE)
        if kind is None or (is_word is None and not re.search(r"[=:→–-]", line)):
            if not re.search(r"[=:→]", line):
                return False
            self._named[sign] = match["words"].strip()[:40]
            self._legend.pop(sign, None)
            return True
        self._legend[sign] = kind["purl"] is not None
        return True

    def _numbered(self, drawn: Sequence[tuple[int, str]]) -> list[_Row]:
        """Rows without the numbers beside them."""
        if all(set(line) <= set("01 \t,;|") for _, line in drawn):
            return [_Row(number, None, line) for number, line in drawn]
        drawn, cells = _without_number_cells(drawn)
        if any(cells):
            self._note("The numbers beside the rows are left out.")
            return [
                _Row(number, count, line)
                for (number, line), count in zip(drawn, cells, strict=True)
            ]
        left = [_LEFT.match(line) for _, line in drawn]
        right = [_RIGHT.search(line) for _, line in drawn]
        start = max((m.end() for m in left if m), default=0)
        rows = []
        for (number, line), before, after in zip(drawn, left, right, strict=True):
            said = {int(m[1]) for m in (before, after) if m}
            if len(said) > 1:
                problem = f"line {number} is numbered {' and '.join(map(str, sorted(said)))}."
                raise InputError("chart", problem, "Number each row once.")
            signs = line[: after.start()] if after else line
            if before:
                signs = BLANK * before.end() + signs[before.end() :]
            rows.append(_Row(number, said.pop() if said else None, signs))
        if not any(left) and not any(right):
            return rows
        self._note("The numbers beside the rows are left out.")
        if any(left):
            start += int(all(row.signs[start : start + 1] in ("", BLANK) for row in rows))
            rows = [_Row(row.line, row.number, row.signs[start:]) for row in rows]
        if any(right):
            stop = max(len(row.signs.rstrip()) for row in rows)
            rows = [_Row(row.line, row.number, row.signs[:stop]) for row in rows]
        return rows

    def _squares(self, rows: list[_Row]) -> list[_Row]:
        """Rows with one sign a stitch: cells of a table, a frame taken off, or columns of text."""
        signs = set("".join(row.signs for row in rows))
        if signs & set(",;\t"):
            cells = [_SEPARATORS.split(row.signs.rstrip(BLANK)) for row in rows]
            return self._from_cells(rows, cells)
        stripped = [row.signs.strip() for row in rows]
        has_knit = bool(signs & (_KNIT - set(_BARS))) or self._legend.get(BLANK) is False
        for bar in _BARS:
            if not all(len(s) > 1 and s[0] == s[-1] == bar for s in stripped):
                continue
            cells = [s[1:-1].split(bar) for s in stripped]
            is_table = all(len(cell.strip()) <= 1 for row in cells for cell in row)
            is_table = is_table and len({len(row) for row in cells}) == 1
            is_empty = any(not cell.strip() for row in cells for cell in row)
            is_frame = has_knit or self._has_border or bar != "|"
            if is_table and len(cells[0]) > 1 and (is_frame or is_empty):
                self._note("Bars between the stitches are taken as lines of the grid.")
                return self._from_cells(rows, cells)
            if all(len(row) == 1 for row in cells) and (is_frame or is_blank(cells)):
                self._note("Bars at both ends of the rows are taken as the chart's border.")
                inner = [cell[0] for cell in cells]
                width = max(len(cell) for cell in inner)
                if not any(BLANK in cell.strip() or len(cell) < width for cell in inner):
                    inner = [cell.strip() for cell in inner]
                rows = [
                    _Row(row.line, row.number, cell.ljust(width))
                    for row, cell in zip(rows, inner, strict=True)
                ]
                return self._from_columns(rows, framed=True)
        return self._from_columns(rows, framed=False)

    def _from_cells(self, rows: list[_Row], cells: list[list[str]]) -> list[_Row]:
        if len({len(row) for row in cells}) > 1 or all(not row[-1].strip() for row in cells):
            cells = [row[:-1] if not row[-1].strip() else row for row in cells]
        cells = [[part.strip(' "') for part in row] for row in cells]
        if any("" in row for row in cells):  # blanks at the end of a line may be cut off
            width = max(map(len, cells))
            cells = [row + [""] * (width - len(row)) for row in cells]
        done = []
        for row, parts in zip(rows, cells, strict=True):
            signs = [part[:1] or BLANK for part in parts]
            for column, part in enumerate(parts, start=1):
                if len(part) > 1 and part.lower() not in _WORDS:
                    raise self._wrong(row.line, column, part)
            done.append(_Row(row.line, row.number, "".join(signs)))
        return done

    def _from_columns(self, rows: list[_Row], *, framed: bool) -> list[_Row]:
        """Each column of the text is a stitch, unless blanks stand between all stitches."""
        texts = [row.signs.rstrip() if not framed else row.signs for row in rows]
        used = {i for text in texts for i, sign in enumerate(text) if sign != BLANK}
        start = 0 if framed else min(used)
        width = max(map(len, texts)) if framed else max(used) + 1
        signs = set("".join(texts)) - {BLANK}
        knits = {s for s in signs if self._legend.get(s, s not in _KNIT) is False}
        explicit = bool(knits) or (len(signs) > 1 and bool(signs & _EMPTY))
        apart = width - start > 2 and len({i % 2 for i in used}) == 1
        if apart and not explicit and not signs <= set("Pp") and self._legend.get(BLANK) is None:
            raise InputError(
                "chart",
                "blanks stand between all its stitches: they are knits, or only spaces.",
                "Write the knits as | or K, or take the blanks out.",
            )
        columns = list(range(start, width))
        if apart and (explicit or signs <= set("Pp")):
            columns = list(range(min(used), width, 2))
        elif explicit:
            columns = [i for i in columns if i in used]
        return [
            _Row(row.line, row.number, "".join(text[i : i + 1] or BLANK for i in columns))
            for row, text in zip(rows, texts, strict=True)
        ]

    def _ordered(self, rows: list[_Row]) -> list[_Row]:
        """Rows from the top; their numbers count from the bottom."""
        numbers = [(index, row.number) for index, row in enumerate(rows) if row.number is not None]
        if not numbers:
            return rows
        (first, number), last = numbers[0], numbers[-1][1]
        step = 1 if last is not None and number is not None and last > number else -1
        for index, count in numbers:
            if number is None or count != number + step * (index - first):
                problem = f"line {rows[index].line} is numbered {count}, which is out of order."
                raise InputError("chart", problem, "Number the rows without gaps.")
        if step > 0:
            self._notes.append(
                "Row numbers rise from the top of the text: rows are put in their order, row 1 at "
                "the bottom."
            )
            return rows[::-1]
        return rows

    def _meanings(self, rows: Sequence[_Row]) -> dict[str, bool]:
        """For each sign, whether it is a purl."""
        signs = set("".join(row.signs for row in rows))
        purls = {s: s in _PURL for s in signs if s in _KNIT | _PURL}
        purls.update({s: self._legend[s] for s in signs if s in self._legend})
        knits = {sign for sign, purl in purls.items() if not purl}
        if BLANK in signs and BLANK not in purls and True in purls.values() and knits <= set("|"):
            purls[BLANK] = False
        elif BLANK in signs and BLANK not in purls and signs - {BLANK} <= _MARKED:
            purls |= {s: s != BLANK for s in signs}
        open_signs = signs - set(purls)
        if len(open_signs) == 1 and len(set(purls.values())) == 1:
            (sign,) = open_signs
            other = next(iter(purls.values()))
            is_over = sign in _YARN_OVERS and not (set(purls) <= _FILLED)
            is_letter = sign.isalpha() and not set(purls).isdisjoint("KkPp")
            is_open = sign in _EMPTY | _MARKED and sign not in self._named
            if is_open and not is_over and not is_letter:
                purls[sign] = not other
        elif open_signs == signs and len(signs) == 2 and signs & _EMPTY and signs & _MARKED:
            purls |= {s: s in _MARKED for s in signs}
        for row in rows:
            for column, sign in enumerate(row.signs, start=1):
                if sign not in purls:
                    raise self._wrong(row.line, column, sign)
        self._note_signs(rows, purls)
        return purls

    def _note_signs(self, rows: Sequence[_Row], purls: dict[str, bool]) -> None:
        blanks = sum(row.signs.count(BLANK) for row in rows)
        if blanks and not purls[BLANK] and BLANK not in self._legend:
            said = f"The {blanks} blank squares are" if blanks > 1 else "The blank square is"
            plural = "knits" if blanks > 1 else "a knit"
            self._notes.append(f"{said} read as {plural}, as in printed charts.")
        strange = sorted(s for s in purls if s not in "KkPp|•–-" and s != BLANK)
        meanings = [f"{sign} as {'purl' if purls[sign] else 'knit'}" for sign in strange]
        if meanings:
            by = " by its legend" if any(s in self._legend for s in strange) else ""
            self._notes.append(f"Signs are read{by}: {', '.join(meanings)}.")

    def _wrong(self, line: int, column: int, sign: str) -> InputError:
        name = self._named.get(sign) or _NAMES.get(sign)
        if sign == BLANK:
            problem = f"line {line}, stitch {column} is blank, but knits have a sign of their own."
            return self._strict or InputError("chart", problem, "Write every stitch as K or P.")
        what = f" ({name})" if name else ""
        return InputError(
            "chart",
            f"line {line}, stitch {column} is {sign!r}{what}, which is neither K nor P.",
            'Write every stitch as K or P, or add a legend such as "x = purl".',
        )


def _without_number_cells(
    drawn: Sequence[tuple[int, str]],
) -> tuple[list[tuple[int, str]], list[int | None]]:
    """Rows of a table without their first or last cell, where it has the number of every row."""
    rows = list(drawn)
    counts: list[int | None] = [None] * len(drawn)
    for pattern in _NUMBER_CELLS:
        matches = [pattern.search(line) for _, line in rows]
        numbers = [int(m["count"]) for m in matches if m is not None]
        steps = {b - a for a, b in pairwise(numbers)}
        if len(numbers) < max(len(rows), 2) or steps not in ({1}, {-1}):
            continue
        if counts[0] is not None and counts != numbers:
            continue
        counts = list(numbers)
        rows = [
            (number, line[: m.start()] + m["border"] + line[m.end() :])
            for (number, line), m in zip(rows, matches, strict=True)
            if m is not None
        ]
    return rows, counts


def is_blank(cells: Sequence[Sequence[str]]) -> bool:
    """Say whether there is a blank between signs, or at one end of some rows only."""
    inner = [row[0] for row in cells]
    ends = {(text[:1] == BLANK, text[-1:] == BLANK) for text in inner}
    return any(BLANK in text.strip() for text in inner) or len(ends) > 1


def _mixed(text: str) -> Iterator[str]:
    """Notes on signs that stand beside letters of the same meaning, and may be something else."""
    lines = (line for line in text.splitlines() if not line.lstrip().startswith("#"))
    signs = set("".join(lines))
    for kind, letters, others in (("knit", "Kk", "|"), ("purl", "Pp", "•–-")):
        both = [part for part in (letters, others) if signs & set(part)]
        if len(both) == 2:
            name = next(sign for sign in others if sign in signs)
            yield f"{name} is read as {kind}, like {letters[0]}."


def _plain(sign: str) -> str:
    """A sign of full width as one of half width, other blanks as blanks."""
    if sign.isspace() and sign != "\t":
        return BLANK
    plain = unicodedata.normalize("NFKC", sign)
    return plain if len(plain) == 1 and not sign.isspace() else sign


def _is_drawn_with_hashes(line: str) -> bool:
    """Say whether a line is drawn with # rather than a comment."""
    signs = line.strip()
    return (
        signs.startswith("#")
        and len(signs) > 1
        and bool(set(signs) & set(".-~ "))
        and not (re.search(r"[A-Za-z0-9]", signs))
    )


def _is_framed(line: str) -> bool:
    """Say whether bars at both ends of a line are no knits: beside letters, or an empty cell."""
    signs = line.strip()
    is_between = len(signs) > 2 and signs[0] == signs[-1] == "|"
    return is_between and (
        bool(set(signs) & set("Kk")) or re.search(r"\| {2,}\|", signs) is not None
    )


def _is_chart_words(words: str) -> bool:
    return not set(words) - set("KkPp ,;\t0123456789") - _KNIT - _PURL - set(_BARS)


def _is_prose(line: str) -> bool:
    """Say whether a line is words: few of its letters are those of stitches."""
    letters = [sign for sign in line if sign.isalpha()]
    stitches = sum(sign in "KkPpー" for sign in letters)
    is_signs = all(len(word) == 1 for word in line.split())
    has_word = re.search(r"[A-Za-z\u00c0-\u024f]{2}", line) is not None
    is_repeated = len(set(letters)) <= 2 or {*re.split(r"\W+", line.lower())} <= {*_WORDS, ""}
    return has_word and not is_signs and not is_repeated and 2 * stitches < len(letters)
