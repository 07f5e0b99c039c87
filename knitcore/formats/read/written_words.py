"""The words of one written row: stitches, brackets, repeats, yarns, and shaping at the edges.

Read are ``k3``, ``k 3``, ``knit 3 sts``, ``knit to last 2 sts``, ``[k1, p1] 4 times`` (also
``x 4``, ``twice``, ``to end``; in any bracket, nested), ``*k2, p2; rep from * to last 2 sts, k2``
and ``*k2, p2* 3 times``; every stitch of the registry in the words of
:mod:`knitcore.chart.stitch_words`; at the edges decreases, ``m1``, casting on and binding off.
"""

import re
from dataclasses import dataclass, field, replace

from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import MAX_STITCHES_PER_SIDE
from knitcore.chart.stitch_kinds import BY_CODE, STITCHES
from knitcore.chart.stitch_words import SLIP, stitch_in
from knitcore.formats.read.written_row import (
    MADE,
    Line,
    RowPart,
    RowWords,
    Stitches,
    WrittenStitch,
    keeps_count,
    taken,
)
from knitcore.garment.piece import yarn_name

MAX_CHARACTERS = 20_000
"""Most characters in a row's words; the widest row without any repeat takes a quarter of it."""
MAX_DEPTH = 20
"""Most brackets inside each other."""
NUMBER_WORDS = {
    word: number
    for number, word in enumerate(
        ("one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten"), start=1
    )
}
_COUNT = re.compile(
    r"(?:[.(\[<–—=-]\s*(\d{1,4}) (?:sts?|stitch(?:es)?)\s*[)\]>]?|[(\[<](\d{1,4})[)\]>])[ .]*$",
    re.IGNORECASE,
)
_TOKEN = re.compile(r"\*+|[\[\](){},;.:]|\d+(?![\w/])|[^\s*\[\](){},;.:]+")
_STITCH = re.compile(r"([kp])(\d{0,5})|(knit|purl)s?", re.IGNORECASE)
_PLAINER = (
    (re.compile(r"[.,;]\s*turn(?: (?:the )?work)?[ .]*$", re.IGNORECASE), ""),
    (re.compile(r",?\s*\b(?:[psr]m|(?:place|slip|remove) markers?)\b", re.IGNORECASE), ""),
    (re.compile(r"\b([kp])(?:nit|url)(?=\d)", re.IGNORECASE), r"\1"),
    (re.compile(r"\b(\d{1,4})([kp])\b", re.IGNORECASE), r"\2\1"),
    (re.compile(r"([kp]\d{1,4})(?=[kp]\d)", re.IGNORECASE), r"\1 "),
)
"""Words that make no stitch (``turn``, ``pm``); other spellings (``knit2``, ``2k``, ``k1p1``)."""
_TIMES = re.compile(r"(?:[x×](\d{1,5})|(\d{1,5})[x×])", re.IGNORECASE)
_SIZES = re.compile(r"\(\s*\d+(?:[\s,;/]+\d+)*\s*\)")
_BRACKETS = {"[": "]", "(": ")", "{": "}"}
_GAIN = re.compile(
    r"(cast on|co|bind off|bo|cast off) (\d{1,4})(?: sts?| stitch(?:es)?)?, ", re.IGNORECASE
)
_GAIN_AT_END = re.compile(
    r"with a separate strand cast on (\d{1,4}) sts? at the end, ", re.IGNORECASE
)
_LOSS_AT_END = re.compile(
    r", bind off the last (\d{1,4}) sts? with a separate strand$", re.IGNORECASE
)
_PLAIN_WORDS = set(
    re.findall("[a-z]+", "k p knit purl rep repeat from to end last st sts and then times twice x")
)
_NAMES = (
    (r"[kp]\d?tog.*|.*(psso|p2sso).*|.*\bdec.*", "a decrease that charts do not know"),
    (r"m1.*|m|[kp]fb.*|kf&b|inc.*|.*\binc", "an increase"),
    (r"\d+/\d+.*|[ct]\d+.*|[lr][ctp]+\d*.*|.*cable.*", "a crossing that charts do not know"),
    (r"mb|.*bobble.*", "a bobble"),
    (r"bo\b.*|co\b.*|bind.*|cast.*", "casting on or binding off within a row"),
    (r"w&t|wrap.*|turn.*", "a short row"),
    (r".*below|br.*", "a stitch knitted into the row below"),
    (r"dip.*|drop.*", "a dropped or dipped stitch"),
)
"""Names of stitches that charts do not hold, and their kinds."""


