"""Peirce's bending length of a fabric, simulated."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from pydantic import Field

from knitcore.chart.fabric import Direction
from knitcore.cloth.space.overhang import overhang as hang_over
from knitcore.draw.body import Body

from ...context import Context
from ...drawing.computed import PosedView
from ...requests.base import ResultModel
from ...requests.charts import RepeatInput, to_repeat
from ...requests.weighed import (
    ClothPiece,
    Corners,
    WantsCorners,
    WeighedRequest,
    cloth_piece,
    notes_of,
)
from ..perform import Viewed
from ..registry import Command, Operation

TABLE_MM = 40.0
"""Depth of the table in the 3D view, from its edge to the back, mm."""


class OverhangRequest(WeighedRequest):
    """A fabric, and how far a strip of it hangs over the edge of a table."""

    chart: RepeatInput
    direction: Direction = Field(
        Direction.COURSE, description="Direction of the chart that runs along the strip."
    )
    overhang_mm: float | None = Field(
        None,
        gt=0,
        le=2000,
        description="Overhang; by default the length whose tip drops 41.5° (Peirce).",
    )
    corners: WantsCorners = False


class OverhangResult(ResultModel):
    """A strip at rest."""

    kind: Literal["overhang"] = "overhang"
    overhang_mm: float
    angle_deg: float = Field(
        description="Angle of the line from the edge to the tip, below the horizontal."
    )
    reach_mm: float = Field(description="Horizontal distance from the edge to the tip.")
    fall_mm: float = Field(description="Height from the edge down to the tip.")
    bending_length_mm: float = Field(
        description="Bending length by Peirce's formula, from overhang and angle."
    )
    rigidity_n_mm: float = Field(
        description="Rigidity: weight per area times the bending length cubed."
    )
    yarn_level_rigidity_n_mm: float = Field(description="Rigidity with which the strip was bent.")
    weight_g_per_m2: float
    converged: bool
    piece: ClothPiece
    corners_mm: Corners = None
    notes: list[str]


def overhang(request: OverhangRequest, context: Context) -> Viewed[OverhangResult]:
    """A strip 25 mm wide bends over the edge of a table by its weight, as in Peirce's test.

    Raises
    ------
    InputError, ConvergenceError, CancelledError
    """
    repeat = to_repeat(request.chart)
    cloth = request.cloth(repeat, context)
    axis = 0 if request.direction is Direction.COURSE else 1
    strip = hang_over(cloth, axis, request.overhang_mm, cancelled=context.cancelled)
    if axis == 0:
        sheet, rectangle = strip.corners_mm.transpose(1, 0, 2), strip.rectangle_mm
    else:  # turned about the vertical, so that the face stays above
        sheet, rectangle = strip.corners_mm[:, ::-1], strip.rectangle_mm[::-1]
    piece, corners = cloth_piece(sheet, rectangle, cloth, repeat, OPERATION.key(request))
    table = TABLE_MM * np.array([(-1.0, -0.5), (0.0, -0.5), (0.0, 0.5), (-1.0, 0.5)])
    result = OverhangResult.of(
        strip,
        piece=piece,
        weight_g_per_m2=cloth.weight_g_per_m2,
        angle_deg=math.degrees(strip.angle_rad),
        yarn_level_rigidity_n_mm=cloth.rigidity_n_mm[axis],
        corners_mm=strip.corners_mm.round(3).tolist() if request.corners else None,
        notes=notes_of(cloth),
    )
    return Viewed(result, PosedView(corners, Body.slab(table, 0.25 * TABLE_MM)).upright())


def _lines(r: OverhangResult) -> list[str]:
    return [
        f"overhang        {r.overhang_mm:.0f} mm falls by {r.angle_deg:.1f}°",
        f"bending length  {r.bending_length_mm:.1f} mm",
        f"rigidity        {r.rigidity_n_mm:.4f} N·mm (yarn level {r.yarn_level_rigidity_n_mm:.4f})",
        f"weight          {r.weight_g_per_m2:.0f} g/m²",
    ]


OPERATION = Operation(
    overhang,
    tag="mechanics",
    summary="Peirce's bending length: a strip over the edge of a table",
    example={"chart": "K/P", "material": "acrylic", "linear_density_g_per_m": 0.5},
    job=True,
    command=Command(
        _lines,
        more="The result is Peirce's bending length.",
        names={"corners": None},
    ),
)
