"""The words of one written row: stitches, brackets, repeats, yarns, and shaping at the edges."""

import re
from collections.abc import Iterator
from dataclasses import dataclass

from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import MAX_STITCHES_PER_SIDE, check_chart_size
from knitcore.garment.piece import yarn_name

MAX_CHARACTERS = 20_000
"""Most characters in a row's words; the widest row without any repeat takes a quarter of it."""
_COUNT = re.compile(r"\((\d{1,4}) sts?\)$", re.IGNORECASE)
_STITCHES = re.compile(r"([kp])(\d{1,4})", re.IGNORECASE)
_BRACKET = re.compile(r"\(([^()]*)\) (?:(twice)|(\d{1,4}) times)", re.IGNORECASE)
_STAR = re.compile(
    r"(.*?)\*([^*;]*); rep from \* (?:to (end)|to last (?:(\d{1,4}) sts|st))(?:, (.*))?",
    re.IGNORECASE,
)
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


@dataclass(frozen=True)
class Line:
    """A line of instructions and its number."""

    number: int
    text: str

    def wrong(self, problem: str, remedy: str) -> InputError:
        """An error that names the line."""
        return InputError("rows", f"line {self.number}: {problem}", remedy)


def lines_of(text: str) -> Iterator[Line]:
    """Lines with single blanks between their words, without empty ones and comments."""
    for number, line in enumerate(text.lstrip("\ufeff").splitlines(), start=1):
        words = " ".join(line.split())
        if words and not words.startswith("#"):
            yield Line(number, words)


@dataclass(frozen=True)
class WrittenStitch:
    """A stitch of a row: purled or knitted, how it is made ("" if just worked), of which yarn."""

    purl: bool
    form: str = ""
    yarn: int = 0

    @property
    def uses(self) -> int:
        """Stitches of the row below that it takes."""
        return _USES.get(self.form, 2)


@dataclass(frozen=True)
class Work:
    """Words of a row, independent of its place."""

    first: int
    last: int
    stitches: tuple[WrittenStitch, ...]


Stitches = tuple[WrittenStitch, ...]


def taken(stitches: Stitches) -> int:
    """Stitches of the row below that these take."""
    return sum(stitch.uses for stitch in stitches)


def read_row(line: Line, body: str, needle: int, yarns: int) -> Work:
    """The words of a row, with ``needle`` stitches on the needle and ``yarns`` yarns.

    Raises
    ------
    InputError
        Naming the line and the problem.
    """
    if len(body) > MAX_CHARACTERS:
        raise line.wrong(f"it has {len(body)} characters.", "Split it, or write it with repeats.")
    count = _COUNT.search(body)
    words = (body[: count.start()] if count else body).strip().rstrip(".").strip()
    first, last, words = _edges(line, words, needle)
    worked = needle + first + last
    if worked < 1:
        raise line.wrong("it leaves no stitch.", "Bind off fewer.")
    stitches = _yarn_words(line, words, worked, yarns)
    if taken(stitches) != worked:
        raise line.wrong(
            f"it works {taken(stitches)} stitches, but {worked} are on the needle.",
            "Correct the row, or cast on, bind off, increase or decrease at its edges.",
        )
    first, last = _shaped(line, stitches, first, last)
    if count is not None and int(count[1]) != len(stitches):
        raise line.wrong(
            f"it says {count[1]} sts, but {len(stitches)} are on the needle.", "Correct the count."
        )
    return Work(first, last, stitches)


def _edges(line: Line, words: str, needle: int) -> tuple[int, int, str]:
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
    check_chart_size(1, max(needle + max(first, 0) + max(last, 0), 1))
    return first, last, words


def _shaped(line: Line, stitches: Stitches, first: int, last: int) -> tuple[int, int]:
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
            remedy = "Shape at the edges only: ssk first, k2tog last, m1 beside the edge stitch."
            raise line.wrong(f"{form} is stitch {index + 1} of {end + 1}.", remedy)
    return first, last


