"""The language of knitout, and the loops that a two-bed machine makes of a program.

Reads programs as other tools write them: a byte order mark, any line ends, headers and ``x-``
operations of any name, carriers of any name and number, needles below 0, sliders, and racking by
fractions. Lines that do not concern loops are listed in notes. A program is read line by line in a
time in proportion to its length, and lines are counted from 1.

Specification: https://textiles-lab.github.io/knitout/knitout.html
"""

from __future__ import annotations

import math
import re
from collections import Counter
from dataclasses import dataclass, field
from typing import Final, TypeVar

from knitcore.base.errors import InputError

MAGIC: Final = ";!knitout-"
_HEADERS = {"machine", "gauge", "carriers", "position", "width"}
_MACHINES = {"swg091n2", "swg061n2", "swgn2", "kniterate", "generic"}
_NEEDLE = re.compile(r"([fb]s?)(-?\d{1,6})")
_COLOUR = re.compile(r"#[0-9a-fA-F]{6}")
_PROGRAM = re.compile(r"^[ \t]*(?:;!knitout|(?:knit|tuck)[ \t]+[+-][ \t]+[fb]s?-?\d)", re.MULTILINE)


@dataclass(eq=False, slots=True, repr=False)
class Loop:
    """A loop that a needle made.

    Attributes
    ----------
    kind : ``knit``, ``tuck`` or ``split``.
    bed, needle : the place that made it; ``f`` is the front bed, ``b`` the back.
    place : its position across the machine: the needle, plus what the back bed is racked.
    rightwards : direction of the carriage.
    carriers : the names of its yarns.
    strand : number of the piece of yarn: a carrier begins a new one when it is brought in.
    line : line of the program.
    parents : loops that it was pulled through; none for a cast-on loop or a tuck.
    child : the first loop that was pulled through it.
    onto : true for a tuck laid onto a needle that held a loop.
    dropped : true if it was dropped.
    before, after : its neighbours on the same strand.
    """

    number: int
    kind: str
    bed: str
    needle: int
    place: float
    rightwards: bool
    carriers: tuple[str, ...]
    strand: tuple[int, ...]
    line: int
    parents: tuple[Loop, ...]
    onto: bool = False
    child: Loop | None = None
    dropped: bool = False
    before: Loop | None = None
    after: Loop | None = None

    @property
    def name(self) -> str:
        """Bed and needle, as a program writes them."""
        return f"{self.bed}{self.needle}"


@dataclass(frozen=True)
class Knitting:
    """The loops of a program in the order in which they are made.

    Attributes
    ----------
    colours : colours of carriers that the program names with ``x-vis-color``.
    notes : lines without a bearing on the loops.
    """

    loops: tuple[Loop, ...]
    colours: dict[str, str]
    notes: tuple[str, ...]


Held = dict[tuple[str, int], tuple[Loop, ...]]
"""The loops on each needle; of those on one needle, those on the side of its bed first."""
CrossedLoops = dict[frozenset[int], list[int]]
"""For two loops by their numbers, which passed in front while they changed places."""


@dataclass(frozen=True)
class LoopState:
    """Loops that the needles hold before a pass of the carriage.

    Attributes
    ----------
    before : number of the first loop of the pass.
    held : loops on the needles.
    crossed : loops that racking carried past each other since the pass before.
    """

    before: int
    held: Held
    crossed: CrossedLoops


def looks_like_program(text: str) -> bool:
    """Say whether a text is a program, whatever its file is called."""
    return _PROGRAM.search(text) is not None


def knitting_of(program: str) -> Knitting:
    """Knit a program.

    Raises
    ------
    InputError
        If a line is not knitout, or asks for what no machine can do; it names the line.
    """
    machine = _run(_Machine(), program)
    notes = machine.notes()
    if not program.removeprefix("\ufeff").startswith(MAGIC):
        notes = ["The first line does not say ;!knitout-2; read as version 2.", *notes]
    return Knitting(tuple(machine.loops), machine.colours, tuple(notes))


