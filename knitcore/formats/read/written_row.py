"""One written row as it is worked: its stitches, repeats, and shaping at the edges."""

from dataclasses import dataclass

import numpy as np

from knitcore.base.arrays import Indices, Mask
from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import check_chart_size
from knitcore.chart.stitch_kinds import STITCHES

MADE = ("m1", "m1p")
"""Stitches that are made of nothing, and shape a piece at its edges."""


@dataclass(frozen=True)
class Line:
    """A line of instructions, its number, and the row that it is about."""

    number: int
    text: str
    row: str = ""

    def wrong(self, problem: str, remedy: str) -> InputError:
        """An error that names the line."""
        row = f", {self.row}" if self.row else ""
        return InputError("rows", f"line {self.number}{row}: {problem}", remedy)


@dataclass(frozen=True)
class WrittenStitch:
    """A stitch of a row as the knitter works it.

    Attributes
    ----------
    place : in :data:`knitcore.chart.stitch_kinds.STITCHES`.
    yarn : its number.
    form : "" for a knit or a purl that is just worked, ``m1`` or ``m1p`` where it is made, else
        the words of the stitch, or ``slip`` for one that does not say where its yarn is.
    """

    place: int
    yarn: int = 0
    form: str = ""

    @property
    def purl(self) -> bool:
        """True where it is purled, for pieces of knits and purls."""
        return STITCHES[self.place].sites[0].purl

    @property
    def uses(self) -> int:
        """Stitches of the row below that it takes."""
        return 0 if self.form in MADE else STITCHES[self.place].takes

    @property
    def leaves(self) -> int:
        """Stitches that it leaves on the needle."""
        return STITCHES[self.place].width


@dataclass(frozen=True)
class Work:
    """A row as it is worked: stitches gained where it begins and ends, and all its stitches."""

    first: int
    last: int
    stitches: tuple[WrittenStitch, ...]


Stitches = tuple[WrittenStitch, ...]


def taken(stitches: Stitches) -> int:
    """Stitches of the row below that these take."""
    return sum(stitch.uses for stitch in stitches)


def left(stitches: Stitches) -> int:
    """Stitches that these leave on the needle."""
    return sum(stitch.leaves for stitch in stitches)


def keeps_count(stitches: Stitches) -> bool:
    """Say whether these leave as many stitches as they take, and none is made of nothing."""
    return taken(stitches) == left(stitches) and all(s.form not in MADE for s in stitches)


@dataclass(frozen=True)
class RowPart:
    """Stitches that are worked once or, with ``leave``, until so many of the row below are left."""

    unit: Stitches
    leave: int | None = None


@dataclass(frozen=True)
class RowWords:
    """A row in words, which may fit several numbers of stitches.

    Attributes
    ----------
    first, last : stitches cast on (or, negative, bound off) before and after.
    parts : what is worked, in order.
    count : the number of stitches that the row says it has in the end.
    """

    line: Line
    first: int
    last: int
    parts: tuple[RowPart, ...]
    count: int | None = None

    @property
    def is_fixed(self) -> bool:
        """True if it fits one number of stitches only."""
        return all(part.leave is None for part in self.parts)

    @property
    def gain(self) -> int:
        """Stitches that it adds to those on the needle."""
        return self.first + self.last + sum(left(p.unit) - taken(p.unit) for p in self.parts)

    def repeated(self) -> "RowWords":
        """The row as a repeat that fills the needle, unless it already has one."""
        unit = sum((part.unit for part in self.parts), ())
        if not self.is_fixed or not keeps_count(unit):
            return self
        return RowWords(self.line, self.first, self.last, (RowPart(unit, 0),), self.count)

    def fits(self, needles: Indices) -> Mask:
        """For each number of stitches on the needle, whether the row comes out."""
        room = needles + self.first + self.last
        used = np.zeros_like(room)
        fits = room >= 1
        for part in self.parts:
            size = taken(part.unit)
            if part.leave is None:
                used = used + size
                continue
            free = room - used - part.leave
            fits = fits & (free >= size) & (free % max(size, 1) == 0)
            used = room - part.leave
        if self.count is not None:
            fits = fits & (needles + self.gain == self.count)
        return np.asarray(fits & (used == room))

    def work(self, needle: int) -> Work:
        """Work it with ``needle`` stitches on the needle.

        Raises
        ------
        InputError
            Naming the line and the problem.
        """
        check_chart_size(1, max(needle + max(self.first, 0) + max(self.last, 0), 1))
        room = needle + self.first + self.last
        if room < 1:
            raise self.line.wrong("it leaves no stitch.", "Bind off fewer.")
        stitches = self._stitches(room)
        if taken(stitches) != room:
            raise self.line.wrong(
                f"it works {taken(stitches)} stitches, but {room} are on the needle.",
                "Correct the row, or cast on, bind off, increase or decrease at its edges.",
            )
        first, last = _shaped(self.line, stitches, self.first, self.last)
        if self.count is not None and self.count != left(stitches):
            raise self.line.wrong(
                f"it says {self.count} sts, but {left(stitches)} are on the needle.",
                "Correct the count.",
            )
        return Work(first, last, stitches)

    def _stitches(self, room: int) -> Stitches:
        stitches: Stitches = ()
        for part in self.parts:
            if part.leave is None:
                stitches += part.unit
                continue
            free, size = room - taken(stitches) - part.leave, taken(part.unit)
            if free < size or free % size:
                fixed = taken(stitches) + part.leave - self.first - self.last
                raise self.line.wrong(
                    f"the {size} stitches that are repeated do not fit {max(free, 0)} "
                    "stitches exactly.",
                    f"Cast on a multiple of {size} plus {fixed} stitches.",
                )
            stitches += part.unit * (free // size)
        return stitches


def _shaped(line: Line, stitches: Stitches, first: int, last: int) -> tuple[int, int]:
    """Gains and losses with the increases and decreases at the edges of a row that has no lace."""
    if first == last == 0 and keeps_count(stitches):
        return 0, 0
    end = len(stitches) - 1
    for index, form in ((i, s.form) for i, s in enumerate(stitches) if s.form):
        if form in ("k3tog", "p3tog") and end == 0:
            first, last = first - 1, last - 1
        elif index == 0 and form in (("ssk", "p2tog", "ssp") if end else ("ssk", "p2tog")):
            first -= 1
        elif form in ("k2tog", "ssp", "p2tog") and index == end:
            last -= 1
        elif form in ("m1", "m1p") and index == 1 and end > 2:
            first += 1
        elif form in ("m1", "m1p") and index == end - 1 and end > 2:
            last += 1
        else:
            problem = f"{form} is stitch {index + 1} of {end + 1}"
            if all(s.form not in MADE for s in stitches):
                problem += f": the row takes {taken(stitches)} stitches and leaves {left(stitches)}"
            remedy = (
                "Give every decrease its yarn over, so that the row leaves as many stitches as it "
                "takes; or shape at the edges only: ssk first, k2tog last, m1 beside the edge "
                "stitch."
            )
            raise line.wrong(f"{problem}.", remedy)
    return first, last