def _yarn_words(line: Line, words: str, worked: int, yarns: int) -> Stitches:
    if yarns < 2:
        return _words(line, words, worked)
    names = list(_WITH.finditer(words))
    if not names or names[0].start() != 0:
        raise line.wrong("it does not say with which yarn it begins.", 'Write "with A …".')
    stitches: Stitches = ()
    known = [yarn_name(index) for index in range(yarns)]
    for place, name in enumerate(names):
        if name[1].upper() not in known:
            raise line.wrong(f"there is no yarn {name[1]}.", f"Use {', '.join(known)}.")
        stop = names[place + 1].start() if place + 1 < len(names) else len(words)
        part, room = words[name.end() : stop], worked - taken(stitches)
        read = _words(line, part, room) if len(names) == 1 else _items(line, part, room)
        yarn = known.index(name[1].upper())
        stitches += tuple(WrittenStitch(s.purl, s.form, yarn) for s in read)
    return stitches


def _words(line: Line, words: str, worked: int) -> Stitches:
    star = _STAR.fullmatch(words)
    if star is None:
        return _items(line, words, worked)
    before, unit, end, last, after = star.groups()
    head = _items(line, before.rstrip(", "), worked) if before.strip(", ") else ()
    body = _items(line, unit, worked)
    tail = _items(line, after, worked) if after else ()
    stated = 0 if end else int(last or 1)
    if taken(tail) != stated:
        problem = f"{taken(tail)} stitches follow the repeat, but it says {stated}."
        raise line.wrong(problem, 'Make "to last N sts" agree with what follows.')
    room = worked - taken(head) - taken(tail)
    if any(stitch.form for stitch in body) or room < len(body) or room % len(body):
        raise line.wrong(
            f"the {len(body)} stitches after * do not fit {room} stitches exactly.",
            f"Cast on a multiple of {len(body)} plus {taken(head) + taken(tail)} stitches.",
        )
    return head + body * (room // len(body)) + tail


def _items(line: Line, words: str, worked: int) -> Stitches:
    """Stitches and brackets, separated by commas."""
    stitches: Stitches = ()
    rest = words.strip()
    while rest:
        bracket, run, shaped = (p.match(rest) for p in (_BRACKET, _STITCHES, _SHAPED))
        if rest.lower() in ("knit", "purl"):
            added = (WrittenStitch(rest.lower() == "purl"),) * (worked - taken(stitches))
            used = len(rest)
        elif bracket is not None:
            inside = _items(line, bracket[1], worked)
            times = 2 if bracket[2] else int(bracket[3])
            # More than a row can hold is refused below without being written out.
            added = inside * min(times, MAX_STITCHES_PER_SIDE + 1)
            used = bracket.end()
        elif shaped is not None:
            form = shaped[1].lower()
            purl = form in ("ssp", "p2tog", "p3tog", "m1p")
            added, used = (WrittenStitch(purl, form),), shaped.end()
        elif run is not None:
            added, used = (WrittenStitch(run[1].lower() == "p"),) * int(run[2]), run.end()
        else:
            problem = f"{rest[:30]!r} cannot be read."
            raise line.wrong(problem, 'Write k3, p2, (k1, p1) 3 times, or "*…; rep from * to end".')
        stitches += added
        if len(stitches) > MAX_STITCHES_PER_SIDE:
            raise line.wrong("it has too many stitches.", f"Use {worked}.")
        rest = _after_comma(line, rest[used:])
    if not stitches:
        raise line.wrong("a part of it is empty.", "Write stitches, such as k3.")
    return stitches


def _after_comma(line: Line, rest: str) -> str:
    if rest and not re.match(r", ?\S", rest):
        raise line.wrong(
            f"{rest[:30]!r} follows a stitch without a comma.", "Separate stitches by commas."
        )
    return rest.lstrip(", ")
