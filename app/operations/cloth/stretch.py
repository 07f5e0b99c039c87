"""The stretch test of a chart: request, result, and data for the 3D view."""

import math
from pathlib import Path
from typing import Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from knitcore.base.errors import InputError
from knitcore.chart.fabric import Direction
from knitcore.chart.phases import pure_fabric
from knitcore.chart.stitch_chart import StitchChart, check_stitches
from knitcore.cloth.flat import (
    Clamps,
    EnergyModel,
    Sheet,
    StripTest,
    chart_sheet,
    pull,
    strain_at_force,
)
from knitcore.cloth.flat.coarse import MAX_DIFFERENCE, block_side
from knitcore.cloth.flat.grid import MAX_CELLS
from knitcore.cloth.flat.margins import StretchMargins, sampled_steps, stretch_margins
from knitcore.cloth.flat.strip import load_levels
from knitcore.draw.strained_stitches import spread, stitch_at, stitch_states
from knitcore.garment.shaped import outline_marks

from ...cli.options import out_option
from ...context import Context
from ...drawing.computed import StretchView
from ...requests.base import EndsOfList, Floats, IntervalResult, ResultModel
from ...requests.charts import Column, OutlineInput, Row, to_chart
from ...requests.fabrics import GaugedRequest
from ..perform import Viewed
from ..registry import Command, Operation

Array = NDArray[np.float32]

MAX_STITCHES = 40_000
"""Largest chart of a test stitch by stitch over REST; larger ones are pulled in blocks."""
MAX_IN_BLOCKS = MAX_CELLS // 4
"""Largest chart of a test in blocks, in stitches: each is first laid in quarters."""
MIXED = (
    "Forces may differ by a quarter from the chart's curve: mixed stitches first unfold, and the "
    "laws of a test can only stiffen."
)
"""Said of tests of charts of several fabrics."""
IN_BLOCKS = "The chart is large: {0} × {0} stitches count as one."
"""Said of tests in blocks of so many stitches a side."""
BLURRED = (
    f"That may change forces by {100 * MAX_DIFFERENCE['force']:.0f} % and the waist by "
    f"{100 * MAX_DIFFERENCE['waist']:.1f} % of the width, which the intervals allow for."
)
"""Said of those of several fabrics."""
MAX_VALUES = 60 * MAX_STITCHES
"""Largest number of stitches, or blocks, times steps over REST: the answer has seven numbers for
each."""


class StretchRequest(GaugedRequest):
    """A chart between two clamps, which hold the outermost stitches, and how it is pulled."""

    outline: OutlineInput = None
    direction: Direction = Field(description="Direction of the pull: along rows, or along columns.")
    strain: float | None = Field(
        None,
        gt=0,
        le=5,
        description="Last clamp-to-clamp strain: 0.5 is 50 %. Give this or a force.",
    )
    force_n: float | None = Field(
        None, gt=0, le=10_000, description="Last force on the clamps, in place of a strain."
    )
    steps: int = Field(12, ge=1, le=1000)
    clamps: Clamps = Field(
        Clamps.CLAMPED, description="Grip of the ends: held, or free to slide along the clamps."
    )
    model: EnergyModel = EnergyModel.FULL
    shear_modulus_n_per_mm: float | None = Field(
        None,
        ge=1e-4,
        le=10,
        description="Shear modulus C_xyxy in N/mm; that of the laws by default.",
    )
    width_mm: float | None = Field(
        None, ge=1, le=10_000, description="Size course-wise; from the gauge by default."
    )
    length_mm: float | None = Field(
        None, ge=1, le=10_000, description="Size wale-wise; from the gauge by default."
    )
    block: int | None = Field(
        None,
        ge=1,
        le=100,
        description="Stitches a side of the blocks that are taken for one stitch; by default 1, "
        "and more where a chart is too large for that.",
    )

    def check_parts(self, context: Context) -> None:
        """Refuse a test without one load, or one that is too large for the service."""
        if self.strain is None and self.force_n is None:
            raise InputError("strain", "is missing.", "Give a strain or a force.")
        if self.strain is not None and self.force_n is not None:
            raise InputError("force_n", "strain is given as well.", "Give one of the two.")
        if context.local:
            return
        chart = to_chart(self.chart)
        check_stitches(chart.stitches, MAX_IN_BLOCKS)
        block = self.block_of(chart, context)
        blocks = math.ceil(chart.rows / block) * math.ceil(chart.columns / block)
        if blocks > MAX_STITCHES:
            least = block_side(chart.rows, chart.columns, MAX_STITCHES)
            raise InputError(
                "block",
                f"{blocks} blocks are too many here.",
                f"Leave it out, use at least {least}, or the command line.",
            )
        if blocks * self.steps > MAX_VALUES:
            raise InputError(
                "steps",
                f"{self.steps} are too many here for a chart of this size.",
                f"Use at most {MAX_VALUES // blocks}, or the command line.",
            )

    def block_of(self, chart: StitchChart, context: Context) -> int:
        """Stitches a side of the blocks of a test."""
        most = MAX_IN_BLOCKS if context.local else MAX_STITCHES
        if self.block is not None:
            return min(self.block, max(chart.rows, chart.columns))
        return 1 if chart.rows * chart.columns <= most else block_side(chart.rows, chart.columns)


