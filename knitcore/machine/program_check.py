"""Programs of anybody's held against a machine's profile, line by line.

It finds what makes a machine stop or a program translator refuse, and what costs passes or
stitches: the kinds that users of the public back ends report. Whether the loops make sense is for
:mod:`knitcore.machine.knitout_machine`.
"""

import math
import re
from collections import Counter
from dataclasses import dataclass, field

from knitcore.machine.profile import Dialect, MachineProfile
from knitcore.machine.program_passes import stitch_number_of

_MAGIC = re.compile(r";!knitout-\d+")
_NEEDLE = re.compile(r"([fb])s?(-?\d{1,6})")
_HEADERS = {"Machine", "Gauge", "Width", "Position", "Carriers"}
_YARN_FIRST = "Bring yarn in with `in`, after waste yarn that holds its end."
MOST_LOOPS = 4
"""Loops beyond which a needle's hook loses some."""
_IN = {"in", "inhook", "out", "outhook", "releasehook"}


@dataclass(frozen=True)
class ProgramProblem:
    """Something that a machine cannot do with a program, or does badly.

    Attributes
    ----------
    line : the first line that shows it, from 1.
    subject : header, carriers, needles, beds, racking, passes, floats or transfers.
    problem, remedy : a sentence each.
    stops : whether the machine or its translator refuses the program; otherwise it costs passes or
        stitches.
    times : lines that show it.
    """

    line: int
    subject: str
    problem: str
    remedy: str
    stops: bool = True
    times: int = 1

    def __str__(self) -> str:
        """The problem in a line."""
        more = f" ({self.times} times)" if self.times > 1 else ""
        return f"line {self.line}: {self.subject}: {self.problem}{more} {self.remedy}"


def check_program(program: str, machine: MachineProfile) -> tuple[ProgramProblem, ...]:
    """Hold a knitout program against a machine's profile.

    Parameters
    ----------
    program : its text.
    machine : the profile.

    Returns
    -------
    tuple of ProgramProblem
        In the order of lines, one for each kind; empty if the machine can knit it.

    Examples
    --------
    >>> from knitcore.machine.profile import profile
    >>> text = ";!knitout-2\\n;;Carriers: 1 2\\ninhook 1\\nknit - f1 1\\nrack 5\\nouthook 1\\n"
    >>> [str(problem) for problem in check_program(text, profile("swg091n2"))]
    ['line 5: racking: 5 is beyond the limit of 4 needles. Transfer in steps of at most 4 needles.']
    """
    check = _Check(machine)
    lines = program.removeprefix("\ufeff").split("\n")
    check.read_headers(lines)
    for check.line, text in enumerate(lines, 1):
        words = text.split(";", 1)[0].split()
        if words and words[0].startswith("x-"):
            check.read_setting(words[0], words[1:])
        elif words:
            check.read(words[0], words[1:])
    check.end()
    return tuple(sorted(check.problems.values(), key=lambda problem: problem.line))


@dataclass
class _Pass:
    """A run of the carriage: its way, what works on each bed, and where it stands."""

    key: tuple[object, ...] = ()
    kinds: dict[str, str] = field(default_factory=dict)
    slot: float | None = None
    stitched: float | None = None