def read_row(line: Line, body: str, yarns: int = 1, *, again: bool = True) -> RowWords:
    """The words of a row.

    Parameters
    ----------
    body : the words, without what stands before the colon.
    yarns : number of yarns; of several each stretch names its own.
    again : whether ``repeat from * 3 times`` works the stitches four times, or three.

    Raises
    ------
    InputError
        Naming the line, the stitch and the problem.
    """
    if len(body) > MAX_CHARACTERS:
        raise line.wrong(f"it has {len(body)} characters.", "Split it, or write it with repeats.")
    count = _COUNT.search(body)
    words = (body[: count.start()] if count else body).strip().rstrip(".").strip()
    for spelling, plainer in _PLAINER:
        words = spelling.sub(plainer, words)
    if _SIZES.search(words):
        raise line.wrong("it is written for several sizes.", "Keep the numbers of one size.")
    first, last, words = _edges(words)
    parts = _Reader(line, words, yarns, again=again).parts()
    stated = int(count[1] or count[2]) if count else None
    return RowWords(line, first, last, parts, stated)


def is_ambiguous(body: str) -> bool:
    """Say whether a row repeats "from * 3 times", which may mean once and then three times."""
    return _OFTEN.search(body) is not None


_OFTEN = re.compile(
    r"rep\w* (?:from )?\*+(?: to \*+|-\*+)? (?:(?:to end )?(?:\d+|\w+) times?|twice|[x×]\s?\d+)"
    r"(?! more| in all| in total| altogether| total)",
    re.IGNORECASE,
)


def _edges(words: str) -> tuple[int, int, str]:
    """Stitches cast on and bound off at both ends, and the rest of the words."""
    first = last = 0
    gain = _GAIN.match(words)
    if gain is not None:
        first = int(gain[2]) * (1 if gain[1].lower() in ("cast on", "co") else -1)
        words = words[gain.end() :]
    if (at_end := _GAIN_AT_END.match(words)) is not None:
        last, words = int(at_end[1]), words[at_end.end() :]
    if (loss := _LOSS_AT_END.search(words)) is not None:
        last, words = last - int(loss[1]), words[: loss.start()]
    return first, last, words


_KEEP_COUNT = "Repeat stitches that leave as many as they take, such as *yo, k2tog*."
MOST_LETTERS = 80
"""Letters among which the words of a stitch are sought."""
_THE_REST = -1
"""Stitches left by a repeat that is said to end with what follows."""


@dataclass
class _Frame:
    """The words inside an open bracket or after a star."""

    mark: str = ""
    parts: list[RowPart] = field(default_factory=list)
    size: int = 0


