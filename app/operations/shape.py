"""A chart that takes a wanted outline when it is stretched."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from app.operations.atlas import Cancelled, Extent, Progress, cached_atlas
from app.results.own_materials import find_material
from knitcore.design.shape import ShapedSwatch, fill_shape
from knitcore.fabric import Direction

Width = Annotated[float, Field(gt=0.05, lt=3, allow_inf_nan=False)] | None


class ShapeRequest(BaseModel):
    """A profile of widths under a stretch."""

    model_config = ConfigDict(extra="forbid")

    material: str = Field(max_length=80, examples=["acrylic"])
    direction: Direction = Field(Direction.WALE, description="Of the pull.")
    strain: float = Field(gt=0, le=5, allow_inf_nan=False, description="From clamp to clamp.")
    width: list[Width] = Field(
        min_length=3,
        max_length=1000,
        description="Stretched width over width at rest, line by line across the pull, from the "
        "bottom (wale-wise) or the left (course-wise); null is no wish.",
    )
    across: int = Field(ge=3, le=1000, description="Stitches of a line.")
    repeats: Extent = "small"
    smallest_band: int = Field(4, ge=1, le=100, description="Lines of the narrowest band.")
    seed: int = Field(0, ge=0, le=2**32 - 1, description="The same seed gives the same chart.")


class BandResult(BaseModel):
    """Lines of one repeat."""

    repeat: str
    first: int = Field(description="From 1, at the bottom or the left.")
    lines: int


class ShapeResult(BaseModel):
    """A chart, and the outline of its swatch."""

    rows: int
    columns: int
    chart: str
    bands: list[BandResult]
    width: list[float] = Field(description="As the finite swatch has it, beside what was wanted.")
    wanted: list[float | None]
    rms: float = Field(description="Of the differences, as parts of the width at rest.")
    largest: float
    force_n: float
    pulls: int = Field(description="Swatches that were pulled on the way.")
    messages: list[str]


def run_shape(
    request: ShapeRequest, *, cancelled: Cancelled, progress: Progress | None = None
) -> ShapeResult:
    """Fill a shape for the service."""
    atlas = cached_atlas(request.material, request.repeats, cancelled)
    found = fill_shape(
        np.array([np.nan if w is None else w for w in request.width], dtype=float),
        request.across,
        request.direction,
        request.strain,
        find_material(request.material),
        atlas,
        smallest_band=request.smallest_band,
        seed=request.seed,
        progress=None if progress is None else lambda done: progress(round(1000 * done), 1000),
        cancelled=cancelled,
    )
    return shape_result(found)


def shape_result(found: ShapedSwatch) -> ShapeResult:
    """A shaped swatch at the border."""
    return ShapeResult(
        rows=found.chart.rows,
        columns=found.chart.columns,
        chart=found.chart.text,
        bands=[BandResult(repeat=b.repeat, first=b.first, lines=b.lines) for b in found.bands],
        width=[round(w, 5) for w in found.width.tolist()],
        wanted=[None if np.isnan(w) else w for w in found.wanted.tolist()],
        rms=found.rms,
        largest=found.largest,
        force_n=found.force_n,
        pulls=found.pulls,
        messages=list(found.messages),
    )
