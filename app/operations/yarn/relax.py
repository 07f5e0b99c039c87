"""Relaxing a repeat at the yarn level."""

import time
from collections.abc import Iterator
from dataclasses import replace
from typing import Literal, Self

from pydantic import Field

from knitcore.base.errors import ConvergenceError, InputError, UnravelledError
from knitcore.chart.phases import pure_fabric
from knitcore.chart.stitch_chart import StitchChart, size_in_words
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.materials.law_uncertainty import YARN_LEVEL_ERRORS
from knitcore.prediction.swept import size_from_relaxation
from knitcore.yarn.library.yarns import ChartYarn, phase_shares
from knitcore.yarn.loops.relaxed_stitches import MAX_STITCHES
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.model.relaxed_cell import RelaxedCell
from knitcore.yarn.solve.splines import has_mirrors, size_intervals
from knitcore.yarn.study.hysteresis import History, rest_sizes
from knitcore.yarn.study.lowest import FOLLOWED_UP_TO, lowest
from knitcore.yarn.study.relax import Branch, RelaxedRepeat
from knitcore.yarn.study.whole_chart import WINDOWS_FROM

from ...cli.options import loop_lengths
from ...context import Context
from ...requests.base import Known, Positive, ResultModel
from ...requests.charts import RepeatText
from ...requests.fabrics import RelaxedGauge
from ...requests.stitches_at_rest import (
    NO_INTERVAL,
    AnyHistory,
    RestedRequest,
    RestedResult,
    hole_lines,
    size_line,
    unless_folded,
)
from ...requests.yarn_level import (
    HISTORIES,
    RestSizeResult,
    YarnResult,
    kept_or_made,
    on_splines,
    relax_requested,
    rest_line,
)
from ..registry import Command, Operation


class RelaxRequest(RestedRequest):
    """A repeat, its yarn, what is held while it relaxes, and the fabric's history of loading."""

    of_knits_and_purls = (
        "branch", "flat", "cell_course_mm", "cell_wale_mm", "loop_lengths_mm", "yarn_per_stitch",
    )  # fmt: skip

    branch: Branch | None = Field(
        None,
        description="Branch to relax in. By default symmetry is only the start: the mirrored shape "
        "is followed to the minimum to which it leads without the symmetries of the chart. Shapes "
        "that are held, or "
        f"have friction, keep them; repeats of more than {FOLLOWED_UP_TO} stitches are relaxed in "
        "the free branch.",
    )
    history: AnyHistory | None = Field(
        None,
        description="History of the fabric before it came to rest, with the friction of the yarn "
        "unless a coefficient is given. As-knitted if only a coefficient is given. Charts with "
        "other stitches than knits and purls are blocked (pulled both ways) by default, and have "
        "no stretched histories; knits and purls are not blocked.",
    )

    cell_course_mm: Positive | None = Field(None, description="Hold a stitch at this width.")
    cell_wale_mm: Positive | None = Field(None, description="Hold a stitch at this height.")
    centre_lines: bool = Field(False, description="Return the centre lines of the yarn too.")

    @property
    def has_friction(self) -> bool:
        """True if a coefficient or a history is given."""
        return self.friction is not None or self.history is not None

    def with_friction(self, context: Context) -> Self:
        """The request with its coefficient of friction and its history."""
        request = super().with_friction(context)
        if self.others() is not None or not request.has_friction:
            return request
        if request.history is AnyHistory.BLOCKED:
            raise InputError(
                "history",
                "blocked is for charts with other stitches than knits and purls.",
                f"Use {', '.join(History)}.",
            )
        usual = {
            "history": request.history or AnyHistory.KNITTED,
            "branch": request.branch or Branch.MIRRORED,
        }
        return request.model_copy(update=usual)

    def _against_friction(self) -> Iterator[InputError]:
        yield from super()._against_friction()
        for field in ("cell_course_mm", "cell_wale_mm"):
            if getattr(self, field) is not None:
                yield InputError(
                    field, "a fabric at rest after a history is free of force.", "Leave it out."
                )


