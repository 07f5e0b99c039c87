"""Programs in knitout v2 that knit a piece flat on a V-bed machine, after its profile.

A knit of the face is made on the front bed, a purl on the back bed. Before a course, the loops
whose next stitch is of the other kind are transferred straight across. Needle 1 is the left edge of
the face; at half gauge every other needle rests. Programs end in courses of waste yarn, which hold
the last course without a transfer, or in a chain bind-off. How yarn comes in, and whether waste
yarn comes first, is in :mod:`knitcore.machine.feed`.

Edges are shaped as by hand. Where a course begins, its own yarn casts on and binds off; where it
ends, that yarn has not arrived, so a separate strand is used. A loss of one stitch is a decrease:
its loop is put onto the neighbour. Blocks of colour have a carrier each (intarsia), and each course
tucks the yarn of a block into the next one, so that no slit is left; a machine whose passes either
knit or tuck does so in a pass of its own.

Specification: https://textiles-lab.github.io/knitout/knitout.html
"""

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum
from functools import partial

import numpy as np

from knitcore.base.errors import InputError
from knitcore.chart.stitch_chart import StitchChart
from knitcore.garment.piece import Piece
from knitcore.machine.carriers import CarrierPlan, plan_carriers
from knitcore.machine.feed import TUBE_PASSES
from knitcore.machine.profile import DEFAULT, Dialect, MachineProfile, profile, profiles
from knitcore.machine.program_body import WASTE_COURSES, ProgramBody
from knitcore.machine.program_passes import read_passes
from knitcore.machine.tension import (
    BREAK_RISK,
    LoopYarn,
    PassTension,
    breaking,
    pass_tensions,
    tightest_of,
)

MOST_LISTED = 6
"""Courses that a sentence names."""
_COURSE = re.compile(r"; course (\d+)")
_NEEDLE = re.compile(r"([fb]s?)(-?\d+)")


class Finish(StrEnum):
    """The finish that keeps the last course from ravelling."""

    WASTE = "waste"
    BIND_OFF = "bind-off"


@dataclass(frozen=True)
class KnitoutProgram:
    """A program and its figures for a technician.

    Attributes
    ----------
    text : the program, one instruction a line.
    transfers : loops moved across the beds between the chart's courses.
    shaping_transfers : further loops moved to shape the edges.
    carriers : yarn carriers, without those of waste yarn and draw thread.
    machine : the profile that it is for.
    stitch_number : of the piece.
    draws_waste : true if waste yarn takes the place of the draw thread.
    spared : what was done so that transfers do not break the yarn, in a sentence; or empty.
    tuck_passes : further passes where tucks and knits share a bed and a pass cannot hold both.
    steps : what the user does at the machine before and after, a sentence each.
    """

    text: str
    transfers: int
    shaping_transfers: int
    carriers: int = 1
    machine: str = DEFAULT
    stitch_number: float | None = None
    draws_waste: bool = False
    spared: str = ""
    tuck_passes: int = 0
    steps: tuple[str, ...] = ()

    @property
    def notes(self) -> tuple[str, ...]:
        """Sentences on what the machine does otherwise than a reader of the chart expects."""
        tucks = f"Tucks beside knits take {self.tuck_passes} passes more: a bed does one of both."
        return (*([self.spared] if self.spared else []), *([tucks] if self.tuck_passes else []))


BodyOf = Callable[
    [Piece, CarrierPlan, MachineProfile, float, LoopYarn | None, Mapping[int, float]], ProgramBody
]
"""Makes the passes of a program."""


