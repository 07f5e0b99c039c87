"""The stretch test of a chart: what is asked, what comes back, and what the 3D view needs of it."""

from __future__ import annotations

import hashlib
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field
from scipy.ndimage import distance_transform_edt

from app.http.packed import packed
from app.models.charts import MAX_TEXT, ChartInput, PureFabricChart, to_chart
from app.operations.stretch_margins import StretchMargins, sampled_steps, stretch_margins
from app.results.own_materials import find_material
from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.fabric import Direction
from knitcore.garment.shaped import outline_marks
from knitcore.law.stiffening import EXTENSION_START
from knitcore.materials import Material
from knitcore.swatch import Clamps, EnergyModel, StripTest, strip_test

Array = NDArray[np.float32]

MAX_STITCHES = 40_000
"""Largest chart of a test over REST; the command line takes larger ones."""
MAX_VALUES = 60 * MAX_STITCHES
"""Most stitches times steps over REST, for the answer has three numbers for each."""
NEAR_LOCK_UP = 0.95


class StretchOptions(BaseModel):
    """How a swatch is pulled."""

    model_config = ConfigDict(extra="forbid")

    direction: Direction
    strain: float = Field(
        gt=0, le=5, allow_inf_nan=False, description="Last clamp-to-clamp strain: 0.5 is 50 %."
    )
    steps: int = Field(12, ge=1, le=1000)
    clamps: Clamps = Field(
        Clamps.CLAMPED, description="Ends gripped, or free to slide along the clamps."
    )
    model: EnergyModel = EnergyModel.FULL
    shear_modulus_n_per_mm: float | None = Field(
        None, ge=1e-4, le=10, allow_inf_nan=False, description="Replaces the assumed C_xyxy."
    )
    width_mm: float | None = Field(None, ge=1, le=10_000, description="Size course-wise.")
    length_mm: float | None = Field(None, ge=1, le=10_000, description="Size wale-wise.")


class StretchRequest(StretchOptions):
    """A chart between two clamps."""

    chart: ChartInput
    material: str
    outline: str | None = Field(
        None,
        max_length=MAX_TEXT,
        description="Lines of x (stitch) and . (no stitch), the top row first; all stitches if "
        "left out. The clamps hold the outermost stitches.",
    )


class StitchFields(BaseModel):
    """Values at the stitches: [step][row * columns + column], bottom row first; 0 where there is
    no stitch.
    """

    strain_course: list[list[float]]
    strain_wale: list[list[float]]
    utilisation: list[list[float]] = Field(description="alpha * strain; 1 is the lock-up.")
    strain_margin: list[list[float]] = Field(
        description="Of the strain along the pull: its 90 % interval is this much to either side."
    )
    utilisation_margin: list[list[float]] = Field(description="The same of the utilisation.")


class NearestLockUp(BaseModel):
    """Where the swatch is nearest to its lock-up at the last step."""

    utilisation: float
    row: int = Field(description="From 1, bottom row first.")
    column: int = Field(description="From 1, left wale first.")
    direction: Direction
    fabric: str


class StretchCurve(BaseModel):
    """A simulated strip test (geometry after ISO 20932-1), not a certified test."""

    strain: list[float]
    force_n: list[float]
    force_low_n: list[float] = Field(description="Lower end of the 90 % interval.")
    force_high_n: list[float] = Field(description="Upper end of the 90 % interval.")
    stress_n_per_mm: list[float] = Field(description="Force per width, and as sure as the force.")
    waist_strain: list[float]
    waist_margin: list[float] = Field(description="90 % interval, to either side.")
    iterations: list[int]
    converged: bool
    seconds: float
    dofs: int
    width_mm: float
    length_mm: float
    shear_modulus_assumed: bool = Field(
        description="Whether C_xyxy is the paper's assumption; nobody measured it."
    )
    nearest_lock_up: NearestLockUp | None
    messages: list[str]


class StretchResult(StretchCurve):
    """The curve of a test and the fields at its stitches."""

    id: str = Field(description="Names this test for the 3D view.")
    rows: int
    columns: int
    stitch_fields: StitchFields


