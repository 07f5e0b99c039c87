"""Stretching a repeat at the yarn level, and fitting a law to it."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from app.command_options import loop_lengths
from app.context import Context
from app.models.base import EndsOfList, Floats, IntervalResult
from app.models.laws import ElasticConstants
from app.models.yarn_level import YarnLevelRequest, YarnResult, kept_or_made, relax_requested
from app.operations.registry import Command, Operation
from knitcore.chart import StitchChart
from knitcore.errors import KnitcoreError
from knitcore.fabric import Direction
from knitcore.materials.uncertainty import (
    YARN_LEVEL_ERRORS,
    YARN_LEVEL_STRAIN_LOG_SD,
    log_interval,
)
from knitcore.yarnlevel.relax import Branch
from knitcore.yarnlevel.results import Sweep
from knitcore.yarnlevel.sweep import sweep as swept
from knitcore.yarnlibrary.lawfit import MAX_STRESS_N_PER_MM, SimulatedLaw, fit_sweeps
from knitcore.yarnlibrary.yarns import ChartYarn

FACTOR = log_interval(1.0, YARN_LEVEL_STRAIN_LOG_SD).high
"""Of strains of knitted cloth either way, 90 %."""
_FAR_STRAIN = {Direction.COURSE: 3.5, Direction.WALE: 2.5}
"""Largest strain of the stretch across, which the law also needs; a stress may end it before."""
_FAR_POINTS = 60


class SweepRequest(YarnLevelRequest):
    """A repeat, its yarn and the stretch."""

    direction: Direction = Field(description="Along rows, or along columns.")
    max_strain: float = Field(gt=0, le=20, description="Largest strain: 0.5 is 50 %.")
    points: int = Field(25, ge=2, le=400)
    slide_quenching: bool = Field(
        False,
        description="Keep the yarn from sliding where it touches at rest. The published branch "
        "does so for seed along the course, as the paper did, and has no other setting.",
    )


class SweptLaw(ElasticConstants):
    """Constitutive law fitted to the stretches along and across (N/mm)."""

    stiffness_xxxx: float
    stiffness_yyyy: float
    stiffness_xxyy: float
    stiffness_yyxx: float
    alpha_xx: float
    alpha_yy: float
    beta_xx: float
    beta_yy: float
    max_stress_n_per_mm: float = Field(description="Upper end of the fitted range of stress.")
    largest_strain_course: float
    largest_strain_wale: float
    rms_course_n_per_mm: float
    rms_wale_n_per_mm: float


class SweepResult(IntervalResult):
    """A stretch, free across; sizes and energies of one stitch."""

    kind: Literal["sweep"] = "sweep"
    direction: Direction
    branch: Branch
    strain: Floats
    strain_interval: EndsOfList = Field(description="Of knitted cloth, at each stress.")
    transverse_strain: Floats
    stress_n_per_mm: Floats
    energy_n_mm: Floats
    bending_share: Floats
    contact_share: Floats
    jumps: list[int] = Field(description="Points at which the shape changes abruptly.")
    cell_course_mm: float = Field(description="Relaxed size of one stitch.")
    cell_wale_mm: float
    law: SweptLaw | None
    converged: bool
    seconds: float = Field(description="CPU time of the solves, when they were first run.")
    known: bool = Field(False, description="Whether the result was already stored.")
    yarn: YarnResult
    notes: list[str]


def sweep(request: SweepRequest, context: Context) -> SweepResult:
    """Stress-strain curve and fitted law of the repeat; stops when the caller disconnects.

    The law also needs the stretch across. A stretch that was run before is returned from storage.
    """
    return kept_or_made(SweepResult, request, context, _result)


def _result(
    request: SweepRequest, repeat: StitchChart, used: ChartYarn, context: Context
) -> SweepResult:
    zero = relax_requested(repeat, used, request, context)

    def stretch(
        direction: Direction, max_strain: float, points: int, max_stress: float | None = None
    ) -> Sweep:
        return swept(
            zero,
            direction,
            max_strain,
            points=points,
            max_stress_n_per_mm=max_stress,
            slide_quenching=request.slide_quenching or None,
            cancelled=context.cancelled,
        )

    main = stretch(request.direction, request.max_strain, request.points)
    notes, seconds = list(main.notes), zero.seconds + main.seconds
    law: SimulatedLaw | None = None
    try:
        both = {}
        for d in Direction:
            both[d] = stretch(d, _FAR_STRAIN[d], _FAR_POINTS, 1.2 * MAX_STRESS_N_PER_MM)
            seconds += both[d].seconds
        law = fit_sweeps(both[Direction.COURSE], both[Direction.WALE])
        notes += [note for found in both.values() for note in _jumps_fitted(found, law)]
    except KnitcoreError as error:
        if context.cancelled():
            raise
        notes.append(f"No law could be fitted: {error}")
    return SweepResult.of(
        main,
        zero,
        request,
        strain_interval=(main.strain / FACTOR, main.strain * FACTOR),
        interval_source=YARN_LEVEL_ERRORS,
        law=None if law is None else SweptLaw.of(law, law.law),
        converged=main.converged and len(main.strain) == request.points,
        seconds=seconds,
        yarn=YarnResult.of(used, used.yarn),
        notes=notes,
    )


def _jumps_fitted(stretch: Sweep, law: SimulatedLaw) -> list[str]:
    fitted = [i for i in stretch.jumps if stretch.stress_n_per_mm[i] <= law.max_stress_n_per_mm]
    if not fitted:
        return []
    return [
        f"The law is a smooth curve through {len(fitted)} abrupt change(s) of shape along the "
        f"{stretch.direction}."
    ]


def _lines(r: SweepResult) -> list[str]:
    columns = zip(r.strain, r.transverse_strain, r.stress_n_per_mm, r.energy_n_mm, strict=True)
    lines = ["strain   across   stress N/mm   energy N·mm"]
    lines += [f"{a:6.3f}  {b:7.3f}  {c:11.5f}  {d:12.5f}" for a, b, c, d in columns]
    if r.law is not None:
        lines.append(
            f"law up to {r.law.max_stress_n_per_mm:g} N/mm: Y course "
            f"{r.law.modulus_course_n_per_mm:.4f}, wale {r.law.modulus_wale_n_per_mm:.4f} N/mm, "
            f"Poisson yx {r.law.poisson_yx:.3f}, xy {r.law.poisson_xy:.3f}"
        )
    return [
        *lines,
        f"90 % interval of the strains of knitted cloth: a factor of {FACTOR:.1f} either way.",
    ]


OPERATION = Operation(
    sweep,
    tag="yarn level",
    summary="Stretch a repeat at the yarn level",
    example={
        "chart": "K\nP",
        "material": "acrylic",
        "direction": "wale",
        "max_strain": 0.1,
        "points": 3,
    },
    job=True,
    command=Command(
        _lines,
        help="Stretch the repeat CHART at the yarn level, free across, and fit its law.",
        names={"loop_lengths_mm": None},
        fields=loop_lengths,
    ),
)
