"""Lines of a written pattern, told apart: casting on, yarns, rows, repeats of rows, remarks.

A row begins with its numbers, in any of the ways in which patterns give them: ``Row 1 (RS):``,
``R1:``, ``Rnd 3:``, ``Rows 2, 4 and 6-8 (WS):``, ``Row 2 and all even rows:``, ``All WS rows:``,
``Next row:``, ``1. k2, p2``, ``1st row k, p.``, ``from ws 2nd to 10th row k.``
"""

import re
from collections.abc import Iterator
from dataclasses import dataclass, field

from knitcore.base.errors import InputError
from knitcore.chart.row_sides import Side
from knitcore.chart.stitch_chart import MAX_STITCHES_PER_SIDE
from knitcore.formats.read.written_row import Line
from knitcore.formats.read.written_words import MAX_CHARACTERS, NUMBER_WORDS

_I = re.IGNORECASE
_ROW = r"(?P<name>rows?|rounds?|rnds?|rds?)"
_ST = r"(?:st|nd|rd|th)"
_AND = r"\s?(?:, ?and\s|,|\band\s|[&+/]|[-–—]|\bto\s|\bthrough\s)\s?"
_SIDE = r"(?:\s?[(\[{]?\s?(?P<side>RS|WS|right[- ]side|wrong[- ]side)\b\s?[)\]}]?)?"
_SIDE_2 = _SIDE.replace("side>", "side2>")
_EVERY = (
    r"(?:all|every|each)\s(?:(?:other|alternate|alt|following|foll|subsequent|remaining)\s)*"
    r"(?P<every>even|odd|RS|WS|right[- ]side|wrong[- ]side)?(?:[- ]numbered)?\s?"
)
_OTHER = (
    r"yo\b|yfwd\b|yrn\b|yon\b|sl\s?\d|sk2p|skp|ss+[kp]\b|s2[kp]|cdd\b|tuck\b|(?:c|t|cr)\d+[bfrl]\b"
    r"|\d/\d\s?[rl]p?[ct]\b|[rl]t\b|[kp]\d?tbl\b"
)
"""How a stitch begins that is neither a knit nor a purl."""
_STITCH = rf"(?=[*\[(]|[kp]\s?\d|[kp]\b|knit\b|purl\b|{_OTHER})"
_ROW_BEGINS = (
    # Row 1 (RS): …, Rows 2 and 4-6: …, Row 2 and all even rows: …, R1[WS] - …
    re.compile(
        rf"(?:{_ROW}\.?\s?|r)(?P<numbers>\d{{1,4}}(?:{_AND}\d{{1,4}})*)"
        rf"(?:,? (?:and|&) {_EVERY}(?:rows?|rounds?|rnds?))?{_SIDE}"
        rf"(?:\s?[:.)=|]|\s[-–—]\s|\s{_STITCH}){_SIDE_2}",
        _I,
    ),
    # 1st and 3rd row …, from ws 2nd to 10th row …, 1st row (RS): …
    re.compile(
        rf"(?:from )?(?:(?P<only>rs|ws) )?(?P<numbers>\d{{1,4}}{_ST}(?:{_AND}\d{{1,4}}{_ST}?)*) "
        rf"{_ROW}{_SIDE}(?P<ordinal>\s?:?){_SIDE_2}",
        _I,
    ),
    # Set-up row (WS): …
    re.compile(rf"(?P<setup>set-?\s?up|foundation|preparation) {_ROW}{_SIDE}\s?:{_SIDE_2}", _I),
    # All WS rows: …, every even row …, RS rows: …
    re.compile(rf"{_EVERY}{_ROW}{_SIDE}(?P<ordinal>\s?:?)", _I),
    re.compile(
        rf"(?P<every>even|odd|RS|WS|right[- ]side|wrong[- ]side)(?:[- ]numbered)? {_ROW}\s?:", _I
    ),
    # Next row (WS): …, RS: …
    re.compile(rf"(?:next|following) {_ROW}{_SIDE}\s?:", _I),
    re.compile(r"(?P<side>RS|WS)\s?:", _I),
)
_BARE = re.compile(rf"(?P<numbers>\d{{1,4}}){_SIDE}\s?[.:)]\s", _I)
_BODY = re.compile(
    rf"(?=.*(?:\d|,|knit|purl))[*\[(]?\s?(?:[kp]\s?\d|[kp]\s?,|knit\b|purl\b|{_OTHER})", _I
)
_CAST_ON = re.compile(
    r"\b(?:cast[- ]?on|co)(?![a-z])\s?:?\s?(\d{1,4}|[a-z]+)\b"
    r"(\s?(?:[(\[{]\s?\d+(?! ?st)|[/,:–-]\s?\d))?",
    _I,
)
_MULTIPLE = re.compile(
    r"multiple of (\d{1,3})(?: sts?| stitches)?(?:,? (?:\+|plus|and) (\d{1,3}))?", _I
)
_JOIN = re.compile(r"\bjoin\b|\bin the round\b", _I)
_FLAT = re.compile(r"\bworked flat\b", _I)
_FIRST_SIDE = re.compile(r"row 1 is a (right|wrong)[- ]side row", _I)
_KNOWN = re.compile(
    r"worked flat.*|row 1 is a (?:right|wrong)-side row|(?:and )?join.*|do not twist.*"
    r"|being careful.*",
    _I,
)
_YARN = re.compile(r"yarn ([A-Z]{1,2}): (.*) \((#[0-9a-f]{6})\)", _I)
_ROWS = r"(?:r|(?:rows?|rnds?|rounds?)\s?)"
_AGAIN = re.compile(
    r"(?:repeat|rep|work as|work|as|same as)(?: for)? "
    rf"{_ROWS}(\d{{1,4}})(?:(?:\s?[-–—&,]\s?| and | to | through ){_ROWS}?(\d{{1,4}}))?\b(.*)",
    _I,
)
_LAST = re.compile(
    r"(?:repeat|rep|work) (?:these|those|(?:the )?(?:last|previous))( \w+)? (?:rows?|rnds?|rounds?)"
    r"\b(.*)",
    _I,
)
_ORDINALS = {
    "first": "1st", "second": "2nd", "third": "3rd", "fourth": "4th", "fifth": "5th",
    "sixth": "6th", "seventh": "7th", "eighth": "8th", "ninth": "9th", "tenth": "10th",
}  # fmt: skip
_NTH_ROW = re.compile(rf"\b(\d{{1,4}}){_ST} (rows?|rnds?|rounds?)\b", _I)
_HASH_NUMBER = re.compile(r"\b((?:row|rnd|round)s?\s*)#(?=\d)", _I)
_BULLET = re.compile(r"^(?:[-•·▪◦>]|#+|\*(?=\s(?:row|r\d|rnd|round)))\s+|\*\*|__", _I)
_IN_WORDS = re.compile(
    rf"^(?:({'|'.join(_ORDINALS)}) (?=(?:row|rnd|round)\b)"
    rf"|((?:row|rnd|round)s?) ({'|'.join(NUMBER_WORDS)})\b)",
    _I,
)
_SIDE_BEFORE = re.compile(
    r"^[(\[]?(RS|WS)[)\]]?[ :]+(?=(?:(?:row|rnd|round)s? ?\d|r\d)[^:.]*[:.])([^:.]*)", _I
)
_TIMES = re.compile(r"(\d{1,4}|[a-z]+)(?: more)?(?: times?)?(?: more)?\.?", _I)
_END = re.compile(
    r"(?:bind(?: |-)?off|cast off|bo)\b"
    r"(?: (?:all|the|remaining|sts|stitches|in|pattern|patt|loosely|knitwise|purlwise|ribbing"
    r"|rib|on|(?P<count>\d{1,4})|sts?|WS|RS))*[ .]*(?:\.\s.*)?",
    _I,
)
_GOES_ON = re.compile(r"(?:repeat|rep|continue|cont|these)\b.*", _I)
_TO_STAR = re.compile(r"rep(?:eat)?\.? (?:from )?\*", _I)
_WORKS = re.compile(r"(?:work\b|knit\b|purl\b|[kp]\s?\d|[kp]\s?,|\*|\[)", _I)
_AFTER = re.compile(r"\s*(?:[x×\d]|twice|thrice|once|to\b|until|till?\b|across|rep|more|$)", _I)
_KEPT = re.compile(
    r"\(\s?(?:RS|WS|right[- ]side|wrong[- ]side|\d+ (?:sts?|stitch(?:es)?)|[\d\s,;/]+|#[0-9a-f]{6}"
    r"|(?:[kp]\s?\d*|knit|purl)(?:\s?[,;]\s?(?:[kp]\s?\d*|knit|purl))*)\s?\)",
    _I,
)
_STITCHES = re.compile(rf"\(\s?[*\[(]?\s?(?:[kp]\s?\d|[kp]\b|knit|purl|m1|yo|sl|{_OTHER})", _I)
_REMARK = re.compile(r"(?:^|\s)(?://|#(?![0-9a-f]{6}\b)).*", _I)
_SIDE_FIRST = re.compile(r"(\((?:RS|WS)\)):? ((?:and|&) (?:all|every|each) [^:(]*)", _I)
MAX_LINES = 20_000
"""Most lines of a pattern; the longest has 1000 rows."""
MAX_LOOKED_AT = 200
"""Lines among which one tells that a text is written rows."""