def knitout_program(
    chart: StitchChart | Piece,
    *,
    finish: Finish = Finish.WASTE,
    machine: MachineProfile | None = None,
    stitch_number: float | None = None,
    yarn: LoopYarn | None = None,
    body_of: BodyOf = ProgramBody,
    looser: Mapping[float, LoopYarn] | None = None,
) -> KnitoutProgram:
    """The program of a chart; :func:`knitcore.formats.read.knitout_reader.verified` checks it.

    Parameters
    ----------
    chart : a chart, or a piece with its outline and yarns.
    finish : how it ends.
    machine : the machine's profile; :data:`knitcore.machine.profile.DEFAULT` if none is given.
    stitch_number : of the piece's stitches; the profile's default if none is given.
    yarn : of the piece: transfers that would break it are staged, slowed or refused; None does not
        look at it.
    body_of : makes the passes of the piece, which is mirrored if :func:`is_mirrored` says so.
    looser : larger stitch numbers and their loops, for rows before transfers that would strain the
        yarn; None brings all loops to the front instead, before a bed is racked.

    Raises
    ------
    InputError
        If the machine reads no programs, has no such stitch number, is narrower than the chart, has
        fewer carriers than the chart has blocks of colour, or lacks the bed or the racking that
        the piece needs; or if transfers would break the yarn.

    Examples
    --------
    >>> knitout_program(StitchChart.of_fabric("seed", rows=4, columns=6)).transfers
    18
    """
    machine = machine or profile(DEFAULT)
    number = _checked_number(machine, stitch_number)
    piece = Piece.of(chart)
    _check_machine(piece, machine)
    make = partial(_lines, piece, machine, number, finish, yarn, body_of)
    lines, spared = _knitted(make, machine, yarn, looser)
    stitch = piece.shaped.stitch
    changed = (piece.chart.purl[1:] ^ piece.chart.purl[:-1]) & stitch[1:] & stitch[:-1]
    crossings = int(np.count_nonzero(changed))
    park = machine.carriers
    plan = plan_carriers(piece, park)
    changes = sum(step.changes for step in read_passes("\n".join(lines)).passes)
    begin = lines.index("; cast-on")
    end = lines.index("; waste yarn" if finish is Finish.WASTE else "; bind-off")
    return KnitoutProgram(
        "\n".join(lines) + "\n",
        crossings,
        max(sum(line.startswith("xfer") for line in lines[begin:end]) - crossings, 0),
        len(plan.yarns),
        machine.identifier,
        number,
        plan.draw == plan.waste,
        spared,
        0 if machine.tuck_with_knit else 2 * changes,
        tuple(_steps(piece, plan, machine, finish, lines)),
    )


def _steps(
    piece: Piece, plan: CarrierPlan, machine: MachineProfile, finish: Finish, lines: Sequence[str]
) -> Iterator[str]:
    """Say what the user does at the machine before and after, a sentence each."""
    used = {line.rsplit(" ", 1)[-1] for line in lines if line.startswith(("knit", "tuck"))}
    yarns = {k: f"{piece.yarns[y].name} ({piece.yarns[y].colour})" for k, y in plan.yarns.items()}
    has_draw = not machine.carriers.hooks and plan.draw not in (None, plan.waste)
    if has_draw and plan.draw is not None:
        yarns[plan.draw] = "a smooth, strong draw thread"
    if str(plan.waste) in used:
        yarns[plan.waste] = "waste yarn"
    threaded = "; ".join(f"{carrier} {yarn}" for carrier, yarn in sorted(yarns.items()))
    yield f"Before: thread carrier {threaded}."
    settings = (
        ("stitch number", machine.stitch_number),
        ("speed", machine.speed),
        ("roller advance", machine.roller_advance),
    )
    of_waste = [f"{name} {of.waste:g}" for name, of in settings if of and of.waste is not None]
    set_so = f", with {', '.join(of_waste)}" if of_waste else ""
    if not machine.carriers.hooks:
        yield f"It begins with {machine.waste_passes + TUBE_PASSES} passes of waste yarn{set_so}."
        off = "pull out the draw thread" if has_draw else "cut the last course of waste yarn"
        yield f"After: {off}, and the waste comes off the cast-on."
    if finish is Finish.WASTE:
        yield (
            f"The last row hangs on {WASTE_COURSES} courses of waste yarn: bind it off or graft "
            "it by hand, then unravel them."
        )
    else:
        yield "The last row is bound off: draw the end of the yarn through the last stitch."