@dataclass(frozen=True, eq=False)
class StretchRun:
    """A test as the service keeps it for the 3D view.

    Attributes
    ----------
    result : what the caller gets as packed JSON, made where the test ran: megabytes of numbers
        would hold up the event loop.
    direction : of the pull.
    positions_mm : (steps, rows, columns, 2) stitch centres.
    strain : (steps, rows, columns, 2) course-wise and wale-wise.
    utilisation : (steps, rows, columns).
    """

    result: bytes
    direction: Direction
    positions_mm: Array
    strain: Array
    utilisation: Array

    @property
    def size_bytes(self) -> int:
        """About how much memory it takes."""
        arrays = (self.positions_mm, self.strain, self.utilisation)
        return len(self.result) + sum(array.nbytes for array in arrays)


def stretch_key(request: StretchRequest) -> str:
    """A name made of everything that decides the result."""
    return hashlib.sha256(request.model_dump_json().encode()).hexdigest()[:32]


def run_stretch(
    request: StretchRequest,
    *,
    cancelled: Callable[[], bool],
    progress: Callable[[int, int], None] | None = None,
) -> StretchRun:
    """Run a test for the service.

    Raises
    ------
    InputError, CancelledError
    """
    chart = to_chart(request.chart)
    if chart.rows * chart.columns > MAX_STITCHES:
        side = math.isqrt(MAX_STITCHES)
        raise InputError(
            "chart",
            f"{chart.columns}x{chart.rows} stitches are too many for a stretch test here.",
            f"Use at most {MAX_STITCHES} stitches, such as {side}x{side}, or the command line.",
        )
    if chart.rows * chart.columns * request.steps > MAX_VALUES:
        raise InputError(
            "steps",
            f"{request.steps} are too many here for a chart of this size.",
            f"Use at most {MAX_VALUES // (chart.rows * chart.columns)}, or the command line.",
        )
    material = find_material(request.material)
    samples = len(sampled_steps(request.steps))

    def tell(done: int, _of: int) -> None:
        if progress is not None:
            progress(done, request.steps + samples)

    test = stretch_chart(
        chart,
        material,
        request,
        stitch=None if request.outline is None else outline_marks(request.outline),
        cancelled=cancelled,
        progress=tell,
    )
    margins = stretch_margins(
        test,
        material,
        request.clamps,
        progress=lambda done: tell(request.steps + done, 0),
        cancelled=cancelled,
    )
    return _stitches(chart, request, test, margins)


def stretch_chart(
    chart: StitchChart,
    material: Material,
    options: StretchOptions,
    *,
    stitch: NDArray[np.bool_] | None = None,
    cancelled: Callable[[], bool] | None = None,
    progress: Callable[[int, int], None] | None = None,
) -> StripTest:
    """The strip test of any chart and material; ``stitch`` (rows, columns) of a shaped piece."""
    return strip_test(
        chart,
        material,
        options.direction,
        options.strain,
        steps=options.steps,
        clamps=options.clamps,
        model=options.model,
        shear_modulus=options.shear_modulus_n_per_mm,
        stitch=stitch,
        width_mm=options.width_mm,
        length_mm=options.length_mm,
        cancelled=cancelled,
        progress=progress,
    )


def stretch_curve(
    chart: StitchChart, options: StretchOptions, test: StripTest, margins: StretchMargins
) -> StretchCurve:
    """The numbers of a test."""
    return StretchCurve(
        strain=test.strain.tolist(),
        force_n=test.force_n.tolist(),
        force_low_n=(test.force_n / margins.force_factor).tolist(),
        force_high_n=(test.force_n * margins.force_factor).tolist(),
        stress_n_per_mm=test.stress_n_per_mm.tolist(),
        waist_strain=test.waist_strain.tolist(),
        waist_margin=margins.waist.tolist(),
        iterations=list(test.iterations),
        converged=test.converged,
        seconds=test.seconds,
        dofs=test.dofs,
        width_mm=test.sheet.grid.width_mm,
        length_mm=test.sheet.grid.length_mm,
        shear_modulus_assumed=options.shear_modulus_n_per_mm is None,
        nearest_lock_up=_nearest(chart, test),
        messages=_messages(test),
    )


