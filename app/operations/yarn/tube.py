"""A repeat relaxed in the round: a long tube with a given number of wales."""

from typing import Literal

from pydantic import Field

from knitcore.materials.law_uncertainty import (
    YARN_LEVEL_ERRORS,
    YARN_LEVEL_SIZE_LOG_SD,
    log_interval,
)
from knitcore.yarn.study.bending import MAX_STITCHES
from knitcore.yarn.study.lowest import lowest
from knitcore.yarn.study.relax import relax
from knitcore.yarn.study.yarn_tube import MAX_WALES, MIN_WALES, in_the_round

from ...context import Context
from ...requests.base import Ends, IntervalResult
from ...requests.yarn_level import StitchRequest, YarnResult
from ..registry import Command, Operation


class TubeRequest(StitchRequest):
    """A repeat, its yarn, and how many stitches go around."""

    wales: int = Field(
        ge=MIN_WALES,
        le=MAX_WALES,
        description="Stitches around, a multiple of the repeat's columns.",
    )
    face_outside: bool = Field(True, description="Knit the tube with its face outside.")


class TubeResult(IntervalResult):
    """A tube free of force, and the same repeat as a flat fabric."""

    kind: Literal["tube"] = "tube"
    wales: int
    face_outside: bool
    diameter_mm: float = Field(
        description="Diameter of the surface at the mean height of the yarn."
    )
    diameter_interval_mm: Ends = Field(description="90 % interval for knitted cloth.")
    cell_course_mm: float = Field(description="Width of a stitch, around on that surface.")
    cell_course_interval_mm: Ends
    cell_wale_mm: float = Field(description="Height of a stitch.")
    cell_wale_interval_mm: Ends
    energy_n_mm: float = Field(description="Energy of a stitch.")
    flat_course_mm: float = Field(description="Width of a stitch of the flat fabric.")
    flat_wale_mm: float
    flat_energy_n_mm: float
    yarn: YarnResult
    notes: list[str]


def tube(request: TubeRequest, context: Context) -> TubeResult:
    """Relax a repeat in the round: sizes and energy of a stitch of a long tube, free of force.

    Courses are closed rings, and the tube's ends are left out.

    Raises
    ------
    InputError
        If the repeat is too large or does not go around a whole number of times.
    ConvergenceError, UnravelledError
        If the repeat is not in equilibrium without its symmetries, or no shape is found on the
        way to the tube.
    """
    repeat = request.repeat(MAX_STITCHES)
    used = request.yarn(repeat, context)
    flat = relax(
        repeat, used.yarn, used.loop_length_mm, branch="mirrored", cancelled=context.cancelled
    )
    round_cell = request.pass_to(in_the_round, flat, cancelled=context.cancelled)
    leads_to = lowest(flat, cancelled=context.cancelled)
    notes = list(leads_to.notes)
    if leads_to.mirrored is not None:
        notes.append(
            "The tube is of the mirrored shape, which is no minimum: without its mirror symmetries "
            f"the flat repeat has {leads_to.energy_n_mm:.4f} N·mm a stitch, with them "
            f"{flat.energy_n_mm:.4f}."
        )
    around, up, across = (
        log_interval(size, YARN_LEVEL_SIZE_LOG_SD)
        for size in (round_cell.cell_course_mm, round_cell.cell_wale_mm, round_cell.diameter_mm)
    )
    return TubeResult.of(
        round_cell,
        cell_course_interval_mm=around,
        cell_wale_interval_mm=up,
        diameter_interval_mm=across,
        interval_source=YARN_LEVEL_ERRORS,
        yarn=YarnResult.of_chart(used),
        notes=notes,
    )


def _lines(r: TubeResult) -> list[str]:
    side = "face" if r.face_outside else "back"
    thick, wide, high = r.diameter_interval_mm, r.cell_course_interval_mm, r.cell_wale_interval_mm
    wider, higher = (
        f"{100 * (size / flat - 1):+.1f} %"
        for size, flat in ((r.cell_course_mm, r.flat_course_mm), (r.cell_wale_mm, r.flat_wale_mm))
    )
    return [
        f"tube            {r.wales} stitches around, its {side} outside",
        f"diameter        {r.diameter_mm:.1f} mm ({thick[0]:.0f} to {thick[1]:.0f})",
        f"stitch          {r.cell_course_mm:.3f} mm wide ({wide[0]:.2f} to {wide[1]:.2f}), "
        f"{r.cell_wale_mm:.3f} mm high ({high[0]:.2f} to {high[1]:.2f})",
        f"against flat    {wider} in width, {higher} in height",
        f"energy          {r.energy_n_mm:.4f} N·mm a stitch, flat {r.flat_energy_n_mm:.4f}",
    ]


OPERATION = Operation(
    tube,
    tag="yarn level",
    summary="Relax a repeat in the round",
    example={"chart": "K", "material": "acrylic", "wales": 60},
    job=True,
    command=Command(_lines, more="The tube is long, has --wales stitches around, and no friction."),
)