def _knitted(
    make: Callable[[Mapping[int, float]], list[str]],
    machine: MachineProfile,
    yarn: LoopYarn | None,
    looser: Mapping[float, LoopYarn] | None,
) -> tuple[list[str], str]:
    """The lines of a program that the yarn stands, and what was done for it."""
    lines = make({})
    if yarn is None:
        return lines, ""
    risky = _risky(lines, yarn, machine)
    courses = {_course(lines, step.line) - 1 for step in risky if step.rack}
    spared = ""
    if courses and looser is None:
        lines = make(dict.fromkeys(courses, 0.0))
        rows = f"{len(courses)} {'course' if len(courses) == 1 else 'courses'}"
        spared = f"Before {rows}, all loops come to the front so that racking spares the yarn."
        risky = _risky(lines, yarn, machine)
    elif rows_before := sorted(courses - {0}):
        for number in sorted(looser or ()):
            loosened = make(dict.fromkeys(rows_before, number))
            left = _risky(loosened, yarn, machine, looser)
            if len(left) < len(risky):
                lines, risky = loosened, left
                spared = (
                    f"Stitch number {number:g} in {_listed(rows_before)} gives the loops the yarn "
                    "for the transfers after it."
                )
            if not left:
                break
    worst = tightest_of(risky)
    if worst is None:
        return lines, spared
    course = _course(lines, worst.line)
    if (refusal := breaking(worst, yarn, machine)) is not None:
        problem = f"course {course}: {refusal.problem}"
        raise InputError("transfers", problem, refusal.remedy)
    speed = machine.speed
    slow = speed and (speed.transfer or speed.default / 2)
    if slow:
        lines = _slowed(lines, {step.line for step in risky}, slow, speed.default if speed else 0)
    how = f"Slowed to {slow:g}" if slow else "Slow down and watch"
    passes = f"{len(risky)} {'pass' if len(risky) == 1 else 'passes'} of transfers"
    chance = worst.tightest.break_chance if worst.tightest else 0.0
    slowed = f"{how}: {passes}, the tightest of course {course}: {chance:.0%} chance of a break."
    return lines, f"{spared} {slowed}".strip()


def _listed(courses: Sequence[int]) -> str:
    """Courses by their numbers, from 1; the first few of many."""
    names = [str(course) for course in courses[:MOST_LISTED]]
    more = f" and {len(courses) - MOST_LISTED} more" if len(courses) > MOST_LISTED else ""
    return f"{'course' if len(courses) == 1 else 'courses'} {', '.join(names)}{more}"


def _risky(
    lines: Sequence[str],
    yarn: LoopYarn,
    machine: MachineProfile,
    looser: Mapping[float, LoopYarn] | None = None,
) -> list[PassTension]:
    return [
        step
        for step in pass_tensions("\n".join(lines), yarn, machine, looser)
        if step.tightest is not None and step.tightest.break_chance >= BREAK_RISK
    ]


def _course(lines: Sequence[str], number: int) -> int:
    """The course that a line belongs to; 1 before the first."""
    above = (_COURSE.fullmatch(line) for line in reversed(lines[:number]))
    return next((int(match[1]) for match in above if match), 1)


def _slowed(lines: Sequence[str], starts: set[int], slow: float, usual: float) -> list[str]:
    """The lines with another speed for passes of transfers that begin at some of them."""
    changed: list[str] = []
    is_slow = False
    for number, line in enumerate(lines, 1):
        if is_slow and not line.startswith("xfer"):
            changed.append(f"x-speed-number {usual:g}")
            is_slow = False
        if number in starts and not is_slow:
            changed.append(f"x-speed-number {slow:g}")
            is_slow = True
        changed.append(line)
    return changed


def _lines(
    piece: Piece,
    machine: MachineProfile,
    number: float,
    finish: Finish,
    yarn: LoopYarn | None,
    body_of: BodyOf,
    staged: Mapping[int, float],
) -> list[str]:
    """All lines of a program.

    Yarn comes from the right by a hook, and from the left otherwise; a machine that is the other
    way round knits the mirrored program of the mirrored piece.
    """
    piece = piece.mirrored() if is_mirrored(machine) else piece
    plan = plan_carriers(piece, machine.carriers)
    body = body_of(piece, plan, machine, number, yarn, staged)
    yarns = piece.yarns
    lines = [
        *body.start(),
        *body.cast_on(),
        *body.courses(),
        *(body.waste() if finish is Finish.WASTE else body.bind_off()),
    ]
    _check_beds(lines, machine)
    return [
        *_headers(machine),
        *(f"; carrier {k} knits {yarns[y].colour} {yarns[y].name}" for k, y in plan.yarns.items()),
        *(_mirrored(lines) if is_mirrored(machine) else lines),
    ]