@dataclass(frozen=True)
class RowLine:
    """A row, or several that are worked alike.

    Attributes
    ----------
    numbers : those given; none stands for the next row, if ``every`` is None.
    every : which further rows: ``even``, ``odd``, ``rs``, ``ws``, ``rs ws`` or ``other`` (every
        second one, like the number).
    only : of the numbers, only the rows of this side.
    is_round : None if the line does not say.
    is_ordinal : written as by compilers of KnitSpeak, where a row is repeated across the needle.
    """

    line: Line
    body: str
    numbers: tuple[int, ...]
    every: str | None
    only: Side | None
    side: Side | None
    is_round: bool | None
    is_ordinal: bool


@dataclass(frozen=True)
class RepeatLine:
    """Earlier rows, worked again ``times`` times; negative ones count back from those before it."""

    line: Line
    first: int
    last: int
    times: int


@dataclass
class PatternLines:
    """The contents of the lines.

    Attributes
    ----------
    cast_on : stitches.
    multiple : "multiple of n plus m", if the number is left open.
    bound_off : the line of the end and the number of stitches bound off, if it says one.
    remarks : what was passed over.
    """

    cast_on: int | None = None
    multiple: tuple[int, int] | None = None
    is_round: bool | None = None
    first_side: Side | None = None
    yarns: list[tuple[Line, str, str, str]] = field(default_factory=list)
    rows: list[RowLine | RepeatLine] = field(default_factory=list)
    bound_off: tuple[Line, int | None] | None = None
    remarks: list[str] = field(default_factory=list)
    open_repeats: list[str] = field(default_factory=list)


