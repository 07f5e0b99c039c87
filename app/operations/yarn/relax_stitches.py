"""Relaxing a repeat of lace, cables, slips and tucks at the yarn level."""

from __future__ import annotations

from dataclasses import asdict, replace
from typing import Literal

from pydantic import Field

from knitcore.chart.symbol_chart import SymbolChart
from knitcore.yarn.library.yarns import ChartYarn, yarn_for
from knitcore.yarn.loops.relaxed_stitches import (
    FRICTION,
    MAX_STITCHES,
    StitchHistory,
    relax_stitches,
)
from knitcore.yarn.solve.friction import MAX_COEFFICIENT

from ...context import Context
from ...requests.base import RequestModel, ResultModel
from ...requests.charts import AnyChartInput, MaterialName, to_stitches
from ...requests.yarn_level import YarnResult
from ..registry import Command, Operation


class RelaxStitchesRequest(RequestModel):
    """A repeat of any stitches, its yarn, and its history."""

    chart: AnyChartInput
    material: MaterialName
    loop_length_mm: float | None = Field(
        None, gt=0, le=1000, description="Yarn of a knit; the material's by default."
    )
    history: StitchHistory = Field(
        StitchHistory.BLOCKED,
        description="Treatment of the cloth before it came to rest: pulled both ways, taken down "
        "as on the machine, or shaken until no friction is left.",
    )
    friction: float = Field(
        FRICTION, ge=0, le=MAX_COEFFICIENT, description="Coefficient of friction between yarns."
    )
    centre_lines: bool = Field(False, description="Return the centre lines of the yarn too.")
    fresh: bool = Field(False, description="Compute again, even if the result is stored.")

    def stitches(self) -> SymbolChart:
        """The repeat."""
        chart = to_stitches(self.chart)
        return chart if isinstance(chart, SymbolChart) else SymbolChart.of(chart.repeat())

    def yarn(self, context: Context) -> ChartYarn:
        """The material's yarn in the repeat."""
        material, given = context.material(self.material), self.loop_length_mm
        used = yarn_for(material, self.stitches().plain, given)
        return used if given is None else replace(used, loop_length_mm=given)


class RelaxStitchesResult(ResultModel):
    """A shape of the yarn at rest after one history, of many that it may take."""

    kind: Literal["relax_stitches"] = "relax_stitches"
    pattern: str = Field(description="The repeat, at least two stitches each way.")
    history: StitchHistory
    friction: float | None
    cell_course_mm: float | None = Field(
        description="Width of a stitch of this shape; null where the cloth folds."
    )
    cell_wale_mm: float | None
    thickness_mm: float
    folded: bool = Field(description="True where rows or columns of the cloth stand up.")
    hole_share: float | None = Field(
        description="Part of the cloth that no yarn covers, 0 to 1; null where it folds."
    )
    eyelet_mm2: float | None = Field(
        description="Mean area of the holes of yarn overs, neighbouring ones together."
    )
    energy_n_mm: float = Field(description="Energy of a stitch.")
    bending_share: float
    crossings: int = Field(description="Crossings of the yarn that the chart asks for, all kept.")
    min_distance_mm: float
    converged: bool
    seconds: float = Field(description="CPU time of the solve, when it was first run.")
    known: bool = Field(False, description="True if the result was already stored.")
    yarn: YarnResult
    notes: list[str]
    centre_lines_mm: list[list[tuple[float, float, float]]] | None = Field(
        None,
        description="Lines of the yarn, the bottom course first; each runs once across the repeat.",
    )


def relax_stitches_(request: RelaxStitchesRequest, context: Context) -> RelaxStitchesResult:
    """Shape at rest of a repeat of any stitches, after a history of loading.

    A relaxation that was run before is returned from storage.
    """
    chart, used = request.stitches(), request.yarn(context)
    result, known = context.kept.get_or_make(
        RelaxStitchesResult,
        {
            "repeat": chart.text,
            "used": asdict(used),
            "asked": request.model_dump(mode="json", exclude={"fresh", "chart", "material"}),
        },
        lambda: _relaxed(request, chart, used, context),
        fresh=request.fresh,
    )
    return result.model_copy(update={"known": known})


def _relaxed(
    request: RelaxStitchesRequest, chart: SymbolChart, used: ChartYarn, context: Context
) -> RelaxStitchesResult:
    cell = request.pass_to(
        relax_stitches, chart, used.yarn, used.loop_length_mm, cancelled=context.cancelled
    )
    lines = cell.centre_lines.tolist() if request.centre_lines else None
    result = RelaxStitchesResult.of(cell, yarn=YarnResult.of_chart(used), centre_lines_mm=lines)
    unknown = ("cell_course_mm", "cell_wale_mm", "hole_share", "eyelet_mm2") if cell.folded else ()
    return result.model_copy(update=dict.fromkeys(unknown))


def _lines(r: RelaxStitchesResult) -> list[str]:
    after = r.history if r.friction is None else f"{r.history}, friction {r.friction:g}"
    size, holes = "has no size, as the cloth folds", "not known, as the cloth folds"
    if r.cell_course_mm is not None and r.cell_wale_mm is not None:
        size = f"{r.cell_course_mm:.3f} mm wide, {r.cell_wale_mm:.3f} mm high"
    if r.hole_share is not None:
        eyelets = "" if r.eyelet_mm2 is None else f", {r.eyelet_mm2:.1f} mm² an eyelet"
        holes = f"{r.hole_share:.0%} of the cloth{eyelets}"
    return [
        f"repeat          {r.pattern}",
        f"history         {after}",
        f"stitch          {size}, {r.thickness_mm:.2f} mm thick",
        f"holes           {holes}",
        f"energy          {r.energy_n_mm:.4f} N·mm a stitch, {r.bending_share:.0%} bending",
        f"crossings       {r.crossings}, all as the chart asks",
        f"solved          {r.seconds:.2f} s CPU, {'converged' if r.converged else 'NOT converged'}"
        f"{'; stored result' if r.known else ''}",
    ]


OPERATION = Operation(
    relax_stitches_,
    tag="yarn level",
    summary="Relax a repeat of lace, cables, slips or tucks",
    example={"chart": "BP", "material": "acrylic"},
    path="/relax-stitches",
    most_stitches=MAX_STITCHES,
    job=True,
    command=Command(
        _lines,
        more="Every row takes as many loops as the row below leaves, as in 'KKKK;O/\\O'. The size "
        "is that of one history; `predict` has the size of cloth.",
    ),
)