def is_mirrored(machine: MachineProfile) -> bool:
    """Say whether a machine knits the mirrored program of the mirrored piece."""
    return not machine.carriers.hooks and machine.carriers.parking == "right"


def _mirrored(lines: Sequence[str]) -> Iterator[str]:
    """Passes of a machine on which left is right."""
    passes = [line for line in lines if not line.startswith((";", "x-"))]
    needles = [int(match[2]) for line in passes for match in _NEEDLE.finditer(line)]
    ends = min(needles) + max(needles)
    ways = str.maketrans("+-", "-+")
    for line in lines:
        if line.startswith((";", "x-")):
            yield line
        elif line.startswith("rack "):
            yield f"rack {-int(line[5:])}"
        else:
            operation, *words = line.split(" ")
            words = [word.translate(ways) if word in "+-" else word for word in words]
            yield " ".join(
                [operation, *(_NEEDLE.sub(lambda m: f"{m[1]}{ends - int(m[2])}", w) for w in words)]
            )


def _headers(machine: MachineProfile) -> Iterator[str]:
    """The headers, which stand together at the top: below a comment they are not read."""
    yield ";!knitout-2"
    yield f";;Machine: {machine.header}"
    yield f";;Gauge: {machine.gauge_needles_per_inch:g}"
    if machine.dialect is Dialect.KNITERATE:
        yield f";;Width: {machine.needles}"
    if machine.position is not None:
        yield f";;Position: {machine.position}"
    yield f";;Carriers: {' '.join(map(str, range(1, machine.carriers.count + 1)))}"


def _checked_number(machine: MachineProfile, number: float | None) -> float:
    numbers = machine.stitch_number
    if number is None:
        return numbers.default
    whole = "whole " if numbers.whole else ""
    if not numbers.least <= number <= numbers.most or (numbers.whole and number % 1):
        raise InputError(
            "stitch_number",
            f"{machine.name} has no stitch number {number:g}.",
            f"Give a {whole}number from {numbers.least:g} to {numbers.most:g}.",
        )
    return number


def _check_machine(piece: Piece, machine: MachineProfile) -> None:
    """Refuse a piece that a machine cannot knit."""
    if not machine.reads_programs:
        others = [name for name, m in profiles().items() if m.reads_programs]
        raise InputError(
            "machine",
            f"{machine.name} is worked by hand: it reads no program.",
            f"Export written rows or a chart for it, or a program for {', '.join(others)}.",
        )
    columns, rows = piece.chart.columns, piece.chart.rows
    if columns > machine.columns:
        parts = -(-columns // machine.columns)
        gauge = " at half gauge" if machine.needles_per_column > 1 else ""
        turned = (
            f"; turned by a quarter it is {rows} columns wide" if rows <= machine.columns else ""
        )
        raise InputError(
            "chart",
            f"{columns} columns are wider than the machine's {machine.needles} needles{gauge}.",
            f"Knit at most {machine.columns} columns: split the chart into {parts} pieces of "
            f"{-(-columns // parts)}{turned}.",
        )
    purls = np.argwhere(piece.chart.purl & piece.shaped.stitch)
    if machine.beds == 1 and len(purls):
        row, column = purls[0] + 1
        raise InputError(
            "chart",
            f"row {row}, column {column} is a purl, which needs a second bed; {machine.name} has "
            "one.",
            "Knit plain, re-form the purls by hand from the written rows, or choose a machine "
            "with two beds.",
        )


def _check_beds(lines: Sequence[str], machine: MachineProfile) -> None:
    """Refuse transfers to a bed that there is not."""
    if machine.beds == 1 and any(" b" in line for line in lines if line[0] != ";"):
        raise InputError(
            "outline",
            f"decreases and bind-offs move loops over a second bed; {machine.name} has one.",
            "Knit a rectangle that ends in waste yarn, or choose a machine with two beds.",
        )