class _Check:
    """The state of a machine, as far as its profile limits it."""

    def __init__(self, machine: MachineProfile) -> None:
        self.problems: dict[tuple[str, str], ProgramProblem] = {}
        self.line = 1
        self._machine = machine
        self._names = [str(name) for name in range(1, machine.carriers.count + 1)]
        self._in: dict[str, bool] = {}
        self._rack = 0.0
        self._pass = _Pass()
        self._span: tuple[float, float] | None = None
        self._span_line = 1
        self._keeps = False
        self._came_from: dict[str, tuple[str, int]] = {}
        """Where a transferred loop was, and after which changes of racking it left."""
        self._moved_at = 0.0
        self._moves = 0
        self._loops: Counter[str] = Counter()
        self._hooked = ""
        self._set: set[str] = set()
        self._has_waste = False

    def add(self, subject: str, problem: str, remedy: str, *, stops: bool = True) -> None:
        """Note a problem, or another line with the same."""
        before = self.problems.get((subject, problem))
        line, times = (before.line, before.times + 1) if before else (self.line, 1)
        self.problems[subject, problem] = ProgramProblem(
            line, subject, problem, remedy, stops, times
        )

    def read_headers(self, lines: list[str]) -> None:
        """Check the headers, which end at the first line that is none."""
        machine = self._machine
        if not _MAGIC.fullmatch(lines[0].rstrip("\r")):
            self.add("header", "the first line is not ;!knitout-2.", "Begin with ;!knitout-2.")
        headers: dict[str, str] = {}
        at_top = True
        for self.line, text in enumerate(lines[1:], 2):
            name, colon, value = text[2:].partition(": ")
            is_header = text.startswith(";;") and bool(colon)
            if is_header and at_top:
                headers[name] = value.strip()
                if name not in _HEADERS and not name.startswith("Yarn-"):
                    self.add(
                        "header",
                        f"{name[:40]} is not a header of knitout.",
                        "Write it as a comment.",
                        stops=False,
                    )
            elif is_header and name in _HEADERS:
                self.add(
                    "header",
                    f"{name} stands below other lines and is not read.",
                    "Write all headers at the top, without blank lines or comments between them.",
                )
            at_top = at_top and is_header
        self.line = 2
        self._keeps = headers.get("Position", machine.position or "Center") == "Keep"
        listed, known = headers.get("Carriers", "").split(), " ".join(self._names)
        is_exact = machine.dialect is Dialect.KNITERATE
        if not listed:
            self.add("header", "the header Carriers is missing.", f"Write ;;Carriers: {known}")
        elif set(listed) - set(self._names) or (is_exact and listed != self._names):
            self.add(
                "header",
                f"{len(listed)} carriers are listed; {machine.name} has {len(self._names)}.",
                f"Write ;;Carriers: {known}",
            )
        name = headers.get("Machine", machine.header)
        if name.lower() != machine.header.lower():
            self.add(
                "header",
                f"the program is for the machine {name[:40]}.",
                f"Make it for {machine.header}, or choose that machine.",
                stops=False,
            )

    def read_setting(self, operation: str, words: list[str]) -> None:
        """Check an operation of a machine's own that sets it."""
        self._set.add(operation)
        numbers = self._machine.stitch_number
        if operation not in ("x-stitch-number", "x-xfer-stitch-number") or not words:
            return
        number = stitch_number_of(words[0])
        if number is None or not numbers.least <= number <= numbers.most:
            self.add(
                "settings",
                f"there is no stitch number {words[0][:20]}.",
                f"Give one of {numbers.least:g} to {numbers.most:g}.",
            )

    def read(self, operation: str, words: list[str]) -> None:
        """Carry out an operation."""
        if operation in _IN:
            self._carrier(operation, words)
        elif operation == "rack":
            self._racked(words)
        elif operation in ("knit", "tuck", "miss", "split"):
            self._yarn(operation, words)
        elif operation in ("xfer", "drop", "amiss"):
            self._pass = _Pass()
            for word in words[:2]:
                self._needle(word)
            if operation == "xfer" and len(words) == 2:
                self._transfer(*words)
            elif words:
                self._came_from.pop(words[0], None)
                self._loops.pop(words[0], None)

    def end(self) -> None:
        """Check what only the whole program shows."""
        if self._in:
            names = ", ".join(self._in)
            self.add(
                "carriers", f"carrier {names} is still in at the end.", f"End with out {names}."
            )
        machine = self._machine
        if self._span is None:
            return
        for operation, setting in (
            ("x-stitch-number", machine.stitch_number.transfer),
            ("x-roller-advance", machine.roller_advance),
        ):
            if setting is not None and operation not in self._set:
                self.line = 1
                self.add(
                    "settings",
                    f"{operation} is not set: the machine takes what was set last.",
                    "Set it at the beginning.",
                    stops=False,
                )
        least, most = self._span
        self.line = self._span_line
        if self._keeps and (least < 1 or most > machine.needles):
            outside = least if least < 1 else most
            self.add(
                "needles",
                f"needle {outside:g} is not one of 1 to {machine.needles}.",
                "Begin at needle 1, or let the header Position centre the piece.",
            )
        elif most - least + 1 > machine.needles:
            self.add(
                "needles",
                f"{most - least + 1:g} needles are in use; {machine.name} has {machine.needles}.",
                "Knit it in narrower pieces.",
            )

    def _carrier(self, operation: str, names: list[str]) -> None:
        self._pass = _Pass()
        park = self._machine.carriers
        if operation.endswith("hook") and not park.hooks:
            self.add("carriers", f"{operation} needs a hook, which there is not.", _YARN_FIRST)
        for name in names:
            if name not in self._names:
                self._unknown(name)
            elif operation in ("in", "inhook"):
                if name in self._in:
                    self.add("carriers", f"carrier {name} is in already.", "Take it out first.")
                self._in[name] = True
                if operation == "inhook" and self._hooked:
                    self.add(
                        "carriers",
                        f"the hook still holds carrier {self._hooked}: the yarns tangle.",
                        f"Knit with it and write releasehook {self._hooked} first.",
                    )
                self._hooked = name if operation == "inhook" else self._hooked
            elif name not in self._in:
                self._absent(name)
            elif operation == "releasehook":
                self._hooked = ""
            else:
                del self._in[name]
                self._hooked = "" if name == self._hooked else self._hooked

    def _unknown(self, name: str) -> None:
        most = self._machine.carriers.count
        self.add("carriers", f"there is no carrier {name[:20]}.", f"Use carriers 1 to {most}.")

    def _absent(self, name: str) -> None:
        self.add("carriers", f"carrier {name} is not in.", f"Bring it in before, with in {name}.")

    def _racked(self, words: list[str]) -> None:
        self._pass = _Pass()
        racking = self._machine.racking
        try:
            self._rack = float(words[0])
        except (IndexError, ValueError):
            self.add("racking", "rack has no number.", "Give the needles to rack by.")
            return
        half = self._rack % 1 == 0.25 and racking.step_needles == 0.5
        steps = self._rack / racking.step_needles
        if abs(self._rack) > racking.most_needles:
            most = racking.most_needles
            remedy = f"Transfer in steps of at most {most:g} needles." if most else "Do not rack."
            self.add("racking", f"{self._rack:g} is beyond the limit of {most:g} needles.", remedy)
        elif not half and not math.isclose(steps, round(steps), abs_tol=1e-9):
            self.add(
                "racking",
                f"{self._rack:g} is between two positions of the bed.",
                f"Rack by steps of {racking.step_needles:g} needles.",
            )

    def _needle(self, word: str) -> tuple[str, float] | None:
        match = _NEEDLE.fullmatch(word)
        if match is None:
            self.add("needles", f"{word[:20]!r} is not a needle.", "Write it as f12 or b3.")
            return None
        bed, slot = match[1], float(match[2])
        if bed == "b":
            if self._machine.beds == 1:
                self.add(
                    "beds",
                    "a needle of the back bed works; the machine has one bed.",
                    "Knit plain, or choose a machine with two beds.",
                )
            slot += math.floor(self._rack)
        least, most = self._span or (slot, slot)
        if slot < least or slot > most or self._span is None:
            self._span, self._span_line = (min(least, slot), max(most, slot)), self.line
        return bed, slot

    def _yarn(self, operation: str, words: list[str]) -> None:
        needles = 2 if operation == "split" else 1
        if len(words) < 1 + needles:
            return
        way, names = words[0], words[1 + needles :]
        place = self._needle(words[1])
        if place is None:
            return
        self._came_from.pop(words[1], None)
        if operation == "split":
            self._split(words[1], words[2])
        elif operation != "miss":
            self._pile(words[1], 1 if names else 0, keeps=operation == "tuck")
        if not names:
            self._pass = _Pass()
            return
        for name in names:
            if name not in self._names:
                self._unknown(name)
            elif name not in self._in:
                self._absent(name)
            elif self._in[name]:
                self._begin(name, way)
        if len(names) > 1 and self._machine.dialect is Dialect.KNITERATE:
            self.add(
                "carriers", "two carriers knit in one pass.", "Thread both yarns into one carrier."
            )
        self._go_on(operation, way, place, names)

    def _begin(self, name: str, way: str) -> None:
        """Check the first pass of a yarn, which comes from where carriers are parked."""
        self._in[name] = False
        park = self._machine.carriers
        outwards = "-" if park.parking == "left" else "+"
        if park.waste is not None and name == str(park.waste):
            self._has_waste = True
        elif park.waste is not None and not self._has_waste:
            self.add(
                "carriers",
                f"carrier {name} knits before the waste yarn, and nothing holds its end.",
                f"Knit waste yarn first, with carrier {park.waste}.",
                stops=False,
            )
        if not park.hooks and way == outwards:
            towards = "right" if outwards == "-" else "left"
            self.add(
                "carriers",
                f"carrier {name} comes from the {park.parking}, but its first pass runs there.",
                f"Begin with a pass that runs {towards}wards.",
            )

    def _go_on(self, operation: str, way: str, place: tuple[str, float], names: list[str]) -> None:
        """Add a stitch to the pass, or begin a new one where it does not fit."""
        bed, slot = place
        now, key = self._pass, (way, tuple(names), self._rack)
        step = 1 if way == "+" else -1
        at_half = self._rack % 1 != 0
        behind = now.slot is not None and (slot - now.slot) * step < (0 if at_half else 1)
        if now.key != key or (behind and operation != "miss"):
            now = self._pass = _Pass(key)
        if operation in ("knit", "tuck"):
            if now.kinds.get(bed, operation) != operation and not self._machine.tuck_with_knit:
                self.add(
                    "passes",
                    "a pass tucks and knits on one bed, which takes two passes here.",
                    "Bring the carrier back with miss, and tuck in a pass of its own.",
                    stops=False,
                )
                now = self._pass = _Pass(key)
            now.kinds[bed] = operation
        if operation != "miss":
            longest = self._machine.longest_float_needles
            if now.stitched is not None and abs(slot - now.stitched) - 1 > longest:
                self.add(
                    "floats",
                    f"the yarn passes more than {longest} needles without a stitch.",
                    "Tuck it in between, or knit the parts with carriers of their own.",
                    stops=False,
                )
            now.stitched = slot
        now.slot = slot

    def _split(self, here: str, there: str) -> None:
        if self._loops[there]:
            self.add(
                "transfers",
                "a split moves a loop onto another one.",
                "Split onto an empty needle.",
                stops=False,
            )
        self._pile(there, self._loops[here], keeps=True)
        self._pile(here, 1, keeps=False)

    def _pile(self, needle: str, more: int, *, keeps: bool) -> None:
        """Put loops onto a needle."""
        self._loops[needle] = more + (self._loops[needle] if keeps else 0)
        if self._loops[needle] > MOST_LOOPS:
            self.add(
                "transfers",
                f"a needle holds more than {MOST_LOOPS} loops.",
                "Knit it before more loops are put onto it.",
                stops=False,
            )

    def _transfer(self, here: str, there: str) -> None:
        moved = self._loops.pop(here, 0)
        self._pile(there, moved, keeps=True)
        if self._rack % 1:
            self.add(
                "racking",
                "loops are transferred while needles do not face each other.",
                "Rack by whole needles before transfers.",
            )
        self._moves += self._rack != self._moved_at
        self._moved_at = self._rack
        origin = self._came_from.pop(here, (here, self._moves))
        # Between transfers at another racking, a loop may well have stood aside for them.
        if origin == (there, self._moves) and self._loops[there] == moved:
            self.add(
                "transfers",
                "a loop is moved away and back before it is knitted.",
                "Leave it on its bed: each transfer may drop it.",
                stops=False,
            )
        else:
            self._came_from[there] = ("", 0) if there in self._came_from else origin
