"""Loading, unloading and rest sizes of a repeat with friction between its yarns."""

from collections.abc import Iterable
from typing import Literal

from pydantic import Field

from knitcore.chart.fabric import Direction
from knitcore.yarn.library.yarns import yarn_friction
from knitcore.yarn.solve.friction import MAX_COEFFICIENT, MAX_STITCHES
from knitcore.yarn.study import hysteresis as loops
from knitcore.yarn.study.hysteresis import DEFAULT_POINTS, MAX_CYCLES
from knitcore.yarn.study.relax import relax

from ...context import Context
from ...requests.base import Ends, Floats, IntervalResult, ResultModel
from ...requests.fabrics import LawsRequest
from ...requests.yarn_level import HISTORIES, RestSizeResult, StitchRequest, YarnResult, rest_line
from ..registry import Command, Operation


class HysteresisRequest(StitchRequest, LawsRequest):
    """A repeat, its yarn and the pull."""

    direction: Direction = Field(
        Direction.COURSE, description="Direction of the pull: along rows, or along columns."
    )
    max_strain: float = Field(0.3, gt=0, le=5, description="Largest strain: 0.5 is 50 %.")
    friction: float | None = Field(
        None,
        ge=0,
        le=MAX_COEFFICIENT,
        description="Coefficient of friction between yarns; that of the fibre by default.",
    )
    points: int = Field(DEFAULT_POINTS, ge=2, le=200, description="Number of strains in loading.")
    cycles: int = Field(2, ge=1, le=MAX_CYCLES)
    rest_sizes: bool = Field(True, description="Also find the rest size after every history.")
    intervals: bool = Field(
        True,
        description="Also pull with the ends of the interval of friction, in three times the time.",
    )


class LoopLeg(ResultModel):
    """Loading or unloading: half of a cycle."""

    loading: bool
    strain: Floats = Field(description="Strain, from the rest size without friction.")
    transverse_strain: Floats
    stress_n_per_mm: Floats


class HysteresisResult(IntervalResult):
    """Cycles of loading and unloading, the energy that they lose, and the sizes at rest."""

    kind: Literal["hysteresis"] = "hysteresis"
    direction: Direction
    friction: float = Field(description="Coefficient of friction that was used.")
    friction_interval: tuple[float, float] | None = Field(
        description="Interval of the yarn or its fibre; null if the request gave the coefficient."
    )
    friction_source: str
    legs: list[LoopLeg] = Field(description="Legs of the cycles, loading and unloading in turn.")
    lost_per_cycle_n_per_mm: float = Field(
        description="Energy that the last cycle loses per area of fabric, N·mm/mm²."
    )
    lost_per_cycle_interval_n_per_mm: Ends | None = Field(
        None,
        description="Interval of the loss over that of friction, as are all further intervals.",
    )
    lost_share: float = Field(description="Energy lost, as a share of the work of the pull.")
    lost_share_interval: Ends | None = None
    left_strain: float = Field(description="Strain that remains after unloading.")
    left_strain_interval: Ends | None = None
    closes_within: float = Field(
        description="Change of the greatest stress from the first cycle to the last, as a part of "
        "the first."
    )
    rest_sizes: list[RestSizeResult]
    yarn: YarnResult
    notes: list[str]


def hysteresis(request: HysteresisRequest, context: Context) -> HysteresisResult:
    """Stress of the repeat in loading and unloading, with dry friction between its yarns, the
    energy that a cycle loses, and the range of sizes at which it may rest.

    Raises
    ------
    InputError
        If the repeat is too large.
    ConvergenceError, UnravelledError
        If the yarn locks in the first step, or unravels on the way to a rest size.
    """
    repeat = request.repeat(MAX_STITCHES)
    used = request.yarn(repeat, context)
    known = yarn_friction(context.material(request.material))
    given = request.friction
    coefficient = known.coefficient if given is None else given
    relaxed = relax(
        repeat, used.yarn, used.loop_length_mm, branch="mirrored", cancelled=context.cancelled
    )

    def rubbed(friction: float) -> tuple[loops.Hysteresis, tuple[loops.RestSize, ...]]:
        loop = request.pass_to(
            loops.hysteresis, relaxed, coefficient=friction, cancelled=context.cancelled
        )
        if not request.rest_sizes:
            return loop, ()
        return loop, loops.rest_sizes(relaxed, friction, cancelled=context.cancelled)

    loop, rests = rubbed(coefficient)
    varied = request.intervals and given is None and known.low < known.high
    runs = [(loop, rests), rubbed(known.low), rubbed(known.high)] if varied else []
    return HysteresisResult.of(
        loop,
        friction=coefficient,
        friction_interval=(known.low, known.high) if given is None else None,
        interval_source=f"The interval of friction, {known.source}."
        if given is None
        else "No intervals: the request gave the coefficient of friction.",
        friction_source=known.source if given is None else "given",
        legs=[LoopLeg.of(leg) for leg in loop.legs],
        lost_per_cycle_interval_n_per_mm=_ends(h.lost_per_cycle_n_per_mm for h, _ in runs),
        lost_share_interval=_ends(h.lost_share for h, _ in runs),
        left_strain_interval=_ends(h.left_strain for h, _ in runs),
        rest_sizes=[
            RestSizeResult.of(
                rest,
                course_interval_mm=_ends(sizes[k].course_mm for _, sizes in runs),
                wale_interval_mm=_ends(sizes[k].wale_mm for _, sizes in runs),
            )
            for k, rest in enumerate(rests)
        ],
        yarn=YarnResult.of_chart(used),
        notes=[*loop.notes, HISTORIES],
    )


def _ends(values: Iterable[float]) -> Ends | None:
    numbers = list(values)
    return (min(numbers), max(numbers)) if numbers else None


def _between(interval: Ends | None, form: str) -> str:
    return "" if interval is None else f" [{interval[0]:{form}}, {interval[1]:{form}}]"


def _text(r: HysteresisResult) -> list[str]:
    lines = [
        f"friction            {r.friction:.2f}{_between(r.friction_interval, '.2f')} "
        f"({r.friction_source})",
        f"{'':20}there         back",
    ]
    there, back = r.legs[-2], r.legs[-1]
    for strain, stress in zip(there.strain, there.stress_n_per_mm, strict=True):
        held = [
            s
            for e, s in zip(back.strain, back.stress_n_per_mm, strict=True)
            if abs(e - strain) < 1e-6
        ]
        again = f"{held[0]:10.4f}" if held else " " * 9 + "-"
        lines.append(f"strain {strain:8.3f}   {stress:10.4f}   {again} N/mm")
    lines += [
        f"lost in a cycle     {r.lost_per_cycle_n_per_mm:.4g} N·mm/mm², "
        f"{r.lost_share:.0%}{_between(r.lost_share_interval, '.0%')} of the work",
        f"remaining strain    {r.left_strain:.3f}{_between(r.left_strain_interval, '.3f')}",
    ]
    for rest in r.rest_sizes:
        lines.append(
            f"{rest_line(rest)}{_between(rest.course_interval_mm, '.2f')}"
            f"{_between(rest.wale_interval_mm, '.2f')}"
        )
    return lines


OPERATION = Operation(
    hysteresis,
    tag="yarn level",
    summary="Loading, unloading and rest sizes of a repeat with friction",
    example={"chart": "K", "material": "acrylic", "points": 4, "rest_sizes": False},
    job=True,
    command=Command(_text, more="The result has the loop, the energy lost and the sizes at rest."),
)
