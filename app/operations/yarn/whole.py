"""Relaxing a whole chart at the yarn level, as a job that continues where it was stopped."""

from dataclasses import asdict
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator, Field

from knitcore.chart.stitch_chart import check_stitches, size_in_words
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.materials.law_uncertainty import YARN_LEVEL_ERRORS
from knitcore.yarn.loops.relaxed_stitches import BLOCKING_N_PER_MM
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.solve.rounds import MAX_ROUNDS, WholeShape
from knitcore.yarn.solve.splines import size_intervals
from knitcore.yarn.study.whole_chart import MAX_STITCHES_WHOLE, RelaxedChart, relax_whole
from knitcore.yarn.study.whole_stitches import RelaxedStitchChart, relax_whole_stitches

from ...cli.options import loop_lengths
from ...context import Context
from ...requests.base import Floats, ResultModel, listed
from ...requests.charts import AnyChartInput, to_chart, to_stitches
from ...requests.stitches_at_rest import (
    NO_INTERVAL,
    AnyStitchesRequest,
    RestedResult,
    hole_lines,
    size_line,
    unless_folded,
)
from ...requests.yarn_level import RowLengthsRequest, YarnResult, lengths_of
from ..registry import Command, Operation


class WholeRequest(AnyStitchesRequest, RowLengthsRequest):
    """A chart, its yarn, and when to stop."""

    of_knits_and_purls = ("flat", "loop_lengths_mm", "yarn_per_stitch")

    chart: AnyChartInput  # as it stands, so that a fabric needs a size
    flat: bool = Field(False, description="Hold the stitches in one plane, as a fabric laid flat.")
    convention: Convention = Convention.PUBLISHED
    tolerance: float = Field(
        1e-3, ge=1e-6, le=0.1,
        description="Stop when a round changes the energy by less than this part of it, and the "
        "sizes by less than ten times this part.",
    )  # fmt: skip
    rounds: int = Field(
        40, ge=2, le=MAX_ROUNDS, description="Largest number of rounds on each of two grids."
    )
    centre_lines: bool = Field(False, description="Return the centre lines of the yarn too.")

    def others(self) -> SymbolChart | None:
        """The chart, if it has other stitches than knits and purls."""
        chart = to_stitches(self.chart)
        return chart if isinstance(chart, SymbolChart) else None

    def check_size(self, stitches: SymbolChart) -> None:
        """Refuse a chart of other stitches that is too large."""
        check_stitches(stitches.rows * stitches.columns, MAX_STITCHES_WHOLE, "a whole chart")


class WholeResult(RestedResult):
    """The shape of a whole chart; sizes and energies of its mean stitch.

    Knits and purls are free of force; a cloth of other stitches is held spread.
    """

    kind: Literal["whole"] = "whole"
    rows: int
    columns: int
    pull_n_per_mm: float | None = Field(
        None,
        description="Pull both ways under which a cloth of other stitches is shown; null for knits "
        "and purls.",
    )
    energy_n_mm: float
    bending_share: float
    contact_share: float
    min_distance_mm: float
    converged: bool = Field(description="True if the last round met the tolerance.")
    rounds: int = Field(description="Rounds on both grids together.")
    energy_change: float = Field(description="Part of the energy that the last round took away.")
    size_change: float = Field(
        description="Larger relative change of width and height in the last round."
    )
    may_fall: float = Field(
        description="Part of the energy that further rounds may take away: the last change times "
        "all rounds."
    )
    largest_force_n: float = Field(description="Largest force that is left on the yarn.")
    seconds: float = Field(description="CPU time since the job was last started.")
    yarn: YarnResult
    notes: list[str]
    centre_lines_mm: list[list[tuple[float, float, float]]] | None = Field(
        None,
        description="Lines of the yarn, the bottom course first; each runs once across the chart.",
    )


class KeptSheet(ResultModel):
    """Progress of a chart that is being relaxed."""

    controls: Annotated[list[list[tuple[float, float, float]]], BeforeValidator(listed)]
    sizes_mm: Floats
    tension_n: Annotated[list[list[float]], BeforeValidator(listed)]
    core_radius_mm: float
    fine: bool
    rounds: list[tuple[float, float, float]]
    earlier: int
    evaluations: int = 0
    drawn_in: float = 1.0

    def sheet(self) -> WholeShape:
        """The shape as an object of the library."""
        arrays = {
            name: np.array(getattr(self, name)) for name in ("controls", "sizes_mm", "tension_n")
        }
        return WholeShape(**{**dict(self), **arrays, "rounds": tuple(self.rounds)})


