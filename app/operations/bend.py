"""Bending, curl and shear of a repeat at the yarn level."""

from __future__ import annotations

from typing import Literal

from pydantic import Field
from scipy.constants import g as STANDARD_GRAVITY  # noqa: N812 - a constant

from app.context import Context
from app.models.base import ResultModel
from app.models.laws import LawsRequest
from app.models.yarn_level import StitchRequest, YarnResult
from app.operations.registry import Command, Operation
from knitcore.errors import ConvergenceError, UnravelledError
from knitcore.yarnlevel.bending import (
    MAX_STITCHES,
    Curl,
    FabricBending,
    bending_length_mm,
    bending_response,
)
from knitcore.yarnlevel.bent_cell import BendingResponse
from knitcore.yarnlevel.relax import Branch, OnSplines, RelaxedRepeat, relax

COMPARED_UP_TO = 9
"""Repeats of up to this many stitches are also relaxed without symmetry, for comparison."""
FAR_APART = 1.5
"""A note is added where the two states differ by this factor or more."""
_FRICTIONLESS = (
    "Without friction and set, so qualitative: measured knits of 187 to 284 g/m² have rigidities "
    "of .007 to .10 N·mm."
)


class BendRequest(StitchRequest, LawsRequest):
    """A repeat and its yarn."""

    linear_density_g_per_m: float | None = Field(
        None, gt=0, le=100, description="Of the yarn; needed for the bending lengths."
    )


class BendResult(ResultModel):
    """Linear response of the relaxed repeat; course: bent along the rows."""

    kind: Literal["bend"] = "bend"
    moment_course_n: float = Field(
        description="Derivative of the energy per area by the curvature, N·mm per mm of width. "
        "Negative: left alone, the fabric curves with its face outside."
    )
    moment_wale_n: float
    bending_course_n_mm: float = Field(
        description="Bending rigidity, with the size across free to change."
    )
    bending_wale_n_mm: float
    bending_held_course_n_mm: float = Field(
        description="Bending rigidity, with the size across held."
    )
    bending_held_wale_n_mm: float
    strain_across_course_mm: float = Field(
        description="Strain across per curvature, bent along the rows."
    )
    strain_across_wale_mm: float
    shear_modulus_n_per_mm: float | None = Field(
        description="Null where no stable state was found."
    )
    twist_n_mm: float | None = Field(description="D1 + 2 D66, from bending at 45°.")
    thickness_mm: float
    curl: str = Field(description="How free edges curl.")
    curl_course: Curl = Field(description="The way the sides curl.")
    curl_wale: Curl = Field(description="The way the top and bottom curl.")
    bending_length_course_mm: float | None = Field(
        description="Peirce's, of a strip cut along the rows; null where the weight is not known."
    )
    bending_length_wale_mm: float | None
    stable: bool = Field(
        description="Whether the state is still a minimum when it may lose its symmetries."
    )
    provenance: str
    yarn: YarnResult
    notes: list[str]


