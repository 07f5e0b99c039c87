"""Relaxing a whole chart at the yarn level, as a job that continues where it was stopped."""

from dataclasses import asdict
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import BeforeValidator, Field

from knitcore.chart.stitch_chart import size_in_words
from knitcore.materials.law_uncertainty import YARN_LEVEL_ERRORS
from knitcore.yarn.model.conventions import Convention
from knitcore.yarn.solve.splines import size_intervals
from knitcore.yarn.study.whole_chart import MAX_ROUNDS, WholeShape, relax_whole

from ...cli.options import loop_lengths
from ...context import Context
from ...requests.base import Ends, Floats, IntervalResult, ResultModel, listed
from ...requests.charts import ChartInput, to_chart
from ...requests.yarn_level import RowLengthsRequest, YarnResult, lengths_of
from ..registry import Command, Operation


class WholeRequest(RowLengthsRequest):
    """A chart, its yarn, and when to stop."""

    chart: ChartInput  # as it stands, so that a fabric needs a size
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


class WholeResult(IntervalResult):
    """The shape of a whole chart, free of force; sizes and energies of its mean stitch."""

    kind: Literal["whole"] = "whole"
    rows: int
    columns: int
    cell_course_mm: float
    cell_wale_mm: float
    cell_course_interval_mm: Ends = Field(description="90 % interval for knitted cloth.")
    cell_wale_interval_mm: Ends
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

    def sheet(self) -> WholeShape:
        """The shape as an object of the library."""
        arrays = {
            name: np.array(getattr(self, name)) for name in ("controls", "sizes_mm", "tension_n")
        }
        return WholeShape(**{**dict(self), **arrays, "rounds": tuple(self.rounds)})


def whole(request: WholeRequest, context: Context) -> WholeResult:
    """Shape of least energy of a whole chart of up to 4,000 stitches, which repeats.

    A job that was stopped, or whose machine was, continues after the last round that ended.
    """
    chart = to_chart(request.chart)
    request = request.with_row_lengths(context)
    used = request.yarn(chart, context)
    deciding = {"flat", "convention"}
    if request.loop_lengths_mm is not None:
        deciding.add("loop_lengths_mm")
    inputs: dict[str, Any] = {
        "chart": chart.text,
        "used": asdict(used),
        "asked": request.model_dump(mode="json", include=deciding),
    }
    rows = len(request.loop_lengths_mm or [])  # of the chart, or of its repeat
    lengths = lengths_of(request, used, rows or chart.rows, chart.columns)
    before = context.kept.stored(KeptSheet, inputs)
    relaxed = request.pass_to(
        relax_whole, chart, used.yarn, lengths,
        resume=None if before is None else before.sheet(),
        kept=lambda sheet: context.kept.keep(inputs, KeptSheet.of(sheet)),
        progress=context.progress, cancelled=context.cancelled,
    )  # fmt: skip
    after = 0 if before is None else before.earlier + len(before.rounds)
    resumed = f"Continued after {after} round{'' if after == 1 else 's'} of an earlier run."
    course, wale = size_intervals(relaxed)
    return WholeResult.of(
        relaxed,
        rows=chart.rows,
        columns=chart.columns,
        notes=[*relaxed.notes, resumed] if after else [*relaxed.notes],
        cell_course_interval_mm=course,
        cell_wale_interval_mm=wale,
        interval_source=YARN_LEVEL_ERRORS,
        yarn=YarnResult.of_chart(used),
        centre_lines_mm=[line.tolist() for line in relaxed.centre_lines]
        if request.centre_lines
        else None,
    )


def _lines(r: WholeResult) -> list[str]:
    wide, high = r.cell_course_interval_mm, r.cell_wale_interval_mm
    return [
        f"chart           {size_in_words(r.columns, r.rows)}",
        f"stitch          {r.cell_course_mm:.3f} mm wide ({wide[0]:.2f} to {wide[1]:.2f}), "
        f"{r.cell_wale_mm:.3f} mm high ({high[0]:.2f} to {high[1]:.2f})",
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
        more="Its edges are free. It has up to 4,000 stitches, free of force and without friction. "
        "A stopped command continues where it left off.",
        names={"loop_lengths_mm": None},
        fields=loop_lengths,
    ),
)