def _messages(test: StripTest) -> list[str]:
    """What went wrong, and what a careful reader should know."""
    messages = [test.problem] if test.problem else []
    used = float(test.utilisation.max(initial=0.0))
    full = test.sheet.model.energy is EnergyModel.FULL
    if full and test.steps and test.is_past_the_law():
        first = next(step for step in range(test.steps) if test.is_past_the_law(step))
        messages.append(
            f"From a strain of {test.strain[first]:.3g} on some cloth is past "
            f"{EXTENSION_START:.0%} of its lock-up. There the law is only continued: the force is "
            "no fabric's."
        )
    elif used >= 1:
        messages.append(
            f"alpha times strain reaches {used:.2f}: the cloth locks at 1. The published model "
            "leaves the lock-up out, so it goes on where no cloth can follow."
        )
    elif used >= NEAR_LOCK_UP:
        messages.append(f"Some stitches are at {used:.0%} of their lock-up.")
    return messages


def warm_up(*, cancelled: Callable[[], bool]) -> None:
    """Load (and on the very first start compile) what a test needs."""
    request = StretchRequest(
        chart=PureFabricChart(fabric="garter", columns=3, rows=3),
        material="acrylic",
        direction=Direction.WALE,
        strain=0.1,
        steps=1,
    )
    run_stretch(request, cancelled=cancelled)


def _stitches(
    chart: StitchChart, request: StretchRequest, test: StripTest, margins: StretchMargins
) -> StretchRun:
    shape = (test.steps, chart.rows, chart.columns)
    ux, uy, xx, yy, used = np.zeros((5, *shape))
    for step in range(test.steps):
        at = test.fields(step)
        for values, nodes in (
            (ux, at.ux_mm),
            (uy, at.uy_mm),
            (xx, at.strain_xx),
            (yy, at.strain_yy),
            (used, at.utilisation),
        ):
            values[step] = nodes[1::2, 1::2]  # nodes lie on the quarter grid
    there = test.sheet.grid.cloth[::2, ::2]
    x = _carried(test.x_mm[1::2, 1::2], ux, xx, there)
    y = _carried(test.y_mm[1::2, 1::2], uy, yy, there)
    for values in (xx, yy, used):
        values[:, ~there] = 0.0
    result = StretchResult(
        **stretch_curve(chart, request, test, margins).model_dump(),
        id=stretch_key(request),
        rows=chart.rows,
        columns=chart.columns,
        stitch_fields=StitchFields(
            strain_course=_rounded(xx),
            strain_wale=_rounded(yy),
            utilisation=_rounded(used),
            strain_margin=_rounded(margins.strain),
            utilisation_margin=_rounded(margins.utilisation),
        ),
    )
    return StretchRun(
        result=packed(result),
        direction=request.direction,
        positions_mm=np.stack([x, y], axis=-1).astype(np.float32),
        strain=np.stack([xx, yy], axis=-1).astype(np.float32),
        utilisation=used.astype(np.float32),
    )


def _carried(
    rest_mm: NDArray[np.float64],
    moved_mm: NDArray[np.float64],
    strain: NDArray[np.float64],
    there: NDArray[np.bool_],
) -> NDArray[np.float64]:
    """Positions at each step; where there is no stitch, as the nearest one would carry it on, for
    the loops of an edge are drawn by the distances to all neighbours.
    """
    row, column = distance_transform_edt(~there, return_distances=False, return_indices=True)
    stretched = (rest_mm - rest_mm[row, column]) * (1 + strain[:, row, column])
    return np.asarray(rest_mm[row, column] + moved_mm[:, row, column] + stretched)


def _rounded(values: NDArray[np.float64]) -> list[list[float]]:
    """A list per step; four digits are finer than any colour."""
    lists: list[list[float]] = np.round(
        values.reshape(len(values), math.prod(values.shape[1:])), 4
    ).tolist()
    return lists


def _nearest(chart: StitchChart, test: StripTest) -> NearestLockUp | None:
    spot = test.nearest_lock_up
    if spot is None:
        return None
    grid = test.sheet.grid
    column = int(np.searchsorted(grid.column_lines[::2], spot.x_mm))
    row = int(np.searchsorted(grid.row_lines[::2], spot.y_mm))
    return NearestLockUp(
        utilisation=spot.utilisation,
        row=min(max(row, 1), chart.rows),
        column=min(max(column, 1), chart.columns),
        direction=spot.direction,
        fabric=spot.fabric,
    )
