"""Stretching a repeat at the yarn level and the law fitted to it."""

from __future__ import annotations

import math
from typing import Any

from pydantic import BaseModel, ConfigDict, Field

from app.models.charts import ChartInput
from app.operations.relax import (
    Cancelled,
    YarnLevelOptions,
    YarnResult,
    asked_chart,
    cell_chart,
    chart_yarn,
    pure_fabric,
    relaxed_cell,
    what_decides,
    yarn_result,
)
from app.results.on_disk import KeptResults
from app.results.own_materials import find_material
from knitcore.chart import StitchChart
from knitcore.errors import InputError, KnitcoreError
from knitcore.fabric import Direction
from knitcore.materials import Material
from knitcore.yarnlevel.published.sweep import sweep_published
from knitcore.yarnlevel.relax import Branch, RelaxedRepeat
from knitcore.yarnlevel.results import RelaxedCell, Sweep
from knitcore.yarnlevel.sweep import sweep
from knitcore.yarnlibrary.lawfit import MAX_STRESS_N_PER_MM, SimulatedLaw, fit_law
from knitcore.yarnlibrary.yarns import ChartYarn

_FAR_STRAIN = {Direction.COURSE: 3.5, Direction.WALE: 2.5}
"""Where the stretch across, which the law needs too, ends unless its stress ends it before."""
_FAR_POINTS = 60


class SweepOptions(YarnLevelOptions):
    """How a repeat is stretched."""

    direction: Direction
    max_strain: float = Field(gt=0, le=20, allow_inf_nan=False)
    points: int = Field(25, ge=2, le=400)
    slide_quenching: bool = Field(
        False,
        description="Keep the yarn from sliding where it touches at rest. The published branch "
        "does so for seed along the course, as the paper did, and takes no other wish.",
    )


class SweepRequest(SweepOptions):
    """A repeat, its yarn and the stretch."""

    chart: ChartInput
    material: str = Field(max_length=80)


class LawResult(BaseModel):
    """Constitutive law fitted to the stretches along and across (N/mm)."""

    model_config = ConfigDict(extra="forbid")

    stiffness_xxxx: float
    stiffness_yyyy: float
    stiffness_xxyy: float
    stiffness_yyxx: float
    alpha_xx: float
    alpha_yy: float
    beta_xx: float
    beta_yy: float
    modulus_course_n_per_mm: float
    modulus_wale_n_per_mm: float
    poisson_yx: float
    poisson_xy: float
    max_stress_n_per_mm: float = Field(description="Upper end of the fitted range of stress.")
    largest_strain_course: float
    largest_strain_wale: float
    rms_course_n_per_mm: float
    rms_wale_n_per_mm: float


class SweepResult(BaseModel):
    """A stretch, free across; sizes and energies of one stitch."""

    direction: Direction
    branch: Branch
    strain: list[float]
    transverse_strain: list[float]
    stress_n_per_mm: list[float]
    energy_n_mm: list[float]
    bending_share: list[float]
    contact_share: list[float]
    jumps: list[int] = Field(description="Points at which the shape changes abruptly.")
    cell_course_mm: float = Field(description="Relaxed size of one stitch.")
    cell_wale_mm: float
    law: LawResult | None
    converged: bool
    seconds: float = Field(description="CPU time of the solves, whenever they were.")
    known: bool = Field(False, description="Whether it had been computed before.")
    yarn: YarnResult
    notes: list[str]


def run_sweep(request: SweepRequest, *, cancelled: Cancelled) -> SweepResult:
    """Stretch for the service."""
    chart, material = asked_chart(request.chart, request), find_material(request.material)
    return sweep_chart(chart, material, request, cancelled=cancelled)


