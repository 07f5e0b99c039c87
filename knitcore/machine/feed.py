"""The ways in which machines bring yarn in and take it out, as lines of a program.

A hook on the right holds the end of a yarn (:class:`HookFeed`). A machine without one knits waste
yarn first, which holds the ends of all yarns; carriers then wait beside the piece
(:class:`WasteFeed`), as the users of the public Kniterate back end knit.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from knitcore.machine.carriers import CarrierPlan
from knitcore.machine.profile import Dialect, MachineProfile

LEAST_WASTE_NEEDLES = 20
"""Needles that the rollers of a Kniterate need to hold, after its users' script."""
TUBE_PASSES = 12
"""Passes, front and back in turn, that end the waste yarn with a clean edge on the front bed."""


def is_leftwards(row: int) -> bool:
    """Say whether the carriage knits a row leftwards: row 0 and every other one."""
    return row % 2 == 0


@dataclass(frozen=True)
class FirstCourse:
    """The needles of a piece.

    Attributes
    ----------
    front, back : those of the first course, from left to right.
    least, most : the outermost ones of the whole piece.
    """

    front: Sequence[int]
    back: Sequence[int]
    least: int
    most: int


class HookFeed:
    """Yarn that a hook holds; it comes from the right."""

    needs_anchor = True
    """True where yarn comes leftwards only, so that a course rightwards must tie it first."""
    base_loops = 0
    """Loops that a needle holds before the cast-on."""

    def __init__(
        self, machine: MachineProfile, plan: CarrierPlan, needles: FirstCourse, number: float
    ) -> None:
        self._machine, self._plan, self._needles = machine, plan, needles
        self._stitch_number = self._row_number = number

    def start(self) -> Iterator[str]:
        """The lines before the cast-on."""
        yield from self._settings("default")

    def comes_from_right(self, row: int) -> bool:
        """Say whether new yarn of a row comes from the right."""
        del row
        return True

    def bring(self, carrier: int) -> Iterator[str]:
        """Bring a yarn in."""
        yield f"inhook {carrier}"

    def hold(self, carrier: int) -> Iterator[str]:
        """Let a yarn go that the fabric holds now."""
        yield f"releasehook {carrier}"

    def end(self, carrier: int, row: int | None) -> Iterator[str]:
        """Take a yarn out that a row does not knit, or after the piece (None)."""
        del row
        yield f"outhook {carrier}"

    def strand(self, *, on_left: bool) -> int:
        """The carrier of a separate strand at an edge."""
        del on_left
        return self._plan.waste

    def end_strand(self, carrier: int) -> Iterator[str]:
        """Take a separate strand away."""
        yield f"outhook {carrier}"

    def waste_settings(self) -> Iterator[str]:
        """Extension operations that set the machine for waste yarn after the piece."""
        yield from self._settings("waste")

    def stitch_number(self, number: float | None) -> Iterator[str]:
        """Set the stitch number of a row; None for the piece's own."""
        number = self._stitch_number if number is None else number
        if number != self._row_number:
            self._row_number = number
            yield f"x-stitch-number {_digit(number, self._machine.dialect)}"

    def finish(self, *, after_waste: bool) -> Iterator[str]:
        """Take out the yarns that are still in."""
        if after_waste:
            yield f"outhook {self._plan.waste}"

    def _settings(self, part: str) -> Iterator[str]:
        machine, numbers = self._machine, self._machine.stitch_number
        for_waste = numbers.waste if part == "waste" else self._stitch_number
        if for_waste is not None:
            yield f"x-stitch-number {_digit(for_waste, machine.dialect)}"
        if numbers.transfer is not None and part == "default":
            yield f"x-xfer-stitch-number {_digit(numbers.transfer, machine.dialect)}"
        for name, setting in (
            ("x-speed-number", machine.speed),
            ("x-roller-advance", machine.roller_advance),
        ):
            number = None if setting is None else getattr(setting, part)
            if number is not None:
                yield f"{name} {number:g}"
        if machine.fabric_presser and part == "default":
            yield "x-presser-mode auto"