def whole(request: WholeRequest, context: Context) -> WholeResult:
    """Shape of least energy of a whole chart of up to 4,000 stitches, which repeats.

    Other stitches than knits and purls are shown under an even pull both ways. A job that was
    stopped, or whose machine was, continues after the last round that ended.
    """
    others = request.others()
    if others is not None:
        request.check_parts(context)
    request = request.with_row_lengths(context)
    chart = to_chart(request.chart) if others is None else others.plain
    used = request.yarn(chart, context)
    deciding = {"flat", "convention"}
    if request.loop_lengths_mm is not None:
        deciding.add("loop_lengths_mm")
    inputs: dict[str, Any] = {
        "chart": (others or chart).text,
        "used": asdict(used),
        "asked": request.model_dump(mode="json", include=deciding),
    }
    before = context.kept.stored(KeptSheet, inputs)
    options: dict[str, Any] = {
        "resume": None if before is None else before.sheet(),
        "kept": lambda sheet: context.kept.keep(inputs, KeptSheet.of(sheet)),
        "progress": context.progress,
        "cancelled": context.cancelled,
    }
    relaxed: RelaxedChart
    if others is not None:
        length = used.loop_length_mm
        relaxed = request.pass_to(relax_whole_stitches, others, used.yarn, length, **options)
    else:
        rows = len(request.loop_lengths_mm or [])  # of the chart, or of its repeat
        lengths = lengths_of(request, used, rows or chart.rows, chart.columns)
        relaxed = request.pass_to(relax_whole, chart, used.yarn, lengths, **options)
    return WholeResult.of(
        relaxed,
        **_known(relaxed),
        rows=chart.rows,
        columns=chart.columns,
        notes=[*relaxed.notes, *_continued(before)],
        yarn=YarnResult.of_chart(used),
        centre_lines_mm=[line.tolist() for line in relaxed.centre_lines]
        if request.centre_lines
        else None,
    )


def _known(relaxed: RelaxedChart) -> dict[str, Any]:
    """Sizes, their intervals and holes, as far as they are known."""
    if not isinstance(relaxed, RelaxedStitchChart):
        course, wale = size_intervals(relaxed)
        return {
            "cell_course_interval_mm": course,
            "cell_wale_interval_mm": wale,
            "interval_source": YARN_LEVEL_ERRORS,
        }
    return {
        **unless_folded(relaxed.folded, relaxed),
        "cell_course_interval_mm": None,
        "cell_wale_interval_mm": None,
        "interval_source": NO_INTERVAL,
        "pull_n_per_mm": BLOCKING_N_PER_MM,
    }


def _continued(before: KeptSheet | None) -> list[str]:
    if before is None:
        return []
    if before.drawn_in < 1.0:
        return [f"Continued an earlier run whose yarn was drawn in by {before.drawn_in:.0%}."]
    after = before.earlier + len(before.rounds)
    return [f"Continued after {after} round{'' if after == 1 else 's'} of an earlier run."] * (
        after > 0
    )


def _lines(r: WholeResult) -> list[str]:
    return [
        f"chart           {size_in_words(r.columns, r.rows)}",
        f"stitch          {size_line(r)}",
        *(
            []
            if r.pull_n_per_mm is None
            else [f"pulled by       {r.pull_n_per_mm:g} N/mm both ways"]
        ),
        *hole_lines(r),
        f"energy          {r.energy_n_mm:.4f} N·mm a stitch, {100 * r.bending_share:.1f} % "
        f"bending, {100 * r.contact_share:.1f} % contact",
        f"solved          {r.seconds:.1f} s CPU, {'converged' if r.converged else 'NOT converged'}",
    ]


OPERATION = Operation(
    whole,
    path=None,
    tag="yarn level",
    summary="Relax a whole chart at the yarn level",
    example={"chart": "KKK\nKKK\nKKK", "material": "acrylic", "tolerance": 0.1},
    job=True,
    command=Command(
        _lines,
        more="It repeats at its edges, and has up to 4,000 stitches. Knits and purls are free of "
        "force, other stitches are pulled evenly both ways; neither has friction. A stopped "
        "command continues where it left off.",
        names={"loop_lengths_mm": None},
        fields=loop_lengths,
    ),
)
