"""Stretching a repeat at the yarn level, and fitting a law to it."""

from collections.abc import Callable
from functools import partial
from typing import Literal

import numpy as np
from pydantic import Field

from knitcore.base.errors import KnitcoreError
from knitcore.chart.fabric import Direction
from knitcore.chart.stitch_chart import StitchChart
from knitcore.materials.law_uncertainty import (
    YARN_LEVEL_ERRORS,
    YARN_LEVEL_STRAIN_LOG_SD,
    log_interval,
)
from knitcore.yarn.library.law_of_stretches import MAX_STRESS_N_PER_MM, SimulatedLaw, fit_sweeps
from knitcore.yarn.library.yarns import ChartYarn
from knitcore.yarn.model.relaxed_cell import RelaxedCell, Sweep
from knitcore.yarn.study.hysteresis import pull
from knitcore.yarn.study.relax import Branch
from knitcore.yarn.study.sweep import sweep as swept

from ...cli.options import loop_lengths
from ...context import Context
from ...requests.base import EndsOfList, Floats, IntervalResult
from ...requests.fabrics import ElasticConstants, law_fields
from ...requests.yarn_level import (
    RubbedRequest,
    YarnResult,
    kept_or_made,
    on_splines,
    relax_requested,
)
from ..registry import Command, Operation

FACTOR = log_interval(1.0, YARN_LEVEL_STRAIN_LOG_SD).high
"""90 % interval of the strains of knitted cloth, as a factor either way."""
_FAR_STRAIN = {Direction.COURSE: 3.5, Direction.WALE: 2.5}
"""Largest strain of the two stretches that the law is fitted to; a stress may end them before."""
_FAR_POINTS = 60


class SweepRequest(RubbedRequest):
    """A repeat, its yarn and the stretch."""

    branch: Branch = Branch.MIRRORED
    direction: Direction = Field(description="Direction of the pull: along rows, or along columns.")
    max_strain: float = Field(gt=0, le=20, description="Largest strain: 0.5 is 50 %.")
    points: int = Field(25, ge=2, le=400)

    @property
    def has_friction(self) -> bool:
        """True if a coefficient is given."""
        return self.friction is not None


class SweptLaw(ElasticConstants):
    """Law fitted to stretches along courses and along wales; stiffnesses and errors in N/mm."""

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
    strain_interval: EndsOfList = Field(
        description="90 % interval for knitted cloth, at each stress."
    )
    transverse_strain: Floats
    stress_n_per_mm: Floats
    energy_n_mm: Floats = Field(
        description="Energy of bending and contact, without losses to friction."
    )
    bending_share: Floats
    contact_share: Floats
    jumps: list[int] = Field(description="Points at which the shape changes abruptly.")
    cell_course_mm: float = Field(description="Relaxed size of one stitch.")
    cell_wale_mm: float
    friction: float | None = Field(
        None, description="Coefficient of friction that was used; null without friction."
    )
    law: SweptLaw | None
    converged: bool
    seconds: float = Field(description="CPU time of the solves, when they were first run.")
    known: bool = Field(False, description="True if the result was already stored.")
    yarn: YarnResult
    notes: list[str]


def sweep(request: SweepRequest, context: Context) -> SweepResult:
    """Stress-strain curve and fitted law of the repeat; stops when the caller disconnects.

    With friction, it is the first pull from the state that shaking leaves. The law is fitted to two
    further stretches, along courses and along wales. A stretch that was run before is returned from
    storage.
    """
    return kept_or_made(SweepResult, request.with_friction(context), context, _result)


def _result(
    request: SweepRequest, repeat: StitchChart, used: ChartYarn, context: Context
) -> SweepResult:
    zero = relax_requested(repeat, used, request, context)
    pulled = _pulling(zero, request, context)
    main = pulled(request.direction, request.max_strain, points=request.points)
    notes, seconds = list(main.notes), zero.seconds + main.seconds
    if request.friction is not None:
        how = "Pulled once from the state that shaking leaves, as for the law."
        notes += [request.friction_note(context), how]
    law: SimulatedLaw | None = None
    try:
        both = {}
        for d in Direction:
            both[d] = pulled(
                d, _FAR_STRAIN[d], points=_FAR_POINTS, max_stress_n_per_mm=1.2 * MAX_STRESS_N_PER_MM
            )
            seconds += both[d].seconds
        law = fit_sweeps(both[Direction.COURSE], both[Direction.WALE])
        notes += [note for sweep in both.values() for note in _jumps_fitted(sweep, law)]
    except KnitcoreError as error:
        if context.cancelled():
            raise
        notes.append(f"No law could be fitted: {error}")
    return SweepResult.of(
        main,
        branch=zero.branch,
        cell_course_mm=zero.cell_course_mm,
        cell_wale_mm=zero.cell_wale_mm,
        friction=request.friction,
        strain_interval=tuple(np.sort([main.strain / FACTOR, main.strain * FACTOR], axis=0)),
        interval_source=YARN_LEVEL_ERRORS,
        law=None if law is None else _swept_law(law),
        converged=main.converged and len(main.cells) == request.points,
        seconds=seconds,
        yarn=YarnResult.of_chart(used),
        notes=notes,
    )


def _swept_law(fitted: SimulatedLaw) -> SweptLaw:
    law = vars(fitted.law)
    constants = {name: law[name] for name in SweptLaw.model_fields if name in law}
    return SweptLaw.of(fitted, **law_fields(fitted.law, ElasticConstants), **constants)


def _pulling(zero: RelaxedCell, request: SweepRequest, context: Context) -> Callable[..., Sweep]:
    """The function that pulls the relaxed repeat, with friction if the request has any."""
    if request.friction is not None:
        return partial(
            pull, on_splines(zero), coefficient=request.friction, cancelled=context.cancelled
        )
    return partial(swept, zero, cancelled=context.cancelled)


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
        more="It is free across, and has no friction unless --friction is given.",
        names={"loop_lengths_mm": None},
        fields=loop_lengths,
    ),
)