class WasteFeed(HookFeed):
    """Yarns that waste yarn holds; carriers wait on the side where they are needed next."""

    needs_anchor = False
    base_loops = 1

    def start(self) -> Iterator[str]:
        """Waste yarn that takes in all yarns, and a draw thread."""
        plan, needles = self._plan, self._needles
        used = {*needles.front, *needles.back}
        least, most = self._waste_needles()
        yield "; waste yarn, which takes in all yarns"
        yield from self.waste_settings()
        others = [plan.draw] if plan.draw not in (None, plan.waste) else []
        carriers = [plan.waste, *others, *plan.yarns]
        for place, carrier in enumerate(carriers):
            yield f"in {carrier}"
            yield from self._take_in(carrier, range(least, most + 1), place, len(carriers))
        waste = plan.waste
        for course in range(self._machine.waste_passes):
            yield from _zigzag("knit", range(least, most + 1), waste, course)
        for course in range(TUBE_PASSES + self._machine.waste_passes % 2):
            leftwards = (course + self._machine.waste_passes) % 2 == 1
            order = range(most, least - 1, -1) if leftwards else range(least, most + 1)
            for needle in order:
                yield f"knit {'- b' if leftwards else '+ f'}{needle} {waste}"
        yield from self._park(waste, on_left=True)
        yield from (f"drop f{n}" for n in range(least, most + 1) if n not in used)
        yield from (f"drop b{n}" for n in range(least, most + 1))
        yield from (f"xfer f{n} b{n}" for n in needles.back)
        for carrier in others:
            yield "; draw thread"
            for needle in sorted(used):
                bed = "b" if needle in needles.back else "f"
                yield f"knit + {bed}{needle} {carrier}"
            yield from self._park(carrier, on_left=False)
        yield from self._settings("default")

    def _waste_needles(self) -> tuple[int, int]:
        used = [*self._needles.front, *self._needles.back]
        least, most = min(used), max(used)
        lacking = LEAST_WASTE_NEEDLES - (most - least + 1)
        if lacking > 0:
            most = min(most + lacking, max(self._machine.needles, most))
            least = max(1, min(least, most - LEAST_WASTE_NEEDLES + 1))
        return least, most

    def _take_in(self, carrier: int, needles: range, place: int, carriers: int) -> Iterator[str]:
        """Tuck a yarn into the waste, and leave its carrier where its first row begins."""
        if place == 0:  # waste yarn lays a loop on every needle of both beds
            yield from _zigzag("tuck", needles, carrier, 0)
            yield from _zigzag("tuck", needles, carrier, 1)
            return
        row = self._plan.next_row(carrier, 0)
        on_left = row is None or not is_leftwards(row)
        mine = [n for n in needles if n % carriers == place] or [needles[0]]
        for index, needle in enumerate(mine):
            yield f"tuck + {'bf'[index % 2]}{needle} {carrier}"
        yield from self._park(carrier, on_left=on_left)

    def _park(self, carrier: int, *, on_left: bool) -> Iterator[str]:
        """Leave a carrier beside the piece, where it is in nobody's way."""
        least, most = self._waste_needles()
        outer = min(least, self._needles.least) if on_left else max(most, self._needles.most)
        yield f"miss {'-' if on_left else '+'} f{outer} {carrier}"

    def comes_from_right(self, row: int) -> bool:
        """Say whether new yarn of a row comes from the right."""
        return is_leftwards(row)

    def bring(self, carrier: int) -> Iterator[str]:
        """Nothing: all yarns are in."""
        del carrier
        yield from ()

    def hold(self, carrier: int) -> Iterator[str]:
        """Nothing: the waste yarn holds it."""
        del carrier
        yield from ()

    def end(self, carrier: int, row: int | None) -> Iterator[str]:
        """Take a yarn out, or let it wait for the next row that it knits."""
        next_row = None if row is None else self._plan.next_row(carrier, row)
        if next_row is None:
            yield f"out {carrier}"
        else:
            yield from self._park(carrier, on_left=not is_leftwards(next_row))

    def strand(self, *, on_left: bool) -> int:
        """Waste yarn waits on the left, the draw thread on the right."""
        draw = self._plan.draw
        return self._plan.waste if on_left or draw is None else draw

    def end_strand(self, carrier: int) -> Iterator[str]:
        """Let a separate strand wait on its side."""
        yield from self._park(carrier, on_left=carrier == self._plan.waste)

    def finish(self, *, after_waste: bool) -> Iterator[str]:
        """Take out waste yarn and draw thread."""
        del after_waste
        for carrier in dict.fromkeys((self._plan.waste, self._plan.draw)):
            if carrier is not None:
                yield f"out {carrier}"


def _zigzag(operation: str, needles: range, carrier: int, course: int) -> Iterator[str]:
    """A pass on every other needle of each bed; two of them cover both beds."""
    if course % 2:
        for needle in reversed(needles):
            yield f"{operation} - {'f' if needle % 2 else 'b'}{needle} {carrier}"
    else:
        for needle in needles:
            yield f"{operation} + {'b' if needle % 2 else 'f'}{needle} {carrier}"


def _digit(number: float, dialect: Dialect) -> str:
    """A stitch number as a program writes it: a Kniterate has letters from 10 on."""
    if dialect is Dialect.KNITERATE and number >= 10:
        return chr(ord("A") + int(number) - 10)
    return f"{number:g}"
