"""The drape coefficient of a fabric, simulated."""

from __future__ import annotations

from typing import Literal

import numpy as np
from pydantic import Field

from knitcore.cloth.space.drape import ACROSS, DISC_MM, MAX_ACROSS, PIECE_MM
from knitcore.cloth.space.drape import drape as drape_cloth
from knitcore.draw.body import Body

from ...context import Context
from ...drawing.computed import PosedView
from ...requests.base import Ends, ResultModel
from ...requests.charts import RepeatInput, to_repeat
from ...requests.weighed import (
    ClothPiece,
    Corners,
    WantsCorners,
    WeighedRequest,
    cloth_piece,
    corner_lists,
    notes_of,
)
from ..perform import Viewed
from ..registry import Command, Operation

DISC_THICK_MM = 10.0
"""Thickness of the disc in the 3D view, mm."""


class DrapeRequest(WeighedRequest):
    """A fabric, and the sizes of the test."""

    chart: RepeatInput
    piece_mm: float = Field(PIECE_MM, ge=20, le=2000, description="Diameter of the round piece.")
    disc_mm: float = Field(DISC_MM, ge=10, le=1900, description="Diameter of the disc.")
    across: int = Field(
        ACROSS, ge=10, le=MAX_ACROSS, description="Rectangles of the sheet across the piece."
    )
    corners: WantsCorners = False


class DrapeResult(ResultModel):
    """The draped piece in the state of least energy of those found."""

    kind: Literal["drape"] = "drape"
    coefficient: float = Field(
        description="Share of the ring outside the disc that its shadow covers: 1 for a board."
    )
    coefficient_of_states: Ends = Field(
        description="Smallest and largest coefficient of the states: draped cloth has several."
    )
    folds: int = Field(description="Number of folds around the rim.")
    fall_mm: float = Field(description="Height from the disc down to the lowest point.")
    bending_length_course_mm: float
    bending_length_wale_mm: float
    weight_g_per_m2: float
    converged: bool
    piece: ClothPiece
    corners_mm: Corners = None
    notes: list[str]


def drape(request: DrapeRequest, context: Context) -> Viewed[DrapeResult]:
    """A round piece drapes over a disc by its weight; its shadow gives the drape coefficient.

    Raises
    ------
    InputError, ConvergenceError, CancelledError
    """
    repeat = to_repeat(request.chart)
    cloth = request.cloth(repeat, context)
    draped = request.pass_to(drape_cloth, cloth, cancelled=context.cancelled)
    rectangle = request.piece_mm / request.across
    piece, corners = cloth_piece(
        draped.corners_mm, (rectangle, rectangle), cloth, repeat, OPERATION.key(request)
    )
    result = DrapeResult.of(
        draped,
        piece=piece,
        weight_g_per_m2=cloth.weight_g_per_m2,
        coefficient_of_states=(min(draped.coefficients), max(draped.coefficients)),
        bending_length_course_mm=cloth.bending_length_mm(0),
        bending_length_wale_mm=cloth.bending_length_mm(1),
        corners_mm=corner_lists(draped.corners_mm, np.isfinite(draped.corners_mm[..., 0]))
        if request.corners
        else None,
        notes=notes_of(cloth),
    )
    return Viewed(result, PosedView(corners, Body.disc(request.disc_mm, DISC_THICK_MM)).upright())


def _lines(r: DrapeResult) -> list[str]:
    low, high = r.coefficient_of_states
    return [
        f"drape coefficient  {r.coefficient:.0%} ({low:.0%} to {high:.0%} in the states found)"
        + ("" if r.converged else "  NOT converged"),
        f"folds              {r.folds}",
        f"fall               {r.fall_mm:.0f} mm",
        f"bending length     {r.bending_length_course_mm:.1f} mm along rows, "
        f"{r.bending_length_wale_mm:.1f} mm along columns",
        f"weight             {r.weight_g_per_m2:.0f} g/m²",
    ]


OPERATION = Operation(
    drape,
    tag="mechanics",
    summary="Drape coefficient: a round piece over a disc",
    example={
        "chart": "K/P",
        "material": "acrylic",
        "linear_density_g_per_m": 0.5,
        "across": 10,
    },
    job=True,
    command=Command(
        _lines,
        more="The result is Cusick's drape coefficient.",
        names={"corners": None},
    ),
)