def looks_written(text: str) -> bool:
    """Say whether a text is meant as written rows rather than as lines of K and P."""
    for number, raw in enumerate(text.splitlines()):
        line = _plainly(raw)
        if number > MAX_LOOKED_AT:
            return False
        if _row_begins(line) or re.match(r"(?:cast[- ]?on|co)(?![a-z])\s?:?\s?\w", line, _I):
            return True
        if (cast_on := _CAST_ON.search(line)) and _number(cast_on[1]):
            return True
    return False


def read_lines(text: str) -> PatternLines:
    """Tell the lines apart.

    Raises
    ------
    InputError
        Naming the first line that cannot be a part of a pattern.
    """
    return _Reader().read(text)


def row_of(numbers: tuple[int, ...]) -> str:
    """A short name of rows, for errors."""
    return f"row {numbers[0]}" if len(numbers) == 1 else f"rows {numbers[0]} …"


def again(body: str) -> tuple[int, int, str] | None:
    """The first and the last row that a row repeats, and what follows them."""
    match = _AGAIN.fullmatch(_NTH_ROW.sub(r"\2 \1", body.rstrip(". ")))
    return match and (int(match[1]), int(match[2] or match[1]), match[3].strip(" ,.("))


def _plainly(raw: str) -> str:
    """A line without remarks, bullets and marks of bold type; its row by number."""
    line = " ".join(_REMARK.sub("", _HASH_NUMBER.sub(r"\1", raw)).split())
    line = " ".join(_BULLET.sub("", line).split())
    match = _IN_WORDS.match(line)
    if match is not None:
        ordinal, row, number = match.groups()
        begin = f"{row} {NUMBER_WORDS[number.lower()]}" if row else f"{_ORDINALS[ordinal.lower()]} "
        line = begin + line[match.end() :]
    return _SIDE_BEFORE.sub(r"\2 (\1)", line)


def _number(word: str) -> int:
    word = word.strip().lower()
    return int(word) if word.isdigit() else NUMBER_WORDS.get(word, 0)


def _row_begins(text: str, at: int = 0) -> re.Match[str] | None:
    """Find the beginning of a row here."""
    for pattern in _ROW_BEGINS:
        match = pattern.match(text, at)
        if match is not None:
            return match
    bare = _BARE.match(text, at)
    return bare if bare is not None and _BODY.match(text, bare.end()) else None


