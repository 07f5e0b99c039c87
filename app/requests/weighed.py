"""Requests that need the yarn's weight, and corners in answers."""

from __future__ import annotations

from typing import Annotated

import numpy as np
from numpy.typing import NDArray
from pydantic import Field

from knitcore.base.arrays import Array
from knitcore.chart.stitch_chart import StitchChart
from knitcore.cloth.space.even_cloth import EvenCloth, cloth_of, stitched
from knitcore.draw.body import Floats
from knitcore.garment.shaped import ShapedChart

from ..context import Context
from .base import ResultModel
from .charts import CellLines, ChartLines, MaterialName
from .fabrics import LawsRequest

LinearDensity = Annotated[
    float,
    Field(
        gt=0,
        le=20,
        description="Linear density of the yarn, g/m (tex divided by 1000): weigh some metres.",
    ),
]
Corner = tuple[float, float, float] | None
Corners = Annotated[
    list[list[Corner]] | None,
    Field(description="Corners of the sheet line by line, mm; null outside the piece."),
]
WantsCorners = Annotated[bool, Field(description="Also return the corners of the sheet.")]
TimeLimit = Annotated[
    float,
    Field(
        gt=0,
        le=600,
        description="CPU time after which the current shape is returned, not converged.",
    ),
]
FRICTIONLESS = (
    "Friction is left out, and so is what washing or pressing sets. Friction makes real "
    "fabric seem stiffer, and can hold it in more than one shape."
)
FROM_QUARTERS = (
    "The repeat is too large for the yarn level, so its bending is the mean of the pure fabrics in "
    "it, without the stiffness that folds add."
)
_CURLS = (
    "This fabric curls. The test is not meant for fabric that rolls up, so it was calculated as if "
    "it lay flat at rest."
)


class WeighedRequest(LawsRequest):
    """A material and the weight of its yarn."""

    material: MaterialName
    linear_density_g_per_m: LinearDensity

    def cloth(self, repeat: StitchChart, context: Context) -> EvenCloth:
        """Cloth of a repeat."""
        density = self.linear_density_g_per_m
        return cloth_of(repeat, context.material(self.material), linear_density_g_per_m=density)


def notes_of(cloth: EvenCloth) -> list[str]:
    """Notes on what a test of cloth that is flat at rest leaves out."""
    return [
        FRICTIONLESS,
        *([_CURLS] if cloth.curls else []),
        *([FROM_QUARTERS] if cloth.from_quarters else []),
    ]


class ClothPiece(ResultModel):
    """The stitches of a piece of cloth in a test, to show them in 3D: chart and shape."""

    id: str = Field(description="Name of the shape, for 3D views of this chart.")
    chart: ChartLines
    outline: CellLines


def cloth_piece(
    corners_mm: Array,
    rectangle_mm: tuple[float, float],
    cloth: EvenCloth,
    repeat: StitchChart,
    identifier: str,
) -> tuple[ClothPiece, Floats]:
    """The stitches of a sheet of rectangles, and their corners; lines follow the columns."""
    laid = stitched(corners_mm, rectangle_mm, cloth.stitch_mm, repeat)
    outline = ShapedChart(laid.chart, laid.stitches).outline
    piece = ClothPiece(id=identifier, chart=laid.chart.text, outline=outline)
    return piece, laid.corners_mm


def corner_lists(corners_mm: Array, there: NDArray[np.bool_]) -> list[list[Corner]]:
    """Corners (lines, points, 3) as an answer has them, null where there are none."""
    lines = zip(corners_mm.round(3).tolist(), there.tolist(), strict=True)
    return [
        [tuple(at) if known else None for at, known in zip(*line, strict=True)] for line in lines
    ]
