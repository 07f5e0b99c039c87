"""The passes of a program: what the carriage does, and how far each pulls the loops it holds."""

import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple

from knitcore.base.errors import InputError
from knitcore.machine.transfers import Needle

NEIGHBOURS = 3
"""Links on each side that may lend yarn to a tight one; friction holds those beyond."""
_NEEDLE = re.compile(r"([fb])s?(-?\d{1,6})")
_KNITS = {"knit", "tuck", "split", "miss", "drop"}


class Link(NamedTuple):
    """The yarn between two loops that needles hold.

    Attributes
    ----------
    needles : between the two hooks, along the machine.
    across : whether they are on opposite beds.
    laid : needles between them when the yarn was laid.
    """

    needles: float
    across: bool
    laid: float


class PulledLink(NamedTuple):
    """A link that is pulled, and its neighbours outwards on either side."""

    link: Link
    left: tuple[Link, ...]
    right: tuple[Link, ...]


def pulls_of(
    places: Sequence[Needle | None], laid: Sequence[float], rack: float
) -> frozenset[PulledLink]:
    """The pulls on loops of one yarn at a racking, in the yarn's order; None is not held.

    Links between neighbouring needles of one bed are at rest and are left out.
    """
    links: list[Link | None] = []
    for (a, b), span in zip(pairwise(places), laid, strict=True):
        if a is None or b is None:
            links.append(None)
        else:
            apart = abs(_position(a, rack) - _position(b, rack))
            links.append(Link(apart, a.bed != b.bed, span))
    return frozenset(
        PulledLink(link, *sorted((_outwards(links[:i][::-1]), _outwards(links[i + 1 :]))))
        for i, link in enumerate(links)
        if link is not None and (link.across or link.needles > max(link.laid, 1))
    )


def _position(needle: Needle, rack: float) -> float:
    return needle.number + (rack if needle.bed == "b" else 0.0)


def _outwards(links: Sequence[Link | None]) -> tuple[Link, ...]:
    held: list[Link] = []
    for link in links[:NEIGHBOURS]:
        if link is None:
            break
        held.append(link)
    return tuple(held)


def stitch_number_of(word: str) -> float | None:
    """A stitch number as a program writes it, with letters from 10 on; None if it is none."""
    try:
        return float(int(word, 36)) if word.isalpha() else float(word)
    except ValueError:
        return None


@dataclass
class ProgramPass:
    """One pass of the carriage.

    Attributes
    ----------
    kind : ``knit``, ``transfer`` or ``drop``.
    line : the first line of the program.
    rack : in needles.
    rightwards : its direction; None for a transfer, which goes either way.
    bed : that gives the loops, of a transfer.
    carriers : that it moves.
    loops : made, moved or dropped.
    low, high : the needles it works on, from left to right.
    changes : how often it goes over from tucks to knits on a bed, or back.
    number : stitch number of the loops that it moves, of a transfer; None if none is set.
    pulls : on the loops that needles hold.
    """

    kind: str
    line: int
    rack: float
    rightwards: bool | None
    bed: str = ""
    carriers: tuple[str, ...] = ()
    loops: int = 0
    low: float = 0.0
    high: float = 0.0
    changes: int = 0
    number: float | None = None
    pulls: frozenset[PulledLink] = frozenset()


@dataclass
class ProgramReading:
    """The passes of a program and what its carriers lay.

    Attributes
    ----------
    passes : in their order.
    rackings : how often the bed is racked.
    loops : made by each carrier.
    float_needles : needles that each carrier's yarn passes without a loop.
    """

    passes: list[ProgramPass] = field(default_factory=list)
    rackings: int = 0
    loops: Counter[str] = field(default_factory=Counter)
    float_needles: Counter[str] = field(default_factory=Counter)


def read_passes(program: str) -> ProgramReading:
    """Read the passes of a program in knitout.

    Raises
    ------
    InputError
        If a line names something that is no needle, or a racking that is no number.

    Examples
    --------
    >>> reading = read_passes("inhook 1\\nknit + f1 1\\nknit + f2 1\\nknit - f2 1")
    >>> [step.loops for step in reading.passes]
    [2, 1]
    """
    reader = _Reader()
    for number, line in enumerate(program.splitlines(), 1):
        words = line.split(";", 1)[0].split()
        if words:
            reader.read(number, words)
    reader.close()
    return reader.reading


