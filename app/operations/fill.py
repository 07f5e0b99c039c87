"""A chart for a painted map of stiffness."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field

from app.operations.atlas import Extent, cached_atlas
from knitcore.design.fill import FilledField, fill_field
from knitcore.errors import InputError
from knitcore.materials import material as find_material

MAX_STITCHES = 10_000
"""Over REST; the command line takes larger maps."""

Wish = Annotated[float, Field(gt=0, le=1000, allow_inf_nan=False)] | None
Map = Annotated[list[list[Wish]], Field(min_length=1, max_length=1000)]


class FillRequest(BaseModel):
    """Wanted moduli, stitch by stitch; null is no wish."""

    model_config = ConfigDict(extra="forbid")

    material: str = Field(max_length=80, examples=["acrylic"])
    modulus_course_n_per_mm: Map = Field(description="[row][column], the bottom row first.")
    modulus_wale_n_per_mm: Map
    repeats: Extent = "small"
    smallest_patch: int = Field(4, ge=1, le=100, description="Smallest side of a patch.")
    seed: int = Field(0, ge=0, le=2**32 - 1, description="The same seed gives the same chart.")


class PatchResult(BaseModel):
    """A region of one repeat."""

    repeat: str
    stitches: int
    row: int = Field(description="Of its first stitch, from 1 at the bottom left.")
    column: int
    deviation_course: float | None = Field(description="Of the repeat; null without a wish.")
    deviation_wale: float | None


class FillResult(BaseModel):
    """A chart, and how near it comes."""

    rows: int
    columns: int
    chart: str
    off_share: float = Field(description="Share of stitches off by more than 10 %.")
    patches: list[PatchResult]
    messages: list[str]


def run_fill(request: FillRequest, *, cancelled: Callable[[], bool]) -> FillResult:
    """Fill a field for the service.

    Raises
    ------
    InputError
        If the maps cannot be used, or are too large here.
    """
    course, wale = (
        _array(rows, name)
        for rows, name in (
            (request.modulus_course_n_per_mm, "modulus_course_n_per_mm"),
            (request.modulus_wale_n_per_mm, "modulus_wale_n_per_mm"),
        )
    )
    if course.size > MAX_STITCHES:
        raise InputError(
            "target",
            f"{course.size} stitches are too many here.",
            f"Use at most {MAX_STITCHES}, or the command line.",
        )
    atlas = cached_atlas(request.material, request.repeats, cancelled)
    field = fill_field(
        course,
        wale,
        find_material(request.material),
        atlas,
        smallest_patch=request.smallest_patch,
        seed=request.seed,
        cancelled=cancelled,
    )
    return fill_result(field)


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
            )
            for p in field.regions
        ],
        messages=list(field.messages),
    )


def _number(value: float) -> float | None:
    return None if math.isnan(value) else value


def _array(rows: list[list[float | None]], name: str) -> NDArray[np.float64]:
    if len({len(row) for row in rows}) > 1 or not rows[0]:
        raise InputError(name, "its rows differ in length.", "Give one number or null a stitch.")
    return np.array([[np.nan if v is None else v for v in row] for row in rows], dtype=float)