class StartResult(ResultModel):
    """The result from one starting shape; null where it failed."""

    name: str
    outcome: str
    energy_n_mm: Known
    cell_course_mm: Known
    cell_wale_mm: Known


class OtherShapeResult(ResultModel):
    """Energy and size of a stitch in another shape of the repeat."""

    energy_n_mm: float
    cell_course_mm: float
    cell_wale_mm: float


class RelaxResult(RestedResult):
    """The shape of least energy, free of force or held; sizes and energies of one stitch."""

    kind: Literal["relax"] = "relax"
    branch: Branch
    convention: Convention
    pattern: RepeatText
    repeat_rows: int = Field(
        description="Rows of the repeat; at least 2 in the free branch, as are the columns."
    )
    repeat_columns: int
    energy_n_mm: float
    bending_share: float
    contact_share: float
    yarn_length_mm: float
    force_course_n: float | None = Field(
        description="Force per stitch that holds a prescribed width; near 0 where it is free."
    )
    force_wale_n: float | None
    min_distance_mm: float | None
    seconds: float = Field(description="CPU time of the solve, when it was first run.")
    known: bool = Field(False, description="True if the result was already stored.")
    evaluations: int = Field(
        description="Evaluations of the energy; steps of a history are not counted."
    )
    converged: bool
    yarn: YarnResult
    starts: list[StartResult]
    friction: float | None = Field(
        None, description="Coefficient of friction that was used; null without friction."
    )
    history: AnyHistory | None = Field(
        None, description="History after which the fabric comes to rest; null without friction."
    )
    rest_sizes: list[RestSizeResult] | None = Field(
        None,
        description="Size after each history, with friction: the range in which the fabric may "
        "rest.",
    )
    minimum: bool | None = Field(
        None,
        description="True if the shape is a minimum without the mirror symmetries of the chart; "
        "null where that was not checked: for shapes that are held, have friction or are of the "
        f"published branch, for mirrored ones whose free cell has more than {FOLLOWED_UP_TO} "
        f"stitches, and for cells of {WINDOWS_FROM} stitches and more.",
    )
    mirrored: OtherShapeResult | None = Field(
        None,
        description="The mirrored shape from which this one, of less energy, was found. The laws "
        "of stored repeats and learned answers are of mirrored shapes, which are nearer to knitted "
        "cloth.",
    )
    unmirrored: OtherShapeResult | None = Field(
        None,
        description="Lower shape to which the mirrored branch leads without its symmetries, if it "
        "is not a minimum.",
    )
    other_minima_mm: list[tuple[float, float]] = Field(
        default_factory=list,
        description="Width and height of a stitch in other shapes that were found, whose energy is "
        "the same within 0.1 %. Which one is shown is a rule; the intervals cover all.",
    )
    gauge: RelaxedGauge | None = Field(
        None,
        description="Gauge for other requests about this chart and material, which makes their "
        "answers more certain. Null unless the material is simulated, and for pure fabrics, "
        "other branches, shapes that are held, other loop lengths than the material's, and "
        "friction.",
    )
    notes: list[str]
    centre_lines_mm: list[list[tuple[float, float, float]]] | None = Field(
        None,
        description="Lines of the yarn, the bottom course first; each runs once across the repeat.",
    )


def relax(request: RelaxRequest, context: Context) -> RelaxResult:
    """Shape of least energy of the repeat; stops when the caller disconnects.

    With friction, the shape in which the fabric comes to rest after a history of loading; that is
    always so for other stitches than knits and purls. A relaxation that was run before is returned
    from storage.
    """
    if (stitches := request.others()) is not None:
        return request.kept_or_made_of_others(RelaxResult, context, stitches, _relaxed_others)
    request = request.with_friction(context)
    result = kept_or_made(RelaxResult, request, context, _relaxed)
    return result.model_copy(update={"gauge": _gauge(request, result, context)})