def bend(request: BendRequest, context: Context) -> BendResult:
    """Bending rigidity, curl and shear of the repeat, relaxed with the chart's symmetries and
    compared with a relaxation without them.

    Raises
    ------
    InputError
        If the repeat is too large.
    ConvergenceError
        If no stable state is found.
    """
    repeat = request.repeat(MAX_STITCHES)
    used = request.yarn(repeat, context)
    loop = used.loop_length_mm

    def relaxed(branch: OnSplines) -> RelaxedRepeat:
        return relax(repeat, used.yarn, loop, branch=branch, cancelled=context.cancelled)

    mirrored = relaxed(Branch.MIRRORED)
    notes = [_FRICTIONLESS]
    found = free = None
    try:
        found = bending_response(mirrored)
    except ConvergenceError as error:
        notes.append(f"With the symmetries of the chart: {error}")
    if found is None or (not found.minimum and repeat.stitches <= COMPARED_UP_TO):
        try:
            free = bending_response(relaxed(Branch.FREE))
        except (ConvergenceError, UnravelledError) as error:
            notes.append(f"Without them: {error}")
    shown = found or free
    if shown is None:
        raise ConvergenceError(" ".join(notes[1:]))
    branch = "mirrored" if shown is found else "free"
    notes += _compared(found, free)
    stable = free if free is not None and not shown.minimum else shown
    density = request.linear_density_g_per_m
    area = mirrored.cell_course_mm * mirrored.cell_wale_mm
    weight = None if density is None else 1e-6 * STANDARD_GRAVITY * density * loop / area  # N/mm²
    shear = stable.shear_modulus_n_per_mm
    if shear is not None and shear <= 0.0:
        notes.append("The courses slide over each other freely: the shear modulus is not positive.")
    return BendResult.of(
        shown,
        moment_course_n=shown.course.moment_n,
        moment_wale_n=shown.wale.moment_n,
        bending_course_n_mm=shown.course.rigidity_n_mm,
        bending_wale_n_mm=shown.wale.rigidity_n_mm,
        bending_held_course_n_mm=shown.course.held_n_mm,
        bending_held_wale_n_mm=shown.wale.held_n_mm,
        strain_across_course_mm=shown.course.strain_across_mm,
        strain_across_wale_mm=shown.wale.strain_across_mm,
        shear_modulus_n_per_mm=shear,
        twist_n_mm=stable.twist_n_mm,
        bending_length_course_mm=_hanging(shown.course, weight),
        bending_length_wale_mm=_hanging(shown.wale, weight),
        stable=shown.minimum,
        provenance=f"yarn level, linear response of the relaxed repeat ({branch} branch); yarn: "
        f"{used.provenance}",
        yarn=YarnResult.of(used, used.yarn),
        notes=notes,
    )


def _hanging(response: BendingResponse, weight_n_per_mm2: float | None) -> float | None:
    if weight_n_per_mm2 is None:
        return None
    return bending_length_mm(response.rigidity_n_mm, weight_n_per_mm2)


def _compared(mirrored: FabricBending | None, free: FabricBending | None) -> list[str]:
    """A note where the state without symmetries differs."""
    if mirrored is None or free is None:
        return []
    both = {
        "along the rows": (mirrored.course.rigidity_n_mm, free.course.rigidity_n_mm),
        "along the columns": (mirrored.wale.rigidity_n_mm, free.wale.rigidity_n_mm),
    }
    return [
        f"Bent {way}, the rigidity is {second:.3g} N·mm without the symmetries of the chart, "
        f"{max(first / second, second / first):.1f} times apart: treat it as a range."
        for way, (first, second) in both.items()
        if max(first / second, second / first) > FAR_APART
    ]


def _lines(r: BendResult) -> list[str]:
    shear = (
        "unknown" if r.shear_modulus_n_per_mm is None else f"{r.shear_modulus_n_per_mm:.4f} N/mm"
    )
    lines = [
        "                          along rows  along columns",
        f"curling moment [N]        {r.moment_course_n:10.4f} {r.moment_wale_n:14.4f}",
        f"bending rigidity [N·mm]   {r.bending_course_n_mm:10.4f} {r.bending_wale_n_mm:14.4f}",
        f"  other size held [N·mm]  {r.bending_held_course_n_mm:10.4f} "
        f"{r.bending_held_wale_n_mm:14.4f}",
    ]
    if r.bending_length_course_mm is not None and r.bending_length_wale_mm is not None:
        lines.append(
            f"bending length [mm]       {r.bending_length_course_mm:10.1f} "
            f"{r.bending_length_wale_mm:14.1f}"
        )
    return [
        *lines,
        f"shear modulus   {shear}",
        f"thickness       {r.thickness_mm:.2f} mm",
        f"free edges      {r.curl}",
        f"source          {r.provenance}",
    ]


OPERATION = Operation(
    bend,
    tag="yarn level",
    summary="Bending, curl and shear of a repeat at the yarn level",
    example={"chart": "K", "material": "acrylic"},
    job=True,
    command=Command(
        _lines, help="Bending rigidity, curl and shear of the repeat CHART, without friction."
    ),
)
