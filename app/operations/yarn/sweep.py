"""Stretching a repeat at the yarn level, and fitting a law to it."""

from collections.abc import Callable, Iterator
from functools import partial
from typing import Literal, Self

import numpy as np
from pydantic import Field

from knitcore.base.errors import InputError, KnitcoreError
from knitcore.chart.fabric import Direction
from knitcore.chart.stitch_chart import StitchChart
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.materials.law_uncertainty import (
    YARN_LEVEL_ERRORS,
    YARN_LEVEL_STRAIN_LOG_SD,
    log_interval,
)
from knitcore.prediction.stitch_effects import STRETCH_FACTOR
from knitcore.yarn.library.law_of_stretches import MAX_STRESS_N_PER_MM, SimulatedLaw, fit_sweeps
from knitcore.yarn.library.yarns import ChartYarn
from knitcore.yarn.loops.stitch_response import stretch_stitches
from knitcore.yarn.model.relaxed_cell import RelaxedCell, Sweep
from knitcore.yarn.study.hysteresis import Hysteresis, hysteresis, pull
from knitcore.yarn.study.relax import Branch
from knitcore.yarn.study.sweep import sweep as swept

from ...cli.options import loop_lengths
from ...context import Context
from ...requests.base import EndsOfList, Floats, IntervalResult
from ...requests.fabrics import ElasticConstants, law_fields
from ...requests.stitches_at_rest import AnyHistory, RestedRequest
from ...requests.yarn_level import YarnResult, kept_or_made, on_splines, relax_requested
from ..registry import Command, Operation

FACTOR = log_interval(1.0, YARN_LEVEL_STRAIN_LOG_SD).high
"""90 % interval of the strains of knitted cloth, as a factor either way."""
_FAR_STRAIN = {Direction.COURSE: 3.5, Direction.WALE: 2.5}
"""Largest strain of the two stretches that the law is fitted to; a stress may end them before."""
_FAR_POINTS = 60
_HOW = {
    False: "Pulled once from the state that shaking leaves, as for the law.",
    True: "Pulled once from the state that shaking leaves, and released until free of force. The "
    "law is that of pulling.",
}
"""Notes on friction, without and with the way back."""


_OF_OTHERS = (
    f"{YARN_LEVEL_ERRORS} Nobody has measured stretches of lace, cables, slips or tucks: both ends "
    f"are a factor of {STRETCH_FACTOR:g} farther."
)


class SweepRequest(RestedRequest):
    """A repeat, its yarn and the stretch."""

    of_knits_and_purls = (
        "flat", "loop_lengths_mm", "yarn_per_stitch", "slide_quenching", "there_and_back",
    )  # fmt: skip
    history: AnyHistory | None = Field(
        None,
        description="Treatment of a cloth with other stitches than knits and purls before it is "
        "pulled: blocked by default, as-knitted, or agitated, which leaves no friction.",
    )

    branch: Branch = Branch.MIRRORED
    direction: Direction = Field(description="Direction of the pull: along rows, or along columns.")
    max_strain: float = Field(gt=0, le=20, description="Largest strain: 0.5 is 50 %.")
    points: int = Field(25, ge=2, le=400)
    slide_quenching: bool = Field(
        False,
        description="Keep the yarn from sliding where it touches at rest. The published branch "
        "does so for seed along the course, as the paper did, and has no other setting.",
    )
    there_and_back: bool = Field(
        False,
        description="Release the fabric again until it is free of force, with friction: that of "
        "the yarn unless a coefficient is given.",
    )

    @property
    def has_friction(self) -> bool:
        """True if a coefficient is given, or the way back is asked for."""
        return self.friction is not None or self.there_and_back

    def with_friction(self, context: Context) -> Self:
        """The request with its coefficient of friction, and the history of other stitches."""
        if self.others() is None and self.history is not None:
            raise InputError(
                "history",
                "knits and purls are pulled from the state that shaking leaves.",
                "Leave it out, or give --friction alone.",
            )
        return super().with_friction(context)

    def _against_friction(self) -> Iterator[InputError]:
        yield from super()._against_friction()
        if self.slide_quenching:
            yield InputError(
                "slide_quenching",
                "yarn that is kept from sliding cannot have friction.",
                "Leave it out.",
            )


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
    """A stretch, free across; sizes and energies of one stitch.

    With the way back, all lists run there and back again.
    """

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
    history: AnyHistory | None = Field(
        None, description="History of a cloth with other stitches; null for knits and purls."
    )
    turn: int | None = Field(
        None,
        description="Index of the largest strain, where the fabric turns; null without the way "
        "back, as are the next three.",
    )
    lost_per_cycle_n_per_mm: float | None = Field(
        None, description="Energy lost there and back per area of fabric, N·mm/mm²."
    )
    lost_share: float | None = Field(
        None, description="Energy lost, as a share of the work of the pull."
    )
    left_strain: float | None = Field(None, description="Strain that remains after the release.")
    law: SweptLaw | None
    converged: bool
    seconds: float = Field(description="CPU time of the solves, when they were first run.")
    known: bool = Field(False, description="True if the result was already stored.")
    yarn: YarnResult
    notes: list[str]