class _Reader:
    def __init__(self) -> None:
        self._pattern = PatternLines()
        self._open: list[str] | None = None
        """Words of the row that goes on in the next line."""
        self._began: tuple[Line, re.Match[str]] | None = None
        self._depth = 0

    def read(self, text: str) -> PatternLines:
        lines = text.lstrip("\ufeff").splitlines()
        if len(lines) > MAX_LINES:
            problem = f"the text has {len(lines)} lines."
            raise InputError("rows", problem, f"Use at most {MAX_LINES}.")
        for number, raw in enumerate(lines, start=1):
            words = " ".join(raw.split())
            if _YARN.fullmatch(words) is None:
                words = self._without_remarks(_plainly(words))
                words = _SIDE_FIRST.sub(r"\2 \1", words)
            if len(words) > MAX_CHARACTERS:
                problem = f"it has {len(words)} characters."
                raise Line(number, words).wrong(problem, "Write it with repeats.")
            if not words.strip(" ."):
                continue
            if self._pattern.bound_off is not None:
                self._pattern.remarks.append(words)
                continue
            for part in _parts(words):
                self._line(Line(number, part))
        self._close()
        if self._depth:
            raise InputError(
                "rows", "a bracket is not closed.", "Close every bracket that is opened."
            )
        return self._pattern

    def _without_remarks(self, words: str) -> str:
        """The words without brackets that hold no stitches, sides or counts."""
        if "(" not in words and not self._depth:
            return words
        kept, start = [], 0
        remark: list[str] = []
        for index, sign in enumerate(words):
            if sign == "(":
                if self._depth == 0:
                    kept.append(words[start:index])
                    start = index
                self._depth += 1
            elif sign == ")" and self._depth:
                self._depth -= 1
                if self._depth == 0:
                    kept.append(self._judged(words[start : index + 1], words[index + 1 :], remark))
                    start = index + 1
        if self._depth and not _STITCHES.match(words[start:]):
            remark.append(words[start:])
        else:
            self._depth = 0
            kept.append(words[start:])
        self._pattern.remarks += remark
        return " ".join("".join(kept).split()).replace(" .", ".")

    @staticmethod
    def _judged(bracket: str, after: str, remark: list[str]) -> str:
        """The bracket if it is part of the instructions; else nothing, and it is remarked."""
        inside = bracket[1:-1].strip() if bracket.startswith("(") else bracket
        if _KEPT.fullmatch(bracket) or bracket.startswith("(#"):
            return bracket
        if _STITCHES.match(bracket) and after.strip(" .,") and _AFTER.match(after):
            return bracket
        if re.match(r"rep(?:eat)?\b|(?:and|&) (?:all|every|each)\b", inside, _I):
            return f" {inside}"
        if _MULTIPLE.search(bracket):
            return f" {inside}"
        remark.append(bracket)
        return ""

    def _line(self, line: Line) -> None:
        begins = _row_begins(line.text)
        pattern = self._pattern
        if begins is not None:
            self._close()
            self._began, self._open = (line, begins), [line.text[begins.end() :].strip()]
            return
        end = _END.fullmatch(line.text)
        is_open = self._open is not None and not self._open[-1].endswith(".")
        is_other = (
            end is not None
            or again(line.text)
            or (_GOES_ON.fullmatch(line.text) and not _TO_STAR.match(line.text))
        )
        if self._open is not None and is_open and not is_other:
            self._open.append(line.text)
            return
        self._close()
        repeat = again(line.text)
        latest = _LAST.fullmatch(line.text.rstrip(". "))
        if repeat is not None and pattern.rows:
            self._repeat(line, *repeat)
        elif latest is not None and pattern.rows and (back := _number(latest[1] or "one")):
            self._repeat(line, -back, -1, latest[2])
        elif end is not None and pattern.rows:
            pattern.bound_off = line, int(end["count"]) if end["count"] else None
        elif pattern.rows and _GOES_ON.fullmatch(line.text):
            pattern.open_repeats.append(line.text)
        elif not pattern.rows and end is None:
            self._opening(line)
        else:
            if end is not None:
                pattern.bound_off = line, None
                return
            remedy = 'Write "Row 1 (RS): …" or "Rows 3-8: …", and remarks after //.'
            raise line.wrong(f"{line.text[:60]!r} is not a row.", remedy)

    def _repeat(self, line: Line, first: int, last: int, often: str) -> None:
        times = times_in(often)
        if times:
            self._pattern.rows.append(RepeatLine(line, first, last, times))
        else:
            self._pattern.open_repeats.append(line.text)

    def _opening(self, line: Line) -> None:
        """A line before the first row: casting on, a yarn, or a remark."""
        pattern = self._pattern
        yarn = _YARN.fullmatch(line.text)
        if yarn is not None:
            pattern.yarns.append((line, yarn[1].upper(), yarn[2], yarn[3].lower()))
            return
        multiple, cast_on = _MULTIPLE.search(line.text), _CAST_ON.search(line.text)
        is_join = _JOIN.search(line.text) is not None
        if multiple is not None:
            pattern.multiple = int(multiple[1]), int(multiple[2] or 0)
        if cast_on is not None and _number(cast_on[1]):
            self._cast_on(line, cast_on)
        elif multiple is None and not is_join and not _FLAT.search(line.text):
            self._remark(line, line.text)
            return
        if is_join or _FLAT.search(line.text):
            pattern.is_round = is_join
        first_side = _FIRST_SIDE.search(line.text)
        if first_side is not None and not pattern.is_round:
            pattern.first_side = _side(first_side[1])
        rest = re.split(r"[.;]\s?", line.text[cast_on.end() :] if cast_on else "")
        for part in rest[1:]:
            if part.strip() and not _KNOWN.fullmatch(part.strip()):
                self._remark(line, part.strip())

    def _cast_on(self, line: Line, cast_on: re.Match[str]) -> None:
        count = _number(cast_on[1])
        if cast_on[2]:
            raise line.wrong("it is written for several sizes.", "Keep the numbers of one size.")
        if self._pattern.cast_on not in (None, count):
            problem = f"{count} stitches are cast on, {self._pattern.cast_on} before."
            raise line.wrong(problem, "Read one piece at a time.")
        self._pattern.cast_on = count

    def _remark(self, line: Line, words: str) -> None:
        """Words that are passed over, unless they say what to do."""
        if _WORKS.match(words):
            remedy = 'Write "Row 1 (RS): …" or "Rows 3-8: …".'
            raise line.wrong(f"{words[:60]!r} is not a row.", remedy)
        self._pattern.remarks.append(words)

    def _close(self) -> None:
        """Take the row that is complete."""
        if self._began is None or self._open is None:
            return
        (line, match), body = self._began, " ".join(self._open).strip()
        self._began = self._open = None
        groups = match.groupdict()
        name = (groups.get("name") or "").lower()
        numbers = (0,) if groups.get("setup") else _numbers(line, groups.get("numbers") or "")
        every = groups.get("every")
        if groups.get("numbers") and re.search(r"\b(?:all|every|each)\b", match[0], _I):
            every = every or "other"
        elif re.match(r"all|every|each", match[0], _I):
            every = every or "rs ws"
        side = groups.get("side") or groups.get("side2")
        labelled = Line(line.number, line.text, row_of(numbers) if numbers else "")
        if numbers == (0,) and _CAST_ON.search(body):
            self._opening(Line(line.number, body))
            return
        end = _END.fullmatch(body)
        if end is not None:
            self._pattern.bound_off = labelled, int(end["count"]) if end["count"] else None
            return
        self._pattern.rows.append(
            RowLine(
                labelled,
                body,
                numbers,
                _every(every),
                _side(groups["only"]) if groups.get("only") else None,
                _side(side) if side else None,
                not name.startswith("row") if name else None,
                groups.get("ordinal", ":").strip() == "",
            )
        )