class _Reader:
    """The loops on the needles while a program is read."""

    def __init__(self) -> None:
        self.reading = ProgramReading()
        self._rack = 0.0
        self._line = 0
        self._kinds: dict[str, str] = {}
        self._number: float | None = None
        self._knitted: float | None = None
        self._held: dict[Needle, list[int]] = {}
        self._place: list[Needle | None] = []
        self._strand: dict[tuple[str, ...], list[int]] = {}
        self._laid: list[float] = []
        """Needles from the loop before on its strand, loop by loop."""
        self._moved = False

    def read(self, number: int, words: list[str]) -> None:
        self._line = number
        operation, *given = words
        if operation == "rack":
            self._racked(given)
        elif operation == "xfer":
            self._transfer(*map(self._needle, given[:2]))
        elif operation == "x-stitch-number" and given:
            self._number = stitch_number_of(given[0])
        elif operation in _KNITS:
            self._knit(operation, given)
        elif operation in ("out", "outhook"):
            self._strand = {
                names: loops for names, loops in self._strand.items() if not {*names} & {*given}
            }

    def close(self) -> None:
        """End a pass of transfers: its loops pull now."""
        if self._moved:
            step = self.reading.passes[-1]
            step.pulls |= self._pulls()
            self._moved = False

    def _needle(self, word: str) -> Needle:
        match = _NEEDLE.fullmatch(word)
        if match is None:
            raise InputError(
                "knitout",
                f"line {self._line}: {word[:40]!r} is not a needle such as f12 or b-3.",
                "Correct that line.",
            )
        return Needle(match[1], int(match[2]))

    def _racked(self, given: list[str]) -> None:
        self.close()
        try:
            rack = float(given[0])
        except (IndexError, ValueError):
            raise InputError(
                "knitout",
                f"line {self._line}: a racking is no number.",
                "Write rack and a number of needles.",
            ) from None
        self.reading.rackings += rack != self._rack
        self._rack = rack

    def _transfer(self, here: Needle, there: Needle) -> None:
        last = self.reading.passes[-1] if self.reading.passes else None
        if last is None or (last.kind, last.bed, last.rack) != ("transfer", here.bed, self._rack):
            self.close()
            last = ProgramPass("transfer", self._line, self._rack, None, here.bed)
            last.number = self._knitted
            last.pulls = self._pulls()
            self.reading.passes.append(last)
        self._moved = True
        self._count(last, here)
        for loop in self._held.get(here, ()):
            self._place[loop] = there
        self._held.setdefault(there, []).extend(self._held.pop(here, []))

    def _knit(self, operation: str, given: list[str]) -> None:
        self.close()
        if operation == "drop":
            given = ["+", *given]
        way, word, *carriers = given
        here, rightwards = self._needle(word), way == "+"
        if operation == "split":
            there, *carriers = carriers
            self._held.setdefault(self._needle(there), []).extend(self._held.pop(here, []))
        kind = "knit" if carriers else "drop"
        last = self.reading.passes[-1] if self.reading.passes else None
        at = _position(here, self._rack)
        same = last is not None and (
            (last.kind, last.carriers, last.rack) == (kind, tuple(carriers), self._rack)
            and (kind == "drop" or last.rightwards == rightwards)
        )
        onward = last is not None and (
            operation == "miss"
            or not last.loops
            or (at > last.high if rightwards else at < last.low)
        )
        if last is None or not (same and (onward or kind == "drop")):
            last = ProgramPass(kind, self._line, self._rack, rightwards)
            last.carriers = tuple(carriers)
            self.reading.passes.append(last)
            self._kinds = {}
        if operation == "miss":
            return
        self._count(last, here)
        if operation != "tuck":
            for loop in self._held.pop(here, []):
                self._place[loop] = None
        if carriers:
            if self._kinds.get(here.bed, operation) != operation:
                last.changes += 1
                self._kinds = {}  # the carriage comes anew, over both beds
            self._kinds[here.bed] = operation
            self._knitted = self._number
            self._make(here, tuple(carriers))

    def _make(self, here: Needle, carriers: tuple[str, ...]) -> None:
        strand = self._strand.setdefault(carriers, [])
        before = self._place[strand[-1]] if strand else None
        apart = abs(_position(before, self._rack) - _position(here, self._rack)) if before else 1.0
        for carrier in carriers:
            self.reading.loops[carrier] += 1
            self.reading.float_needles[carrier] += max(round(apart) - 1, 0)
        strand.append(len(self._place))
        self._laid.append(apart)
        self._held.setdefault(here, []).append(len(self._place))
        self._place.append(here)

    def _count(self, step: ProgramPass, needle: Needle) -> None:
        at = _position(needle, self._rack)
        step.low = min(step.low, at) if step.loops else at
        step.high = max(step.high, at) if step.loops else at
        step.loops += 1

    def _pulls(self) -> frozenset[PulledLink]:
        return frozenset(
            pull
            for loops in self._held_strands()
            for pull in pulls_of(
                [self._place[loop] for loop in loops],
                [self._laid[loop] for loop in loops[1:]],
                self._rack,
            )
        )

    def _held_strands(self) -> Iterator[list[int]]:
        """The loops of each strand from the first that a needle still holds."""
        for loops in self._strand.values():
            first = 0
            while first < len(loops) and self._place[loops[first]] is None:
                first += 1
            del loops[: min(first, len(loops) - 1)]  # the last stays: yarn leads on from it
            yield loops
