"""Bending, curl and shear of a repeat at the yarn level."""

from collections.abc import Iterator
from typing import Any, Literal

from pydantic import Field

from knitcore.chart.fabric import Direction
from knitcore.yarn.library.store import stored_for
from knitcore.yarn.loops.relaxed_stitches import StitchHistory, relax_stitches
from knitcore.yarn.loops.stitch_response import bend_stitches
from knitcore.yarn.study.bending import (
    MAX_STITCHES,
    Curl,
    RepeatBending,
    bending_length_mm,
    repeat_bending,
    weight_n_per_mm2,
)
from knitcore.yarn.study.relax import relax

from ...context import Context
from ...requests.base import ResultModel
from ...requests.fabrics import LawsRequest
from ...requests.stitches_at_rest import AnyStitchesRequest
from ...requests.yarn_level import YarnResult
from ..registry import Command, Operation

_FRICTIONLESS = (
    "Friction and set are left out, so these values are qualitative: measured knits of 187 to "
    "284 g/m² have rigidities of 0.007 to 0.10 N·mm."
)


class BendRequest(AnyStitchesRequest, LawsRequest):
    """A repeat and its yarn."""

    linear_density_g_per_m: float | None = Field(
        None,
        gt=0,
        le=100,
        description="Linear density of the yarn, g/m; needed for the bending lengths.",
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
        description="Strain across the bend per curvature, bent along the rows."
    )
    strain_across_wale_mm: float
    shear_modulus_n_per_mm: float | None = Field(
        description="Shear modulus; null where no stable state was found."
    )
    twist_n_mm: float | None = Field(
        description="Rigidity of twist D66; null, as is the coupling, without a stable state."
    )
    coupling_n_mm: float | None = Field(description="Coupling D1 of the two curvatures.")
    thickness_mm: float
    curl: str = Field(description="Curl of free edges, in words.")
    curl_course: Curl = Field(description="The way the sides curl.")
    curl_wale: Curl = Field(description="The way the top and bottom curl.")
    bending_length_course_mm: float | None = Field(
        description="Peirce's bending length of a strip cut along the rows; null where the weight "
        "is not known."
    )
    bending_length_wale_mm: float | None
    stable: bool = Field(
        description="True if the state is still a minimum when it may lose its symmetries."
    )
    provenance: str
    yarn: YarnResult
    notes: list[str]


def bend(request: BendRequest, context: Context) -> BendResult:
    """Bending rigidity, curl and shear of the repeat, relaxed with the chart's symmetries and
    compared with the minimum that it goes to without them. Those of the packaged repeats are
    stored. Other stitches than knits and purls are bent as they rest without friction, unless their
    cloth folds then.

    Raises
    ------
    InputError
        If the repeat is too large.
    ConvergenceError
        If no stable state is found.
    """
    stitches = request.others()
    repeat = request.repeat(MAX_STITCHES) if stitches is None else stitches.plain
    used = request.yarn(repeat, context)
    loop = used.loop_length_mm
    stored = None if stitches is not None else stored_for(repeat, used)
    caution: tuple[str, ...] = ()
    if stitches is not None:
        request.check_parts(context)
        rest = request.pass_to(
            relax_stitches, stitches, used.yarn, loop, history=StitchHistory.AGITATED,
            cancelled=context.cancelled,
        )  # fmt: skip
        bending, whence = RepeatBending(None, bend_stitches(rest)), ""
        area, caution = rest.cell_course_mm * rest.cell_wale_mm, rest.notes
        loop = float(rest.loop_lengths_mm.mean())
    elif stored is not None and stored.bending is not None:
        bending, whence = stored.bending, ", stored"
        area = stored.cell_course_mm * stored.cell_wale_mm
    else:
        relaxed = relax(repeat, used.yarn, loop, branch="mirrored", cancelled=context.cancelled)
        bending, whence = repeat_bending(relaxed, cancelled=context.cancelled), ""
        area = relaxed.cell_course_mm * relaxed.cell_wale_mm
    shown, stable = bending.shown, bending.stable
    notes = [_FRICTIONLESS, *caution, *_failures(bending), *_compared(bending)]
    density = request.linear_density_g_per_m
    weight = None if density is None else weight_n_per_mm2(density, loop, area)
    if not stable.minimum:
        notes.append(
            "Its shape is not quite a minimum, as a slight change lowers the energy a little: "
            "twist, coupling, shear and bending along diagonals are left out."
        )
    shear = stable.shear_modulus_n_per_mm
    if shear is not None and shear <= 0.0:
        notes.append("The courses slide over each other freely: the shear modulus is not positive.")
    if stable.oblique is not None and min(d.rigidity_n_mm for d in stable.oblique) <= 0.0:
        notes.append("It folds by itself along a diagonal: the rigidity there is not positive.")
    if stable.twist_n_mm is not None and stable.twist_n_mm <= 0.0:
        notes.append("A strip of it twists by itself: the rigidity of twist is not positive.")
    by_direction: dict[str, Any] = {}
    for direction in Direction:
        bent = direction.of(shown.course, shown.wale)
        by_direction |= {
            f"moment_{direction}_n": bent.moment_n,
            f"bending_{direction}_n_mm": bent.rigidity_n_mm,
            f"bending_held_{direction}_n_mm": bent.held_n_mm,
            f"strain_across_{direction}_mm": bent.strain_across_mm,
            f"bending_length_{direction}_mm": weight
            and bending_length_mm(bent.rigidity_n_mm, weight),
        }
    symmetry = "with" if bending.mirrored is not None else "without"
    return BendResult.of(
        shown,
        **by_direction,
        shear_modulus_n_per_mm=shear,
        twist_n_mm=stable.twist_n_mm,
        coupling_n_mm=stable.coupling_n_mm,
        stable=shown.minimum,
        provenance="yarn level, linear response of the repeat, relaxed "
        f"{symmetry} the symmetries of its chart{whence}; yarn: {used.provenance}",
        yarn=YarnResult.of_chart(used),
        notes=notes,
    )


def _failures(bending: RepeatBending) -> Iterator[str]:
    """Notes on what could not be bent."""
    if bending.failure:
        yield f"With the symmetries of the chart: {bending.failure}"
    if bending.unmirrored_failure:
        yield f"Without them: {bending.unmirrored_failure}"


def _compared(bending: RepeatBending) -> Iterator[str]:
    """Notes where the state without symmetries differs."""
    if bending.unmirrored is None:
        return
    for direction, factor in bending.far_apart.items():
        free = direction.of(bending.unmirrored.course, bending.unmirrored.wale)
        way = direction.of("along the rows", "along the columns")
        yield (
            f"Bent {way}, the rigidity without the symmetries of the chart is "
            f"{free.rigidity_n_mm:.3g} N·mm, which differs by a factor of {factor:.1f}: treat it "
            "as a range."
        )


def _rigidity(value_n_mm: float | None) -> str:
    return "unknown" if value_n_mm is None else f"{value_n_mm:.4f} N·mm"


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
        f"twist           {_rigidity(r.twist_n_mm)} (D66)",
        f"coupling        {_rigidity(r.coupling_n_mm)} (D1, between the two curvatures)",
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
    command=Command(_lines, more="Its shear modulus comes with them; all are without friction."),
)