StitchValues = list[list[float]]
StitchEnds = tuple[StitchValues, StitchValues]


class StitchFields(ResultModel):
    """Values at the stitches, or at blocks of them: [step][row * columns + column], bottom row
    first; 0 where there is no stitch.
    """

    strain_course: StitchValues
    strain_wale: StitchValues
    utilisation: StitchValues = Field(
        description="Nearness to the lock-up: alpha * strain; 1 is the lock-up."
    )
    strain_course_interval: StitchEnds | None = Field(
        None, description="Interval of the strain along the pull only."
    )
    strain_wale_interval: StitchEnds | None = None
    utilisation_interval: StitchEnds


class NearestLockUp(ResultModel):
    """The place nearest to its lock-up at the last step."""

    utilisation: float
    row: Row
    column: Column
    direction: Direction
    fabric: str


class FirstTaut(ResultModel):
    """Where the tightest cloth has used 95 % of its stretch."""

    strain: float
    force_n: float


class StretchCurve(IntervalResult):
    """A simulated strip test (geometry after ISO 20932-1), not a certified test."""

    strain: Floats
    force_n: Floats
    force_interval_n: EndsOfList
    stress_n_per_mm: Floats = Field(
        description="Force per width; its relative interval is that of the force."
    )
    waist_strain: Floats
    waist_strain_interval: EndsOfList
    iterations: list[int]
    converged: bool
    seconds: float
    dofs: int
    width_mm: float
    length_mm: float
    shear_modulus_assumed: bool = Field(
        description="True if C_xyxy is the paper's assumption, not measured."
    )
    nearest_lock_up: NearestLockUp | None
    first_taut: FirstTaut | None = Field(
        description="Where the tightest cloth first runs out of stretch; null where none does."
    )
    tightest: float = Field(
        description="Share of its stretch that the tightest cloth has used at the last step."
    )
    block: int = Field(description="Stitches a side of the blocks that were taken for one.")
    messages: list[str]


class StretchResult(StretchCurve):
    """The curve of a test, with fields at its stitches."""

    kind: Literal["stretch"] = "stretch"
    id: str = Field(description="Name of this test, for the 3D view.")
    rows: int
    columns: int
    stitch_fields: StitchFields


def stretch(request: StretchRequest, context: Context) -> Viewed[StretchResult]:
    """Nonlinear strip test of the whole chart; stops when the caller disconnects.

    A test that was run a short while ago is returned from memory.
    """
    chart = to_chart(request.chart)
    test, margins = _test(chart, request, context)
    return _stitches(chart, request, test, margins)


def _test(
    chart: StitchChart, request: StretchRequest, context: Context
) -> tuple[StripTest, StretchMargins]:
    request.check_parts(context)
    material = context.material(request.material)
    total = request.steps + len(sampled_steps(request.steps))
    sheet = request.pass_to(
        chart_sheet,
        chart,
        material,
        stitch=None if request.outline is None else outline_marks(request.outline),
        size=request.relaxed_size,
        laws=None,  # those that the request chooses are in the material
        block=request.block_of(chart, context),
    )
    test = request.pass_to(
        pull,
        sheet,
        levels=load_levels(_last_strain(sheet, request, context), request.steps),
        cancelled=context.cancelled,
        progress=lambda done, _: context.progress(done, total),
    )
    margins = request.pass_to(
        stretch_margins,
        test,
        material,
        progress=lambda done: context.progress(request.steps + done, total),
        cancelled=context.cancelled,
    )
    return test, margins


def _last_strain(sheet: Sheet, request: StretchRequest, context: Context) -> float:
    """The strain that is asked for, or at which the clamps hold the force that is."""
    if request.strain is not None:
        return request.strain
    return request.pass_to(strain_at_force, sheet, cancelled=context.cancelled)


def _curve(request: StretchRequest, test: StripTest, margins: StretchMargins) -> StretchCurve:
    """The numbers of a test."""
    return StretchCurve.of(
        test,
        interval_source=margins.source,
        force_interval_n=(test.force_n / margins.force_factor, test.force_n * margins.force_factor),
        waist_strain_interval=_around(test.waist_strain, margins.waist),
        shear_modulus_assumed=request.shear_modulus_n_per_mm is None,
        nearest_lock_up=_nearest(test),
        first_taut=_first_taut(test),
        tightest=test.tightest() if test.steps else 0.0,
        block=test.sheet.block,
        messages=_messages(test, mixed=pure_fabric(to_chart(request.chart)) is None),
    )