def states_of(program: str) -> tuple[Knitting, tuple[LoopState, ...]]:
    """Knit a program, and tell what the needles hold before each pass.

    Raises
    ------
    InputError
        As :func:`knitting_of`.
    """
    machine = _run(_StateMachine(), program)
    return Knitting(tuple(machine.loops), machine.colours, ()), tuple(machine.states)


def _run(machine: MachineOf, program: str) -> MachineOf:
    lines = re.split(r"\r\n|\r|\n", program.removeprefix("\ufeff"))
    for number, line in enumerate(lines, 1):
        machine.read(number, line.strip())
    return machine


@dataclass
class _Machine:
    """The state of the beds and carriers."""

    loops: list[Loop] = field(default_factory=list)
    colours: dict[str, str] = field(default_factory=dict)
    _held: dict[tuple[str, int], list[Loop]] = field(default_factory=dict)
    _strands: dict[str, int] = field(default_factory=dict)
    _last: dict[tuple[int, ...], Loop] = field(default_factory=dict)
    _brought: int = 0
    _rack: float = 0.0
    _line: int = 0
    _first: dict[str, int] = field(default_factory=dict)
    _unused: Counter[str] = field(default_factory=Counter)
    _headers: dict[str, int] = field(default_factory=dict)
    _unknown_machine: str = ""

    def read(self, number: int, line: str) -> None:
        """Carry out one line."""
        self._line = number
        if line.startswith(";;"):
            self._header(line[2:])
            return
        words = line.split(";", 1)[0].split()
        if not words:
            return
        operation, *given = words
        if operation.startswith("x-"):
            self._extension(operation, given)
            return
        carry_out = _OPERATIONS.get(operation)
        if carry_out is None:
            raise self._problem(
                f"{operation[:40]!r} is not an operation of knitout.",
                "Correct it; operations of a machine's own begin with x-.",
            )
        getattr(self, carry_out)(given)

    def notes(self) -> list[str]:
        """Tell which headers and operations have no bearing on the loops."""
        notes = []
        if self._unknown_machine:
            notes.append(
                f"The machine {self._unknown_machine} is not a known one; the chart does not "
                "depend on it."
            )
        if self._headers:
            names = ", ".join(f"{name} (line {at})" for name, at in list(self._headers.items())[:8])
            more = f" and {len(self._headers) - 8} more" if len(self._headers) > 8 else ""
            notes.append(f"Headers without a bearing on the chart: {names}{more}.")
        if self._unused:
            names = ", ".join(
                f"{name} ({times} {'line' if times == 1 else 'lines'} from line "
                f"{self._first[name]})"
                for name, times in self._unused.most_common(8)
            )
            notes.append(f"Operations that set a machine and make no stitch: {names}.")
        return notes

    def _header(self, text: str) -> None:
        name, colon, value = text.partition(":")
        name, value = name.strip(), value.strip()
        if not colon:
            return  # a comment
        if name.lower() == "machine" and value.lower() not in _MACHINES:
            self._unknown_machine = value[:40]
        if name.lower() not in _HEADERS and not name.lower().startswith("yarn-"):
            self._headers.setdefault(name[:40], self._line)

    def _extension(self, operation: str, given: list[str]) -> None:
        if operation == "x-vis-color" and len(given) > 1 and _COLOUR.fullmatch(given[0]):
            self.colours.update(dict.fromkeys(given[1:], given[0].lower()))
        self._skip(operation[:40])

    def _skip(self, operation: str) -> None:
        self._first.setdefault(operation, self._line)
        self._unused[operation] += 1

    def _problem(self, problem: str, remedy: str = "Correct that line.") -> InputError:
        return InputError("knitout", f"line {self._line}: {problem}", remedy)

    def _needle(self, word: str) -> tuple[str, int]:
        match = _NEEDLE.fullmatch(word)
        if match is None:
            raise self._problem(f"{word[:40]!r} is not a needle such as f12 or b-3.")
        return match[1], int(match[2])

    def _words(self, given: list[str], least: int, form: str) -> list[str]:
        if len(given) < least:
            raise self._problem(f"an operand is missing: {form}.")
        return given

    def _directed(self, given: list[str], needles: int, form: str) -> tuple[bool, list[str]]:
        way, *rest = self._words(given, 1 + needles, form)
        if way not in ("+", "-"):
            raise self._problem(f"{way[:40]!r} is not a direction, + or -.")
        return way == "+", rest

    # Carriers ------------------------------------------------------------------------------

    def bring_in(self, given: list[str]) -> None:
        for carrier in self._words(given, 1, "in CARRIER"):
            if carrier in self._strands:
                raise self._problem(f"carrier {carrier} is in already.", "Take it out first.")
            self._brought += 1
            self._strands[carrier] = self._brought

    def take_out(self, given: list[str]) -> None:
        for carrier in self._words(given, 1, "out CARRIER"):
            self._strand(carrier)
            del self._strands[carrier]

    def release(self, given: list[str]) -> None:
        for carrier in given:
            self._strand(carrier)

    def _strand(self, carrier: str) -> int:
        try:
            return self._strands[carrier]
        except KeyError:
            raise self._problem(
                f"carrier {carrier[:40]} is not in.",
                f"Bring it in before, with in {carrier[:40]} or inhook {carrier[:40]}.",
            ) from None

    # Loops ---------------------------------------------------------------------------------

    def knit(self, given: list[str]) -> None:
        rightwards, (word, *carriers) = self._directed(given, 1, "knit + NEEDLE CARRIER")
        needle = self._needle(word)
        if not carriers:
            self._drop(needle)
            return
        loops = self._held.pop(needle, [])
        loop = self._make("knit", needle, rightwards, carriers, tuple(loops))
        self._held[needle] = [loop]

    def tuck(self, given: list[str]) -> None:
        rightwards, (word, *carriers) = self._directed(given, 1, "tuck + NEEDLE CARRIER")
        if not carriers:
            return
        needle = self._needle(word)
        loop = self._make("tuck", needle, rightwards, carriers, ())
        below = self._held.setdefault(needle, [])
        loop.onto = bool(below)
        below.append(loop)

    def split(self, given: list[str]) -> None:
        form = "split + NEEDLE NEEDLE CARRIER"
        rightwards, (word, other, *carriers) = self._directed(given, 2, form)
        here, there = self._needle(word), self._needle(other)
        self._check_facing(here, there)
        loops = self._held.pop(here, [])
        if loops:
            self._held.setdefault(there, []).extend(loops)
        if carriers:
            loop = self._make("split", here, rightwards, carriers, tuple(loops))
            self._held[here] = [loop]

    def transfer(self, given: list[str]) -> None:
        here, there = map(self._needle, self._words(given, 2, "xfer NEEDLE NEEDLE")[:2])
        self._check_facing(here, there)
        loops = self._held.pop(here, [])
        if loops:
            self._held.setdefault(there, []).extend(loops)

    def drop(self, given: list[str]) -> None:
        self._drop(self._needle(self._words(given, 1, "drop NEEDLE")[0]))

    def _drop(self, needle: tuple[str, int]) -> None:
        for loop in self._held.pop(needle, []):
            loop.dropped = True

    def _make(
        self,
        kind: str,
        needle: tuple[str, int],
        rightwards: bool,
        carriers: list[str],
        parents: tuple[Loop, ...],
    ) -> Loop:
        bed, number = needle
        strand = tuple(self._strand(carrier) for carrier in carriers)
        loop = Loop(
            number=len(self.loops),
            kind=kind,
            bed=bed[0],
            needle=number,
            place=number + self._rack if bed[0] == "b" else float(number),
            rightwards=rightwards,
            carriers=tuple(carriers),
            strand=strand,
            line=self._line,
            parents=parents,
            before=self._last.get(strand),
        )
        if loop.before is not None:
            loop.before.after = loop
        for parent in parents:
            parent.child = parent.child or loop
        self._last[strand] = loop
        self.loops.append(loop)
        return loop

    def _check_facing(self, here: tuple[str, int], there: tuple[str, int]) -> None:
        front, back = (here, there) if here[0][0] == "f" else (there, here)
        if (front[0][0], back[0][0]) != ("f", "b") or front[1] != back[1] + self._rack:
            names = [f"{bed}{needle}" for bed, needle in (here, there)]
            raise self._problem(
                f"{names[0]} and {names[1]} do not face each other at rack {self._rack:g}.",
                "Rack the back bed so that needle f(n + rack) faces bn.",
            )

    # Others --------------------------------------------------------------------------------

    def rack(self, given: list[str]) -> None:
        word = self._words(given, 1, "rack NUMBER")[0]
        try:
            self._rack = float(word)
        except ValueError:
            raise self._problem(f"{word[:40]!r} is not a number of needles to rack.") from None

    def miss(self, given: list[str]) -> None:
        _, (word, *carriers) = self._directed(given, 1, "miss + NEEDLE CARRIER")
        self._needle(word)
        for carrier in carriers:
            self._strand(carrier)

    def no_stitch(self, given: list[str]) -> None:
        del given