def sweep(request: SweepRequest, context: Context) -> SweepResult:
    """Stress-strain curve and fitted law of the repeat; stops when the caller disconnects.

    With friction, the first pull from the state that shaking leaves, and the release if it is asked
    for. The law is that of pulling, fitted to two further stretches, along courses and along wales.
    Other stitches than knits and purls are pulled from rest after their history, with its friction,
    unless their cloth folds there. A stretch that was run before is returned from storage.
    """
    if (stitches := request.others()) is not None:
        return request.kept_or_made_of_others(SweepResult, context, stitches, _of_others)
    return kept_or_made(SweepResult, request.with_friction(context), context, _result)


def _result(
    request: SweepRequest, repeat: StitchChart, used: ChartYarn, context: Context
) -> SweepResult:
    zero = relax_requested(repeat, used, request, context)
    return _swept(zero, _pulling(zero, request, context), request, used, context)


def _of_others(
    request: SweepRequest, stitches: SymbolChart, used: ChartYarn, context: Context
) -> SweepResult:
    rest = request.at_rest(stitches, used, context)
    pulled = partial(stretch_stitches, rest, cancelled=context.cancelled)
    return _swept(
        rest.state.cell, pulled, request, used, context,
        factor=STRETCH_FACTOR * FACTOR, how=f"Pulled once from rest as the {rest.history} cloth.",
    )  # fmt: skip


def _swept(
    zero: RelaxedCell, pulled: Callable[..., Sweep], request: SweepRequest, used: ChartYarn,
    context: Context, *, factor: float = FACTOR, how: str | None = None,
) -> SweepResult:  # fmt: skip
    """The result of pulling a shape at rest."""
    loop = _loop(zero, request, context)
    main = (
        loop.last_cycle
        if loop
        else pulled(request.direction, request.max_strain, points=request.points)
    )
    there = loop.turn + 1 if loop else len(main.cells)
    notes, seconds = list(main.notes), zero.seconds + main.seconds
    if request.friction is not None:
        notes += [request.friction_note(context), how or _HOW[request.there_and_back]]
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
        turn=loop and loop.turn,
        lost_per_cycle_n_per_mm=loop and loop.lost_per_cycle_n_per_mm,
        lost_share=loop and loop.lost_share,
        left_strain=loop and loop.left_strain,
        history=request.history,
        strain_interval=tuple(np.sort([main.strain / factor, main.strain * factor], axis=0)),
        interval_source=YARN_LEVEL_ERRORS if request.history is None else _OF_OTHERS,
        law=None if law is None else _swept_law(law),
        converged=main.converged and there == request.points,
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
    return partial(
        swept, zero, slide_quenching=request.slide_quenching or None, cancelled=context.cancelled
    )


def _loop(zero: RelaxedCell, request: SweepRequest, context: Context) -> Hysteresis | None:
    """The way there and back, if it is asked for."""
    if not request.there_and_back or request.friction is None:
        return None
    return request.pass_to(
        hysteresis,
        on_splines(zero),
        coefficient=request.friction,
        cycles=1,
        cancelled=context.cancelled,
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
    factor = FACTOR if r.history is None else STRETCH_FACTOR * FACTOR
    columns = zip(r.strain, r.transverse_strain, r.stress_n_per_mm, r.energy_n_mm, strict=True)
    lines = ["strain   across   stress N/mm   energy N·mm"]
    lines += [f"{a:6.3f}  {b:7.3f}  {c:11.5f}  {d:12.5f}" for a, b, c, d in columns]
    if r.law is not None:
        lines.append(
            f"law up to {r.law.max_stress_n_per_mm:g} N/mm: Y course "
            f"{r.law.modulus_course_n_per_mm:.4f}, wale {r.law.modulus_wale_n_per_mm:.4f} N/mm, "
            f"Poisson yx {r.law.poisson_yx:.3f}, xy {r.law.poisson_xy:.3f}"
        )
    if r.lost_per_cycle_n_per_mm is not None:
        lines += [
            f"lost there and back {r.lost_per_cycle_n_per_mm:.4g} N·mm/mm², "
            f"{r.lost_share:.0%} of the work; remaining strain {r.left_strain:.3f}"
        ]
    return [
        *lines,
        f"90 % interval of the strains of knitted cloth: a factor of {factor:.1f} either way.",
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
        more="It is free across, and has no friction unless --friction or --there-and-back asks "
        "for it.",
        names={"loop_lengths_mm": None},
        fields=loop_lengths,
    ),
)
