"""The passes, minutes, yarn, cost and tightest loops of a program on a machine."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from knitcore.base.bounds import check_positive
from knitcore.garment.piece import Piece, yarn_name
from knitcore.machine.home.plan_rows import HandPlan
from knitcore.machine.profile import MachineProfile
from knitcore.machine.program_passes import ProgramPass, ProgramReading, read_passes
from knitcore.machine.tension import LoopTension, LoopYarn, PassTension, pass_tensions, tightest_of

RUN_OUT_NEEDLES = 6
"""Needles that the carriage passes beyond its work on each side; a stated guess."""


@dataclass(frozen=True)
class CarrierYarn:
    """The yarn that a carrier lays.

    Attributes
    ----------
    carrier : its name in the program.
    loops : that it makes.
    length_m, mass_g : of its yarn, with floats, without tails.
    """

    carrier: str
    loops: int
    length_m: float
    mass_g: float


@dataclass(frozen=True)
class KindOfTransfer:
    """Passes of transfers whose tightest loops are alike.

    Attributes
    ----------
    rack : in needles, to either side.
    passes, transfers : how many.
    line : the first of them in the program.
    tightest : None if no loop is pulled.
    """

    rack: float
    passes: int
    transfers: int
    line: int
    tightest: LoopTension | None

    def to_dict(self) -> dict[str, Any]:
        """Collect the figures by name."""
        return {**vars(self), "tightest": self.tightest and self.tightest.to_dict()}


@dataclass(frozen=True)
class ProgramReport:
    """The figures of a program on a machine.

    Attributes
    ----------
    machine : its name.
    knit_passes, transfer_passes, empty_passes : of the carriage; empty ones bring it back.
    transfers : loops that are transferred.
    rackings : of the bed.
    minutes : without stops.
    yarns : by carrier.
    cost : of yarn and machine; None without a price.
    tensions : passes of transfers, each with its tightest loop.
    time_source, tension_source : where times and tensions come from, in words.
    """

    machine: str
    knit_passes: int
    transfer_passes: int
    empty_passes: int
    transfers: int
    rackings: int
    minutes: float
    yarns: tuple[CarrierYarn, ...]
    cost: float | None
    tensions: tuple[PassTension, ...]
    time_source: str
    tension_source: str

    @property
    def passes(self) -> int:
        """All passes of the carriage."""
        return self.knit_passes + self.transfer_passes + self.empty_passes

    @property
    def time_note(self) -> str:
        """The sentence that says how sure the minutes are."""
        return f"Minutes are without stops; time of a pass: {self.time_source}."

    @property
    def tightest(self) -> PassTension | None:
        """The pass of transfers with the tightest loop."""
        return tightest_of(self.tensions)

    @property
    def kinds_of_transfer(self) -> tuple[KindOfTransfer, ...]:
        """Passes of transfers whose tightest loops are alike, the tightest first."""
        kinds: dict[tuple[float, LoopTension | None], list[PassTension]] = {}
        for step in self.tensions:
            kinds.setdefault((abs(step.rack), step.tightest), []).append(step)
        rows = [
            KindOfTransfer(rack, len(steps), sum(s.transfers for s in steps), steps[0].line, pull)
            for (rack, pull), steps in kinds.items()
        ]
        return tuple(sorted(rows, key=lambda row: -(row.tightest.tension_n if row.tightest else 0)))

    def to_dict(self) -> dict[str, Any]:
        """Collect the figures by name."""
        return {
            **vars(self),
            "passes": self.passes,
            "yarns": [vars(yarn) for yarn in self.yarns],
            "tensions": [step.to_dict() for step in self.tensions],
            "kinds_of_transfer": [kind.to_dict() for kind in self.kinds_of_transfer],
            "tightest": self.tightest and self.tightest.to_dict(),
        }


def program_report(
    program: str,
    machine: MachineProfile,
    yarn: LoopYarn,
    price_per_kg: float | None = None,
    price_per_hour: float | None = None,
    *,
    tex_of_carriers: Mapping[str, float] | None = None,
    looser: Mapping[float, LoopYarn] | None = None,
) -> ProgramReport:
    """Report the figures of a program on a machine.

    Parameters
    ----------
    program : in knitout.
    machine : gives the times of passes, transfers and rackings.
    yarn : of all carriers, with the loop length of all stitches.
    price_per_kg, price_per_hour : of yarn and of the machine, in any one currency.
    tex_of_carriers : linear densities of carriers with another yarn, g/km.
    looser : loops of stitch numbers other than the piece's.

    Raises
    ------
    InputError
        If a line of the program cannot be read, or a price is not positive.
    """
    reading = read_passes(program)
    empty = _empty_passes(reading, machine)
    seconds = sum(_seconds(step, machine) for step in reading.passes)
    width = max((step.high - step.low for step in reading.passes), default=0.0)
    seconds += empty * _travel_s(width, machine) + reading.rackings * machine.times.racking_s
    yarns = _yarns(reading, machine, yarn, tex_of_carriers or {})
    transfers = [step for step in reading.passes if step.kind == "transfer"]
    return ProgramReport(
        machine.name,
        len(reading.passes) - len(transfers),
        len(transfers),
        empty,
        sum(step.loops for step in transfers),
        reading.rackings,
        seconds / 60,
        yarns,
        _cost(yarns, seconds, price_per_kg, price_per_hour),
        pass_tensions(program, yarn, machine, looser),
        machine.source("times"),
        yarn.source,
    )


def hand_report(
    plan: HandPlan,
    piece: Piece,
    machine: MachineProfile,
    yarn: LoopYarn,
    price_per_kg: float | None = None,
    price_per_hour: float | None = None,
) -> ProgramReport:
    """Report the figures of a plan for a home machine, whose yarns stand for carriers.

    Parameters are those of :func:`program_report`.

    Raises
    ------
    InputError
        If a price is not positive.
    """
    yarns = tuple(
        CarrierYarn(f"{yarn_name(index)} ({of.name})", loops, metres, metres * yarn.tex / 1000)
        for index, of in enumerate(piece.yarns)
        for loops in [int(piece.cells(index).sum())]
        for metres in [loops * yarn.loop_length_mm / 1000]
    )
    return ProgramReport(
        machine.name,
        len(plan.rows),
        0,
        0,
        sum(len(task.needles) for task in plan.tasks),
        0,
        plan.minutes,
        yarns,
        _cost(yarns, plan.minutes * 60, price_per_kg, price_per_hour),
        (),
        f"{machine.source('times')}; work by hand: our guess for a practised knitter, without "
        "casting on and binding off",
        "nothing is racked",
    )


def _cost(
    yarns: Sequence[CarrierYarn],
    seconds: float,
    price_per_kg: float | None,
    price_per_hour: float | None,
) -> float | None:
    """Price of yarn and time; None if neither has a price."""
    for name, price in (("price_per_kg", price_per_kg), ("price_per_hour", price_per_hour)):
        if price is not None:
            check_positive(name, price, "a currency", "a price", 1e6)
    if price_per_kg is None and price_per_hour is None:
        return None
    return sum(of.mass_g for of in yarns) / 1000 * (price_per_kg or 0) + (
        seconds / 3600 * (price_per_hour or 0)
    )


def _travel_s(needles: float, machine: MachineProfile) -> float:
    way_mm = (needles + 2 * RUN_OUT_NEEDLES) * machine.pitch_mm
    return way_mm / 1000 / machine.times.carriage_speed_m_per_s + machine.times.turn_s


def _seconds(step: ProgramPass, machine: MachineProfile) -> float:
    more = machine.times.transfer_pass_s if step.kind == "transfer" else 0.0
    return _travel_s(step.high - step.low, machine) + more


def _empty_passes(reading: ProgramReading, machine: MachineProfile) -> int:
    """Passes that only bring the carriage to the side where the next one starts."""
    empty, at_right = 0, False
    for step in reading.passes:
        rightwards = not at_right if step.rightwards is None else step.rightwards
        empty += rightwards == at_right
        if not machine.tuck_with_knit:
            empty += 2 * step.changes  # back, and the same way again
        at_right = rightwards
    return empty


def _yarns(
    reading: ProgramReading,
    machine: MachineProfile,
    yarn: LoopYarn,
    tex_of_carriers: Mapping[str, float],
) -> tuple[CarrierYarn, ...]:
    yarns = []
    for carrier, loops in sorted(reading.loops.items()):
        columns = machine.needles_per_column
        floats = max(reading.float_needles[carrier] - loops * (columns - 1), 0)
        metres = (loops * yarn.loop_length_mm + floats * machine.pitch_mm) / 1000
        tex = tex_of_carriers.get(carrier, yarn.tex)
        yarns.append(CarrierYarn(carrier, loops, metres, metres * tex / 1000))
    return tuple(yarns)
