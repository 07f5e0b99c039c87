"""A chart for wanted stiffness, painted as a map or given part by part."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field

from app.models.charts import MAX_TEXT, ChartText
from app.operations.atlas import Cancelled, Extent, Progress, cached_atlas
from app.results.own_materials import find_material
from knitcore.chart import StitchChart
from knitcore.design.fill import FilledField, fill_field
from knitcore.design.wishes import Wish, wanted_maps
from knitcore.errors import InputError
from knitcore.garment.shaped import outline_marks

MAX_STITCHES = 40_000
"""Over REST; the command line takes larger maps."""
MAX_WISHES = 200
MAX_RUNS = 40_000

Modulus = Annotated[float, Field(gt=0, le=1000, allow_inf_nan=False)] | None
Map = Annotated[list[list[Modulus]], Field(min_length=1, max_length=1000)]
Run = tuple[Annotated[int, Field(ge=0)], Annotated[int, Field(ge=0)], Annotated[int, Field(ge=1)]]


class WishInput(BaseModel):
    """Stiffness wanted in one part of the chart."""

    model_config = ConfigDict(extra="forbid")

    name: str = Field("part", min_length=1, max_length=80)
    runs: list[Run] = Field(
        min_length=1,
        max_length=MAX_RUNS,
        description="[row, first column, length] of its stitches, row 0 at the bottom.",
    )
    modulus_course_n_per_mm: Modulus = None
    modulus_wale_n_per_mm: Modulus = None

    def wish(self) -> Wish:
        """As the library knows it."""
        return Wish(
            self.name,
            tuple(self.runs),
            self.modulus_course_n_per_mm,
            self.modulus_wale_n_per_mm,
        )


class FillRequest(BaseModel):
    """Wanted moduli, stitch by stitch or part by part."""

    model_config = ConfigDict(extra="forbid")

    material: str = Field(max_length=80, examples=["acrylic"])
    modulus_course_n_per_mm: Map | None = Field(
        None, description="[row][column], the bottom row first; null is no wish."
    )
    modulus_wale_n_per_mm: Map | None = None
    rows: int | None = Field(None, ge=1, le=1000, description="Of the chart, with wishes.")
    columns: int | None = Field(None, ge=1, le=1000)
    wishes: list[WishInput] | None = Field(
        None, min_length=1, max_length=MAX_WISHES, description="Instead of the two maps."
    )
    chart: ChartText | None = Field(
        None, description="Stitches without a wish stay as they are here; filled, too, otherwise."
    )
    outline: str | None = Field(
        None,
        max_length=MAX_TEXT,
        description="Lines of x (stitch) and . (no stitch), the top row first; all stitches if "
        "left out. Wishes are for stitches alone.",
    )
    repeats: Extent = "small"
    smallest_patch: int = Field(4, ge=1, le=100, description="Smallest side of a patch.")
    seed: int = Field(0, ge=0, le=2**32 - 1, description="The same seed gives the same chart.")
    check: bool = Field(
        True,
        description="Pull the chart in the finite swatch, and choose again what departs there.",
    )


class PatchResult(BaseModel):
    """A region of one repeat."""

    repeat: str
    stitches: int
    row: int = Field(description="Of its first stitch, from 1 at the bottom left.")
    column: int
    deviation_course: float | None = Field(description="Of the repeat; null without a wish.")
    deviation_wale: float | None
    swatch_course: float | None = Field(
        description="The same of the patch as the finite swatch has it; null if it was not pulled."
    )
    swatch_wale: float | None


class FillResult(BaseModel):
    """A chart, and how near it comes."""

    rows: int
    columns: int
    chart: str
    off_share: float = Field(
        description="Share of the stitches with a wish that are off by more than 10 %."
    )
    patches: list[PatchResult]
    messages: list[str]


def run_fill(
    request: FillRequest, *, cancelled: Cancelled, progress: Progress | None = None
) -> FillResult:
    """Fill a field for the service.

    Raises
    ------
    InputError
        If the maps or wishes cannot be used, or are too large here.
    """
    course, wale = _wanted(request)
    if course.size > MAX_STITCHES:
        raise InputError(
            "target",
            f"{course.size} stitches are too many here.",
            f"Use at most {MAX_STITCHES}, or the command line.",
        )

    def tell(start: float, share: float) -> Callable[[float], None] | None:
        if progress is None:
            return None
        return lambda done: progress(round(1000 * (start + share * done)), 1000)

    building = tell(0.0, 0.3)
    atlas = cached_atlas(
        request.material,
        request.repeats,
        cancelled,
        None if building is None else lambda done, of: building(done / of),
    )
    field = fill_field(
        course,
        wale,
        find_material(request.material),
        atlas,
        kept=None if request.chart is None else StitchChart.parse(request.chart),
        stitch=None if request.outline is None else outline_marks(request.outline),
        smallest_patch=request.smallest_patch,
        seed=request.seed,
        check=request.check,
        progress=tell(0.3, 0.7),
        cancelled=cancelled,
    )
    return fill_result(field)


def _wanted(request: FillRequest) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    given = [request.modulus_course_n_per_mm, request.modulus_wale_n_per_mm]
    if request.wishes is None:
        maps = [
            _array(rows, name)
            for rows, name in zip(
                given, ("modulus_course_n_per_mm", "modulus_wale_n_per_mm"), strict=True
            )
        ]
        return maps[0], maps[1]
    if any(rows is not None for rows in given):
        raise InputError("wishes", "are given beside maps.", "Give either.")
    if request.rows is None or request.columns is None:
        raise InputError("rows", "the size of the chart is missing.", "Give rows and columns.")
    return wanted_maps(
        [wish.wish() for wish in request.wishes],
        request.rows,
        request.columns,
        smallest_patch=request.smallest_patch,
    )


def fill_result(field: FilledField) -> FillResult:
    """A filled field at the border."""
    return FillResult(
        rows=field.chart.rows,
        columns=field.chart.columns,
        chart=field.chart.text,
        off_share=field.off_share,
        patches=[
            PatchResult(
                repeat=p.repeat,
                stitches=p.stitches,
                row=p.row,
                column=p.column,
                deviation_course=_number(p.deviation_course),
                deviation_wale=_number(p.deviation_wale),
                swatch_course=_number(p.swatch_course),
                swatch_wale=_number(p.swatch_wale),
            )
            for p in field.regions
        ],
        messages=list(field.messages),
    )


def _number(value: float) -> float | None:
    return None if math.isnan(value) else value


def _array(rows: list[list[float | None]] | None, name: str) -> NDArray[np.float64]:
    if rows is None:
        raise InputError(name, "is missing.", "Give both maps, or wishes for parts of the chart.")
    if len({len(row) for row in rows}) > 1 or not rows[0]:
        raise InputError(name, "its rows differ in length.", "Give one number or null a stitch.")
    return np.array([[np.nan if v is None else v for v in row] for row in rows], dtype=float)