@dataclass
class _StateMachine(_Machine):
    """A machine that remembers the states before its passes."""

    states: list[LoopState] = field(default_factory=list)
    _crossed: CrossedLoops = field(default_factory=dict)
    _meeting: dict[frozenset[int], int] = field(default_factory=dict)
    """Side on which the loop of the lower number came, of two that face each other."""
    _pass: tuple[bool, tuple[int, ...]] | None = None

    def transfer(self, given: list[str]) -> None:
        here, there = map(self._needle, self._words(given, 2, "xfer NEEDLE NEEDLE")[:2])
        if here[0][0] != there[0][0] and here in self._held:
            self._held[here].reverse()  # the bed's own side is the other one there
        super().transfer(given)

    def rack(self, given: list[str]) -> None:
        before = self._rack
        super().rack(given)
        for (bed, needle), behind in self._held.items():
            if bed != "b":
                continue
            start, end = needle + before, needle + self._rack
            for number in range(math.floor(min(start, end)), math.ceil(max(start, end)) + 1):
                for front in self._held.get(("f", number), ()):
                    for back in behind:
                        self._pass_by(front, back, number - start, number - end)

    def _pass_by(self, front: Loop, back: Loop, before: float, after: float) -> None:
        """Note a loop that lies on the other side of another than before."""
        pair = frozenset((front.number, back.number))
        way = 1 if front.number < back.number else -1
        side = way * _sign(before) or self._meeting.pop(pair, 0)
        if not after:
            self._meeting[pair] = side
        elif side and side != way * _sign(after):
            crossings = self._crossed.setdefault(pair, [])
            if crossings and crossings[-1] == front.number:
                crossings.pop()
            else:
                crossings.append(front.number)

    def _make(
        self,
        kind: str,
        needle: tuple[str, int],
        rightwards: bool,
        carriers: list[str],
        parents: tuple[Loop, ...],
    ) -> Loop:
        strand = tuple(self._strand(carrier) for carrier in carriers)
        begun = self.states[-1].before if self.states else 0
        is_linked = any(parent.number >= begun for parent in parents)
        if self._pass != (rightwards, strand) or is_linked:
            held = {place: tuple(loops) for place, loops in self._held.items() if loops}
            if parents:
                held[needle] = parents
            self.states.append(LoopState(len(self.loops), held, self._crossed))
            self._pass, self._crossed = (rightwards, strand), {}
        return super()._make(kind, needle, rightwards, carriers, parents)


MachineOf = TypeVar("MachineOf", bound=_Machine)


def _sign(value: float) -> int:
    return (value > 0) - (value < 0)


_OPERATIONS: Final[dict[str, str]] = {
    "in": "bring_in",
    "inhook": "bring_in",
    "out": "take_out",
    "outhook": "take_out",
    "releasehook": "release",
    "knit": "knit",
    "tuck": "tuck",
    "split": "split",
    "xfer": "transfer",
    "drop": "drop",
    "amiss": "no_stitch",
    "miss": "miss",
    "kick": "miss",
    "rack": "rack",
    "stitch": "no_stitch",
    "pause": "no_stitch",
}