def sweep_chart(
    chart: StitchChart,
    material: Material,
    options: SweepOptions,
    *,
    cancelled: Cancelled | None = None,
) -> SweepResult:
    """Stretch a chart's repeat along a direction, or say what is known of it.

    The law also needs the stretch across.
    """
    repeat = cell_chart(chart, options)
    used = chart_yarn(material, repeat, options)
    result, known = KeptResults.of_user().get_or_make(
        SweepResult,
        what_decides(repeat, used, options),
        lambda: _swept(repeat, used, options, cancelled),
        fresh=options.fresh,
    )
    return result.model_copy(update={"known": known})


def _swept(
    repeat: StitchChart, used: ChartYarn, options: SweepOptions, cancelled: Cancelled | None
) -> SweepResult:
    zero = relaxed_cell(repeat, used, options, cancelled)
    along = options.direction
    main = _sweep(repeat, used, zero, options, along, options.max_strain, options.points,
                  None, cancelled)  # fmt: skip
    notes = list(main.notes)
    law: SimulatedLaw | None = None
    seconds = zero.seconds + main.seconds
    try:
        both = {}
        for direction in Direction:
            both[direction] = _sweep(
                repeat, used, zero, options, direction, _FAR_STRAIN[direction], _FAR_POINTS,
                1.2 * MAX_STRESS_N_PER_MM, cancelled,
            )  # fmt: skip
            seconds += both[direction].seconds
        law = fit_law(both[Direction.COURSE], both[Direction.WALE])
        notes += [note for stretch in both.values() for note in _jumps_fitted(stretch, law)]
    except KnitcoreError as error:
        if cancelled is not None and cancelled():
            raise
        notes.append(f"No law could be fitted: {error}")
    return SweepResult(
        direction=along,
        branch=options.branch,
        strain=main.strain.tolist(),
        transverse_strain=main.transverse_strain.tolist(),
        stress_n_per_mm=main.stress_n_per_mm.tolist(),
        energy_n_mm=main.energy_n_mm.tolist(),
        bending_share=main.bending_share.tolist(),
        contact_share=main.contact_share.tolist(),
        jumps=list(main.jumps),
        cell_course_mm=zero.cell_course_mm,
        cell_wale_mm=zero.cell_wale_mm,
        law=None if law is None else LawResult(**_law_fields(law)),
        converged=main.converged and len(main.strain) == options.points,
        seconds=seconds,
        yarn=yarn_result(used),
        notes=notes,
    )


def _sweep(
    repeat: StitchChart, used: ChartYarn, zero: RelaxedCell, options: SweepOptions,
    direction: Direction, max_strain: float, points: int, max_stress: float | None,
    cancelled: Cancelled | None,
) -> Sweep:  # fmt: skip
    if isinstance(zero, RelaxedRepeat):
        return sweep(
            zero, direction, max_strain, points=points, max_stress_n_per_mm=max_stress,
            slide_quenching=options.slide_quenching, cancel=cancelled,
        )  # fmt: skip
    if options.slide_quenching:
        raise InputError(
            "slide_quenching",
            "the published branch decides it as the paper did.",
            "Leave it out, or use mirrored or free.",
        )
    return sweep_published(
        pure_fabric(repeat), used.yarn, used.loop_length_mm, direction, max_strain, points,
        options.convention, zero=zero,
        max_stress_n_per_mm=math.inf if max_stress is None else max_stress, cancel=cancelled,
    )  # fmt: skip


def _jumps_fitted(stretch: Sweep, law: SimulatedLaw) -> list[str]:
    fitted = [i for i in stretch.jumps if stretch.stress_n_per_mm[i] <= law.max_stress_n_per_mm]
    if not fitted:
        return []
    return [
        f"The law is a smooth curve through {len(fitted)} abrupt change(s) of shape along the "
        f"{stretch.direction}."
    ]


def _law_fields(law: SimulatedLaw) -> dict[str, Any]:
    names = LawResult.model_fields
    fields = {name: getattr(law.law, name) for name in names if hasattr(law.law, name)}
    fields |= {name: getattr(law, name) for name in names if hasattr(law, name)}
    fields["modulus_course_n_per_mm"] = law.law.modulus_course
    fields["modulus_wale_n_per_mm"] = law.law.modulus_wale
    return fields