def _relaxed(
    request: RelaxRequest, repeat: StitchChart, used: ChartYarn, context: Context
) -> RelaxResult:
    sizes = request.cell_course_mm, request.cell_wale_mm
    cell = relax_requested(repeat, used, request, context)
    unmirrored, rests = None, None
    if request.friction is not None:
        cell, rests = _after_history(on_splines(cell), request.friction, request, context)
    elif request.branch is Branch.MIRRORED and sizes == (None, None):
        cell, unmirrored = _unmirrored(cell, context)
    free = [
        interval if held is None else None
        for interval, held in zip(size_intervals(cell), sizes, strict=True)
    ]
    return RelaxResult.of(
        cell,
        friction=request.friction,
        history=request.history,
        rest_sizes=rests,
        unmirrored=unmirrored,
        cell_course_interval_mm=free[0],
        cell_wale_interval_mm=free[1],
        interval_source=YARN_LEVEL_ERRORS,
        pattern=cell.chart.key,
        repeat_rows=cell.chart.rows,
        repeat_columns=cell.chart.columns,
        force_course_n=cell.force_n[0],
        force_wale_n=cell.force_n[1],
        yarn=YarnResult.of_chart(used),
        centre_lines_mm=[line.tolist() for line in cell.centre_lines]
        if request.centre_lines
        else None,
    )


def _relaxed_others(
    request: RelaxRequest, stitches: SymbolChart, used: ChartYarn, context: Context
) -> RelaxResult:
    rest = request.at_rest(stitches, used, context)
    cell = rest.state.cell
    known = unless_folded(rest.folded, rest)
    return RelaxResult.of(
        cell,
        **known,
        pattern=rest.pattern,
        repeat_rows=cell.chart.rows,
        repeat_columns=cell.chart.columns,
        cell_course_interval_mm=None,
        cell_wale_interval_mm=None,
        interval_source=NO_INTERVAL,
        folded=rest.folded,
        crossings=rest.crossings,
        friction=rest.friction,
        history=AnyHistory(rest.history),
        force_course_n=cell.force_n[0],
        force_wale_n=cell.force_n[1],
        yarn=YarnResult.of_chart(used),
        centre_lines_mm=rest.centre_lines.tolist() if request.centre_lines else None,
    )


def _after_history(
    zero: RelaxedRepeat, friction: float, request: RelaxRequest, context: Context
) -> tuple[RelaxedCell, list[RestSizeResult]]:
    """The state free of force after the request's history, and the size after each history."""
    began = time.process_time()
    rests = rest_sizes(zero, friction, cancelled=context.cancelled)
    (cell,) = (rest.state.cell for rest in rests if str(rest.history) == request.history)
    after = replace(
        cell,
        starts=zero.starts,
        evaluations=zero.evaluations,
        seconds=zero.seconds + time.process_time() - began,
        notes=(*zero.notes, request.friction_note(context), HISTORIES),
    )
    return after, [RestSizeResult.of(rest) for rest in rests]


def _unmirrored(cell: RelaxedCell, context: Context) -> tuple[RelaxedCell, RelaxedRepeat | None]:
    """Note whether a mirrored shape is a minimum; return the minimum that it leads to otherwise."""
    if not isinstance(cell, RelaxedRepeat):
        return cell, None
    lower = lowest(cell, cancelled=context.cancelled)
    if lower.mirrored is None:
        return lower, None
    note = (
        "This shape is a minimum only among mirrored ones: without the symmetries it leaves for "
        f"one with {1.0 - lower.energy_n_mm / cell.energy_n_mm:.1%} less energy, "
        f"{lower.cell_course_mm:.2f} x {lower.cell_wale_mm:.2f} mm a stitch."
    )
    return replace(cell, minimum=False, notes=(*cell.notes, note)), lower