def times_in(often: str) -> int:
    """How often something is repeated, if these words say so; else 0."""
    often = often.strip(" ,.(")
    match = _TIMES.fullmatch(often)
    times = {"twice": 2, "once": 1}.get(often.lower().split(" ")[0] if often else "", 0)
    return min(times or (_number(match[1]) if match else 0), MAX_STITCHES_PER_SIDE)


def _every(name: str | None) -> str | None:
    if name is None:
        return None
    return _side(name).lower() if name[0].lower() in "rw" and name != "rs ws" else name.lower()


def _side(name: str) -> Side:
    return Side.RS if name.lower().startswith("r") else Side.WS


def _numbers(line: Line, text: str) -> tuple[int, ...]:
    """The numbers of ``2, 4 and 6-8``."""
    numbers: list[int] = []
    for match in re.finditer(
        rf"(\d{{1,4}}){_ST}?(?:\s?(?:[-–—]|\bto\b|\bthrough\b)\s?(\d{{1,4}}))?", text
    ):
        first, last = int(match[1]), int(match[2] or match[1])
        if not first <= last <= MAX_STITCHES_PER_SIDE:
            remedy = f"Number them from 1 to {MAX_STITCHES_PER_SIDE}."
            raise line.wrong(f"rows {match[0]} cannot be made.", remedy)
        numbers += range(first, last + 1)
    return tuple(numbers)


def _parts(words: str) -> Iterator[str]:
    """The sentences of a line that begin rows of their own; usually one."""
    start = 0
    for stop in re.finditer(r"\.\s", words):
        rest = words[stop.end() :]
        if _row_begins(rest) or _END.fullmatch(rest) or again(rest):
            yield words[start : stop.end()].strip()
            start = stop.end()
    yield words[start:].strip()