class _Reader:
    """Reads the words from left to right; open brackets and stars are on a stack."""

    def __init__(self, line: Line, words: str, yarns: int, *, again: bool) -> None:
        self._line, self._words, self._yarns, self._again = line, words, yarns, again
        self._tokens = [(m[0].lower(), m.start()) for m in _TOKEN.finditer(words)]
        self._is_plain = set(re.findall("[a-z]+", words.lower())) <= _PLAIN_WORDS
        self._next = 0
        self._yarn = None if yarns > 1 else 0
        self._stack = [_Frame()]

    def parts(self) -> tuple[RowPart, ...]:
        while self._next < len(self._tokens):
            self._step()
        if len(self._stack) > 1:
            mark = self._stack[-1].mark
            problem = "a repeat has no end." if mark == "*" else "a bracket is not closed."
            raise self._line.wrong(
                problem, 'Write "[k1, p1] twice" or "*k1, p1; rep from * to end".'
            )
        parts = self._stack[0].parts
        if not parts:
            raise self._line.wrong("a part of it is empty.", "Write stitches, such as k3.")
        if len(self._tokens) == 1 and self._tokens[0][0] in ("k", "p"):
            return (RowPart(parts[0].unit, 0),)
        elastic = [index for index, part in enumerate(parts) if part.leave is not None]
        for index in elastic:
            part = parts[index]
            after = sum(taken(other.unit) for other in parts[index + 1 :])
            if part.leave == _THE_REST and index == elastic[-1]:
                parts[index] = replace(part, leave=after)
            elif part.leave == _THE_REST or (len(elastic) == 1 and after != part.leave):
                problem = (
                    f"{after} stitches follow the repeat, but it says {max(part.leave or 0, 0)}."
                )
                raise self._line.wrong(problem, 'Make "to last N sts" agree with what follows.')
        return tuple(parts)

    def _step(self) -> None:
        word = self._take()
        if word in (",", ";", ".", ":", "and", "then") or self._other_stitch():
            return
        if word in _BRACKETS:
            self._open(word)
        elif word in _BRACKETS.values():
            self._close(word)
        elif word.startswith("*"):
            if self._stack[-1].mark == "*":
                self._end_star(is_from=False)
            else:
                self._open("*")
        elif word in ("rep", "repeat"):
            self._repeat()
        elif word in ("end", "ending", "ends") and self._is_repeated():
            self._end_with()
        elif word == "with" and self._yarns > 1:
            self._change_yarn()
        elif _STITCH.fullmatch(word):
            self._stitch(word)
        elif word in MADE:
            self._add(RowPart((WrittenStitch(int(word == "m1p"), self._named_yarn(), word),)))
        else:
            raise self._unknown(self._next - 1)

    def _other_stitch(self) -> bool:
        """Read a stitch that is no plain knit or purl, if it stands at the token before."""
        if self._is_plain:
            return False
        start = self._tokens[self._next - 1][1]
        read = stitch_in(self._words[start : start + MOST_LETTERS].lower())
        if read is None:
            return False
        while self._next < len(self._tokens) and self._tokens[self._next][1] < start + read.length:
            self._next += 1
        place = BY_CODE["V" if read.code == SLIP else read.code]
        form = SLIP if read.code == SLIP else STITCHES[place].words
        unit: Stitches = (WrittenStitch(place, self._named_yarn(), form),)
        unit *= min(read.often, MAX_STITCHES_PER_SIDE + 1)
        self._skip("st", "sts", "stitch", "stitches")
        leave, times, more = self._tail()
        if leave is None:
            times = 1 if times is None else times + max(more, 0)
            self._add(RowPart(unit * min(times, MAX_STITCHES_PER_SIDE + 1)))
        elif not keeps_count(unit):
            raise self._line.wrong(f"{form} is repeated to the end.", _KEEP_COUNT)
        else:
            self._add(RowPart(unit, leave))
        return True

    def _end_with(self) -> None:
        """Leave what follows to the end, unless the repeat has said how much that is."""
        self._skip("with")
        repeated = self._stack[-1].parts[-1]
        if not repeated.leave:
            self._stack[-1].parts[-1] = replace(repeated, leave=_THE_REST)

    def _is_repeated(self) -> bool:
        """Say whether the last words repeat to the end."""
        parts = self._stack[-1].parts
        return len(self._stack) == 1 and bool(parts) and parts[-1].leave is not None

    def _take(self) -> str:
        self._next += 1
        return self._tokens[self._next - 1][0]

    def _peek(self, ahead: int = 0) -> str:
        place = self._next + ahead
        return self._tokens[place][0] if place < len(self._tokens) else ""

    def _skip(self, *words: str) -> bool:
        """Pass over a token if it is one of these."""
        if self._peek() in words and self._peek():
            self._next += 1
            return True
        return False

    def _add(self, part: RowPart) -> None:
        frame = self._stack[-1]
        if part.leave is not None and frame.mark:
            raise self._line.wrong(
                'a repeat "to end" stands inside another repeat.',
                "Write the inner one with a number.",
            )
        frame.parts.append(part)
        frame.size += len(part.unit)
        if frame.size > MAX_STITCHES_PER_SIDE:
            remedy = f"Use at most {MAX_STITCHES_PER_SIDE}."
            raise self._line.wrong("it has too many stitches.", remedy)

    def _open(self, mark: str) -> None:
        if len(self._stack) > MAX_DEPTH:
            raise self._line.wrong(
                "too many brackets stand inside each other.", "Write it plainly."
            )
        self._stack.append(_Frame(mark))

    def _close(self, token: str) -> None:
        frame = self._stack[-1]
        if _BRACKETS.get(frame.mark) != token:
            raise self._line.wrong(f"{token!r} closes nothing.", 'Write "[k1, p1] twice".')
        self._stack.pop()
        if self._peek() == "," and self._peek(1) in ("rep", "repeat"):
            self._next += 1
        self._skip("rep", "repeat", "work")
        leave, times, more = self._tail()
        if leave is None and times is None:
            problem = "it does not say how often the brackets are worked."
            raise self._line.wrong(problem, 'Write "[k1, p1] twice" or "[k1, p1] to end".')
        self._add_unit(frame, leave, None if times is None else times + max(more, 0))

    def _repeat(self) -> None:
        """Go on after "rep": to the end of a star, to a star, or back to the beginning."""
        if self._stack[-1].mark == "*":
            has_from = self._skip("from")
            if not self._skip("*", "**", "***") and has_from:
                raise self._line.wrong('"repeat" names no star.', 'Write "rep from * to end".')
            self._end_star(is_from=True)
        elif self._peek().startswith("*") or self._peek() in _BRACKETS:
            return
        else:
            self._repeat_all()

    def _repeat_all(self) -> None:
        """Repeat all words before, as in "k1, p1 to end"."""
        frame = self._stack.pop()
        if self._stack or not frame.parts or not all(p.leave is None for p in frame.parts):
            raise self._line.wrong('"repeat" names no star.', 'Write "*k1, p1; rep from * to end".')
        self._stack.append(_Frame())
        leave, times, more = self._tail()
        self._add_unit(frame, leave or 0, None if times is None else times + max(more, 0))

    def _end_star(self, *, is_from: bool) -> None:
        """Read on after "*k2, p2; rep from *", or "*k2, p2*" which may name the stars again."""
        frame = self._stack.pop()
        if not is_from and self._peek() in (",", ";") and self._peek(1) in ("rep", "repeat"):
            self._next += 1
        if not is_from and self._skip("rep", "repeat", "work"):
            self._skip("from", "between")
            is_from = self._peek().startswith("*")
        if is_from:
            self._skip("*", "**")
            if self._peek() in ("to", "and", "-", "–") and self._peek(1).startswith("*"):
                self._next += 2
            self._skip("s")
        leave, times, more = self._tail()
        if times is not None:
            times += max(more, 0) + int(self._again and is_from and more == 0)
        self._add_unit(frame, (leave or 0) if times is None else None, times)

    def _add_unit(self, frame: _Frame, leave: int | None, times: int | None) -> None:
        if any(part.leave is not None for part in frame.parts):
            raise self._line.wrong('a repeat "to end" is repeated.', "Write it with a number.")
        unit = sum((part.unit for part in frame.parts), ())
        if not unit:
            raise self._line.wrong("a part of it is empty.", "Write stitches, such as k3.")
        if times is None:
            if not keeps_count(unit):
                raise self._line.wrong("a repeat to the end increases or decreases.", _KEEP_COUNT)
            self._add(RowPart(unit, leave))
        elif times < 1:
            raise self._line.wrong("a part of it is worked 0 times.", "Leave it out.")
        else:
            # More than a row can hold is refused without being written out.
            self._add(RowPart(unit * min(times, MAX_STITCHES_PER_SIDE + 1)))

    def _tail(self) -> tuple[int | None, int | None, int]:
        """How far or how often a repeat goes: stitches left, times, and 1 for "more".

        A number of times that is said to be "in all" has -1 for "more".
        """
        token = self._peek()
        if token in ("across", "around", "along", "throughout", "even"):
            self._next += 1
            self._skip("the")
            self._skip("row", "round", "rnd")
            if self._peek() not in ("to", "until", "till", "til"):
                return 0, None, 0
            token = self._peek()
        if token in ("to", "until", "till", "til"):
            self._next += 1
            return self._to_end(), None, 0
        times = {"once": 1, "twice": 2, "thrice": 3, **NUMBER_WORDS}.get(token)
        match = _TIMES.fullmatch(token)
        if times is None and token.isdigit():
            times = int(token)
        elif times is None and match is not None:
            times = int(match[1] or match[2])
        elif token in ("x", "×") and self._peek(1).isdigit():
            times = int(self._peek(1))
            self._next += 1
        if times is None:
            return None, None, 0
        self._next += 1
        more = int(self._skip("more", "additional", "further"))
        self._skip("times", "time", "x", "×")
        more = max(more, int(self._skip("more")))
        if self._skip("in"):
            self._skip("all", "total")
            more = -1
        elif self._skip("altogether", "total"):
            more = -1
        return None, times, more

    def _to_end(self) -> int:
        """Stitches that "to end", "to last 2 sts" or "until 2 sts remain" leave."""
        self._skip("the")
        if self._skip("end"):
            if self._skip("of"):
                self._skip("the")
                self._skip("row", "round", "rnd", "needle")
            return 0
        self._skip("last")
        token = self._peek()
        if token in ("st", "stitch"):
            number = 1
        elif token.isdigit() or token in NUMBER_WORDS:
            self._next += 1
            number = NUMBER_WORDS.get(token) or int(token)
        else:
            raise self._line.wrong(
                f'"to {token}" cannot be read.', 'Write "to end" or "to last 2 sts".'
            )
        self._skip("st", "sts", "stitch", "stitches")
        self._skip("remain", "remains", "rem", "left", "remaining")
        if self._skip("before", "from"):
            self._skip("the")
            self._skip("end")
        return number

    def _change_yarn(self) -> None:
        known = [yarn_name(index) for index in range(self._yarns)]
        name = self._take().upper() if self._peek() else ""
        if name not in known:
            raise self._line.wrong(f"there is no yarn {name}.", f"Use {', '.join(known)}.")
        self._yarn = known.index(name)

    def _named_yarn(self) -> int:
        if self._yarn is None:
            raise self._line.wrong(
                "it does not say with which yarn it begins.", 'Write "with A …".'
            )
        return self._yarn

    def _stitch(self, token: str) -> None:
        purl, number = token.startswith("p"), token[1:]
        stitch = (WrittenStitch(int(purl), self._named_yarn()),)
        is_word = not number.isdigit() and len(token) > 1
        start = self._next - 1
        count = int(number) if number.isdigit() else None
        if count is None and (self._peek().isdigit() or self._peek() in NUMBER_WORDS):
            word = self._take()
            count = NUMBER_WORDS.get(word) or int(word)
        if count is not None:
            self._skip("st", "sts", "stitch", "stitches")
            if self._peek() in ("to", "until", "till", "til", "across", "around") and count:
                self._add(RowPart(stitch * min(count, MAX_STITCHES_PER_SIDE + 1)))
                self._repeat_all()
                return
        elif self._peek() in ("all", "every", "each"):
            self._next += 1
            self._skip("st", "sts", "stitch", "stitches")
            self._skip("across", "around")
            self._add(RowPart(stitch, 0))
            return
        elif self._peek() in ("to", "until", "till", "til", "across", "around", "even"):
            self._add(RowPart(stitch, self._tail()[0]))
            return
        if not self._goes_on():
            raise self._unknown(start)
        if count == 0:
            raise self._line.wrong(f"{token!r} is no stitch.", "Leave it out.")
        if count is None and is_word:
            self._add(RowPart(stitch, 0))
        else:
            self._add(RowPart(stitch * min(count or 1, MAX_STITCHES_PER_SIDE + 1)))

    def _goes_on(self) -> bool:
        """Say whether the next token belongs to something else than the stitch before it."""
        token = self._peek()
        return (
            not token
            or not token[0].isalnum()
            or token in ("and", "then", "rep", "repeat", "with", *MADE)
            or _STITCH.fullmatch(token) is not None
            or stitch_in(self._words[self._tokens[self._next][1] :][:MOST_LETTERS].lower())
            is not None
        )

    def _unknown(self, place: int) -> InputError:
        """Refuse what begins at a token, by row, stitch and name."""
        start = self._tokens[place][1]
        name = re.split(r"[,;*\[\](){}]|\.(?:\s|$)", self._words[start:], maxsplit=1)[0].strip()
        name = name[:40] or self._tokens[place][0]
        kind = next((kind for names, kind in _NAMES if re.fullmatch(names, name.lower())), "")
        is_counted = all(part.leave is None for part in self._stack[0].parts)
        stitch = sum(frame.size for frame in self._stack) + 1
        where = f"stitch {stitch}, " if is_counted else ""
        if re.fullmatch(r"[kp]{2,}", name, re.IGNORECASE):
            remedy = 'Separate stitches by commas; a line of a chart stands without "Row".'
        else:
            remedy = (
                "Write k3, p2, [k1, p1] 3 times, *yo, k2tog; rep from * to end, 2/2 RC, sl1 wyib "
                "or tuck: charts hold stitches in rows that leave as many as they take."
            )
        what = f", {kind}," if kind else ""
        return self._line.wrong(f"{where}{name!r}{what} is no stitch of a chart.", remedy)