def _gauge(request: RelaxRequest, result: RelaxResult, context: Context) -> RelaxedGauge | None:
    """The gauge of a simulated material's cloth, which other requests take; None for any other.

    It compares the mirrored shape with the material's pure fabrics, relaxed in the same way.
    """
    usual = RelaxRequest(
        chart=request.chart, material=request.material, convention=request.convention
    )
    plain = request.model_copy(update={"fresh": False, "centre_lines": False})
    alike = usual, usual.model_copy(update={"branch": Branch.MIRRORED})
    material, repeat = context.material(request.material), request.repeat()
    known = (
        result if result.branch is Branch.MIRRORED or not has_mirrors(repeat) else result.mirrored
    )
    if known is None or plain not in alike:
        return None
    if known.cell_course_mm is None or known.cell_wale_mm is None:
        return None
    if not material.is_simulated or pure_fabric(repeat) is not None:
        return None
    pure_mm = {}
    for fabric in phase_shares(repeat):
        text = StitchChart.of_fabric(fabric).repeat().text
        try:
            pure = relax(alike[1].model_copy(update={"chart": text}), context)
        except (ConvergenceError, UnravelledError):
            return None
        if pure.cell_course_mm is None or pure.cell_wale_mm is None:
            return None
        pure_mm[fabric] = (pure.cell_course_mm, pure.cell_wale_mm)
    cell_mm = known.cell_course_mm, known.cell_wale_mm
    return RelaxedGauge.of(size_from_relaxation(repeat, material, cell_mm, pure_mm))


def _gauge_line(gauge: RelaxedGauge | None) -> list[str]:
    if gauge is None:
        return []
    return [
        f"for predict     --stitches-per-10-cm {gauge.stitches_per_10_cm:.2f} --rows-per-10-cm "
        f"{gauge.rows_per_10_cm:.2f} --log-sd {gauge.log_sd:.3f} --known-by {gauge.known_by}"
    ]


def _other_shape(name: str, shape: OtherShapeResult | None, why: str) -> list[str]:
    if shape is None:
        return []
    size = f"{shape.cell_course_mm:.3f} mm wide, {shape.cell_wale_mm:.3f} mm high"
    return [f"{name:16}{size}, {shape.energy_n_mm:.4f} N·mm{why}"]


def _history_lines(r: RelaxResult) -> list[str]:
    if r.crossings is None:
        return []
    friction = "" if r.friction is None else f", friction {r.friction:g}"
    return [f"history         {r.history}{friction}"]


def _lines(r: RelaxResult) -> list[str]:
    return [
        f"repeat          {size_in_words(r.repeat_columns, r.repeat_rows)}, {r.branch} branch",
        f"stitch          {size_line(r)}",
        *_history_lines(r),
        *hole_lines(r),
        *_other_shape("with mirrors", r.mirrored, "; laws and learned answers are of this shape"),
        *_other_shape("without mirrors", r.unmirrored, ""),
        f"energy          {r.energy_n_mm:.4f} N·mm a stitch, {100 * r.bending_share:.1f} % "
        f"bending, {100 * r.contact_share:.1f} % contact",
        f"yarn            {r.yarn_length_mm:.2f} mm a stitch; {r.yarn.provenance}",
        *(
            f"{rest_line(rest)}{', here' * (str(rest.history) == r.history)}"
            for rest in r.rest_sizes or ()
        ),
        *_gauge_line(r.gauge),
        f"solved          {r.seconds:.2f} s CPU, {r.evaluations} evaluations, "
        f"{'converged' if r.converged else 'NOT converged'}"
        f"{'; stored result' if r.known else ''}",
    ]


OPERATION = Operation(
    relax,
    tag="yarn level",
    summary="Relax a repeat at the yarn level",
    example={"chart": "K\nP", "material": "acrylic"},
    job=True,
    command=Command(
        _lines,
        more="It is free of force, and has no friction unless --friction or --history asks for it. "
        "Charts of any stitches, as 'KKKK;O/\\O', may have up to "
        f"{MAX_STITCHES}, and are blocked, with friction; `predict` has the size of their cloth.",
        names={"loop_lengths_mm": None},
        fields=loop_lengths,
    ),
)
