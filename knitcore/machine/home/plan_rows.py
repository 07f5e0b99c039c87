"""Parts of a plan for a home machine: rows, the work by hand between them, and its text."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from enum import StrEnum
from itertools import pairwise

from knitcore.garment.piece import check_row
from knitcore.machine.home.needle_places import needle_name, needle_words

GUESSED = "Minutes are our guess for a practised knitter."
MAX_PERIOD = 8
"""Most blocks of rows that are repeated together."""


class Act(StrEnum):
    """Work by hand between two rows."""

    TURN = "turn"
    SHAPE = "shape"
    TRANSFER = "transfer"
    YARNS = "yarns"
    REFORM = "re-form"


_TIMED = {
    Act.REFORM: "re-forming",
    Act.TURN: "turning",
    Act.TRANSFER: "transfers",
    Act.SHAPE: "shaping",
}
"""Acts whose minutes a plan states."""


@dataclass(frozen=True)
class Task:
    """One act on some needles.

    Attributes
    ----------
    needles : names such as L3, the third needle left of the middle.
    words : the instruction.
    seconds : a guess.
    rows : of re-formed stitches, the first and the last, counted from 1.
    """

    act: Act
    needles: tuple[str, ...]
    words: str
    seconds: float
    rows: tuple[int, int] | None = None


@dataclass(frozen=True)
class HandRow:
    """One row on the machine.

    Attributes
    ----------
    number : from 1.
    leftwards : whether the carriage goes from the knitter's right to the left.
    first : place of the first needle in work.
    other : for each needle in work from the left, whether its stitch is one to be re-formed, or on
        the ribber.
    yarns : needles and number of the yarn of each stretch from the left.
    before, after : work by hand before and after the carriage passes.
    """

    number: int
    leftwards: bool
    first: int
    other: tuple[bool, ...]
    yarns: tuple[tuple[int, int], ...]
    before: tuple[Task, ...]
    after: tuple[Task, ...]


@dataclass(frozen=True)
class Block:
    """Rows that are knitted without work by hand in between."""

    rows: tuple[HandRow, ...]

    @property
    def heading(self) -> str:
        """The rows, and where the carriage starts."""
        first, last = self.rows[0].number, self.rows[-1].number
        start = "right" if self.rows[0].leftwards else "left"
        rows = f"Row {first}" if first == last else f"Rows {first}–{last}"
        return f"{rows}, carriage at the {start}"

    @property
    def key(self) -> tuple[object, ...]:
        """Equal for blocks of which one repeats the other."""
        row = self.rows[0]
        return len(self.rows), row.leftwards, row.first, row.other, self.lines

    @property
    def lines(self) -> tuple[str, ...]:
        """All that is done, in order."""
        count = len(self.rows)
        knit = f"Knit {count} rows." if count > 1 else "Knit 1 row."
        before, after = self.rows[0].before, self.rows[-1].after
        return (*(task.words for task in before), knit, *(task.words for task in after))


@dataclass(frozen=True)
class Again:
    """Rows that are knitted as those before them.

    Attributes
    ----------
    rows, like : the first and the last row, here and of those before.
    """

    rows: tuple[int, int]
    like: tuple[int, int]

    @property
    def heading(self) -> str:
        """The rows, and those that they repeat."""
        return f"Rows {self.rows[0]}–{self.rows[1]}: repeat rows {self.like[0]}–{self.like[1]}"

    @property
    def lines(self) -> tuple[str, ...]:
        """No lines: the heading says it."""
        return ()


@dataclass(frozen=True)
class HandPlan:
    """A piece as it is knitted on a home machine.

    Attributes
    ----------
    machine : the profile's name.
    ribber : whether there is a second bed.
    width : needles of the widest place, counted from the knitter's left.
    opening, closing : lines before the first row and after the last.
    pass_s : seconds of a row.
    """

    machine: str
    ribber: bool
    width: int
    opening: tuple[str, ...]
    rows: tuple[HandRow, ...]
    closing: tuple[str, ...]
    pass_s: float
    notes: tuple[str, ...] = ()

    @property
    def tasks(self) -> tuple[Task, ...]:
        """All work by hand, in order."""
        return tuple(task for row in self.rows for task in (*row.before, *row.after))

    @property
    def minutes(self) -> float:
        """A guess of the time at the machine, without casting on and binding off."""
        return (self.pass_s * len(self.rows) + sum(task.seconds for task in self.tasks)) / 60

    @property
    def time(self) -> str:
        """The time in words, by what it is spent on."""
        spent = [
            f"{name} {minutes_in_words(self._minutes_of(act))}"
            for act, name in _TIMED.items()
            if any(task.act is act for task in self.tasks)
        ]
        details = f" ({', '.join(spent)})" if spent else ""
        return f"Time: about {minutes_in_words(self.minutes)}{details}. {GUESSED}"

    def _minutes_of(self, act: Act) -> float:
        return sum(task.seconds for task in self.tasks if task.act is act) / 60

    @property
    def blocks(self) -> tuple[Block, ...]:
        """Rows without work by hand between them, together."""
        blocks: list[list[HandRow]] = [[self.rows[0]]]
        for below, row in pairwise(self.rows):
            if row.before or below.after or below.first != row.first or below.other != row.other:
                blocks.append([row])
            else:
                blocks[-1].append(row)
        return tuple(Block(tuple(rows)) for rows in blocks)

    @property
    def sections(self) -> tuple[Block | Again, ...]:
        """The blocks, those that come again in the same order as one repetition."""
        blocks, sections, at = self.blocks, list[Block | Again](), 0
        while at < len(blocks):
            period, times = _repetition(blocks, at)
            if times:
                again = blocks[at : at + period * times]
                rows = again[0].rows[0].number, again[-1].rows[-1].number
                before = blocks[at - period : at]
                sections.append(Again(rows, (before[0].rows[0].number, rows[0] - 1)))
            else:
                sections.append(blocks[at])
            at += max(period * times, 1)
        return tuple(sections)

    @property
    def needles(self) -> tuple[str, ...]:
        """Names of all needles from the left."""
        return tuple(needle_name(place, self.width) for place in range(self.width))

    def resumed(self, number: int) -> HandPlan:
        """The plan from a row on, after a break or a jam: it begins with what hangs on the needles.

        Raises
        ------
        InputError
            If there is no such row.
        """
        check_row(number, len(self.rows))
        if number == 1:
            return self
        below, start = self.rows[number - 2], self.rows[number - 1]
        places = range(below.first, below.first + len(below.other))
        hang = f"Hang the {len(places)} stitches of row {number - 1}"
        where = [needle_words(places, self.width)]
        if self.ribber:
            beds = [
                (name, [p for p, other in zip(places, below.other, strict=True) if other == ribber])
                for name, ribber in (("main bed", False), ("ribber", True))
            ]
            where = [f"{name} {needle_words(some, self.width)}" for name, some in beds if some]
        turns = any(task.act is Act.TURN for task in start.before)
        side = "right" if start.leftwards != turns else "left"
        opening = f"{hang} on {', '.join(where)}. The carriage is at the {side}."
        return replace(self, opening=(opening,), rows=self.rows[number - 1 :])

    @property
    def text(self) -> str:
        """The plan to be read at the machine."""
        lines = [f"For {self.machine}", "", *self.opening, ""]
        for section in self.sections:
            lines += [section.heading, *(f"  {line}" for line in section.lines)]
        return "\n".join([*lines, "", *self.closing, "", *self.notes, self.time, ""])


def minutes_in_words(minutes: float) -> str:
    """Whole minutes, one at least, and hours of them from two on.

    Examples
    --------
    >>> minutes_in_words(90), minutes_in_words(652)
    ('90 minutes', '10 h 52 min')
    """
    count = max(round(minutes), 1)
    if count >= 120:
        return f"{count // 60} h {count % 60} min"
    return "1 minute" if count == 1 else f"{count} minutes"


def _repetition(blocks: Sequence[Block], at: int) -> tuple[int, int]:
    """How many blocks before this one come again, and how often; (0, 0) if none do."""
    best = (0, 0)
    for period in range(1, min(at, MAX_PERIOD) + 1):
        keys = [block.key for block in blocks[at - period : at]]
        times = 0
        while keys == [b.key for b in blocks[at + period * times : at + period * (times + 1)]]:
            times += 1
        if period * times > best[0] * best[1] and len(keys) * times > 1:
            best = (period, times)
    return best
