"""A square of cloth sheared in a hinged frame."""

from __future__ import annotations

import math
from typing import Literal

import numpy as np
from pydantic import Field

from knitcore.cloth.cut.standard_tests import trellis_test

from ...context import Context
from ...requests.base import EndsOfList, Floats
from ...requests.pieces import PieceTestRequest, PieceTestResult, Size, text_table
from ..registry import Command, Operation


class TrellisRequest(PieceTestRequest):
    """A square and how far it is sheared."""

    angle_deg: float = Field(
        gt=0, le=68, description="Angle by which the frame's right angle closes at the last step."
    )
    side_mm: Size = Field(100.0, description="Side of the square.")
    grain_deg: float = Field(
        0.0, ge=-180, le=180, description="Angle from a bar of the frame to the rows."
    )


class TrellisResult(PieceTestResult):
    """A simulated trellis (picture frame) test."""

    kind: Literal["trellis"] = "trellis"
    angle_deg: Floats
    force_n: Floats = Field(description="Force that pulls two opposite corners of the frame apart.")
    force_interval_n: EndsOfList
    moment_n_mm: Floats = Field(description="Moment about the hinges: work per radian of shear.")
    shear_stress_n_per_mm: Floats = Field(description="Moment over the relaxed area.")


def trellis(request: TrellisRequest, context: Context) -> TrellisResult:
    """Force of a hinged frame that shears a square.

    Raises
    ------
    InputError, CancelledError
    """
    size, angle = (request.side_mm, request.side_mm), math.radians(request.angle_deg)
    test, material = request.pull(trellis_test, size, context, shear_angle=angle)
    return TrellisResult.of_pull(test, material, angle_deg=np.degrees(test.shear_angle))


def _lines(r: TrellisResult) -> list[str]:
    columns = {
        "angle °": r.angle_deg,
        "force N": r.force_n,
        "low N": r.force_interval_n[0],
        "high N": r.force_interval_n[1],
        "N·mm": r.moment_n_mm,
        "N/mm": r.shear_stress_n_per_mm,
    }
    return text_table(columns)


OPERATION = Operation(
    trellis,
    tag="pieces",
    summary="Shear a square in a hinged frame",
    example={"chart": "K", "material": "acrylic", "angle_deg": 20, "steps": 2},
    job=True,
    command=Command(
        _lines,
        more="The test is called picture frame.",
    ),
)