def _messages(test: StripTest, *, mixed: bool) -> list[str]:
    """Warnings and notes on a test."""
    messages = [test.problem] if test.problem else []
    used = float(test.utilisation.max(initial=0.0))
    full = test.sheet.model.energy is EnergyModel.FULL
    if full and test.steps and test.is_past_the_law():
        first = next(step for step in range(test.steps) if test.is_past_the_law(step))
        messages.append(
            f"Do not rely on forces beyond a stretch of {100 * test.strain[first]:.0f} %."
        )
    elif used >= 1:
        messages.append(
            f"The tightest stitches stretch {used:.2f} times as far as their yarn allows: the "
            "published model leaves out where real cloth runs out of stretch."
        )
    if mixed and full:
        messages.append(MIXED)
    if (block := test.sheet.block) > 1:
        messages.append(IN_BLOCKS.format(block))
        if mixed:
            messages.append(BLURRED)
    return messages


def _stitches(
    chart: StitchChart, request: StretchRequest, test: StripTest, margins: StretchMargins
) -> Viewed[StretchResult]:
    states = stitch_states(test)
    fields = {
        "strain_course": states.strain[..., 0],
        "strain_wale": states.strain[..., 1],
        "utilisation": states.utilisation,
    }
    margin = {f"strain_{request.direction}": margins.strain, "utilisation": margins.utilisation}
    shown: dict[str, Any] = {name: _rounded(values) for name, values in fields.items()}
    for name, width in margin.items():
        shown[f"{name}_interval"] = [_rounded(ends) for ends in _around(fields[name], width)]
    result = StretchResult(
        **dict(_curve(request, test, margins)),
        rows=chart.rows,
        columns=chart.columns,
        id=OPERATION.key(request),
        stitch_fields=shown,
    )
    if test.sheet.block > 1:
        states = spread(states, chart.rows, chart.columns)
    view = StretchView(
        direction=request.direction,
        positions_mm=states.positions_mm,
        strain=states.strain.astype(np.float32),
        utilisation=states.utilisation.astype(np.float32),
    )
    return Viewed(result, view)


def _rounded(values: NDArray[np.float64]) -> list[list[float]]:
    """A list per step, to four digits, which is finer than any colour scale shows."""
    lists: list[list[float]] = np.round(
        values.reshape(len(values), math.prod(values.shape[1:])), 4
    ).tolist()
    return lists


def _around(
    values: NDArray[np.float64], margin: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """An interval by its half width."""
    return values - margin, values + margin


def _first_taut(test: StripTest) -> FirstTaut | None:
    taut = test.first_taut
    return None if taut is None else FirstTaut(strain=taut[0], force_n=taut[1])


def _nearest(test: StripTest) -> NearestLockUp | None:
    spot = test.nearest_lock_up
    if spot is None:
        return None
    row, column = stitch_at(test, spot)
    return NearestLockUp.of(spot, row=row, column=column)


@out_option("--out", help="Write fields to FILE.npz or .vtu.", suffixes=(".npz", ".vtu"))
def _command(request: StretchRequest, context: Context, out: Path | None) -> StretchCurve:
    chart = to_chart(request.chart)
    test, margins = _test(chart, request, context)
    if out is not None:
        test.write(out)
    return _curve(request, test, margins)


def _lines(curve: StretchCurve) -> list[str]:
    lines = [f"{'strain':>8} {'force N':>9} {'90 %':>17} {'N/mm':>8} {'waist':>8}"]
    rows = zip(
        curve.strain,
        curve.force_n,
        *curve.force_interval_n,
        curve.stress_n_per_mm,
        curve.waist_strain,
        strict=True,
    )
    lines += [
        f"{e:8.3f} {f:9.3f} {low:8.3f}-{high:<8.3f} {s:8.4f} {w:8.3f}"
        for e, f, low, high, s, w in rows
    ]
    if curve.first_taut is not None:
        taut = curve.first_taut
        lines.append(
            f"the tightest stitches run out of stretch at {taut.strain:.0%} ({taut.force_n:.3g} N)"
        )
    if curve.nearest_lock_up is not None:
        spot = curve.nearest_lock_up
        lines.append(
            f"nearest to lock-up: {spot.utilisation:.0%} {spot.direction}-wise in {spot.fabric}, "
            f"row {spot.row + 1}, stitch {spot.column + 1}"
        )
    return lines


OPERATION = Operation(
    stretch,
    tag="stretch",
    summary="Pull a chart between two clamps",
    most_stitches=MAX_IN_BLOCKS,
    example={
        "chart": {"fabric": "garter", "columns": 4, "rows": 4},
        "material": "acrylic",
        "direction": "wale",
        "strain": 0.3,
        "steps": 3,
    },
    job=True,
    command=Command(_lines, more="It is simulated, not certified.", run=_command),
)
