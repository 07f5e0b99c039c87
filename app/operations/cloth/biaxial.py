"""A rectangle of cloth pulled outwards at all four edges."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from knitcore.cloth.cut.standard_tests import biaxial_test

from ...context import Context
from ...requests.base import EndsOfList, Floats
from ...requests.pieces import PieceTestRequest, PieceTestResult, Size, text_table
from ..registry import Command, Operation


class BiaxialRequest(PieceTestRequest):
    """A rectangle and how far its edges are pulled."""

    strain_x: float = Field(ge=0, le=5, description="Last strain along x.")
    strain_y: float = Field(ge=0, le=5, description="Last strain along y.")
    width_mm: Size = Field(100.0, description="Length along x.")
    length_mm: Size = Field(100.0, description="Length along y.")
    grain_deg: float = Field(0.0, ge=-180, le=180, description="Angle from the x axis to the rows.")


class BiaxialResult(PieceTestResult):
    """A simulated biaxial test: edges stay straight and slide along themselves."""

    kind: Literal["biaxial"] = "biaxial"
    strain_x: Floats
    strain_y: Floats
    force_x_n: Floats
    force_x_interval_n: EndsOfList
    force_y_n: Floats
    force_y_interval_n: EndsOfList
    stress_x_n_per_mm: Floats = Field(description="Force per length of the edge.")
    stress_y_n_per_mm: Floats


def biaxial(request: BiaxialRequest, context: Context) -> BiaxialResult:
    """Forces on the edges of a rectangle that is pulled in both directions.

    Raises
    ------
    InputError, CancelledError
    """
    size = request.width_mm, request.length_mm
    return BiaxialResult.of_pull(*request.pull(biaxial_test, size, context))


def _lines(r: BiaxialResult) -> list[str]:
    columns = {
        "strain x": r.strain_x,
        "strain y": r.strain_y,
        "force x N": r.force_x_n,
        "low N": r.force_x_interval_n[0],
        "high N": r.force_x_interval_n[1],
        "force y N": r.force_y_n,
        "low  N": r.force_y_interval_n[0],
        "high  N": r.force_y_interval_n[1],
    }
    return text_table(columns)


OPERATION = Operation(
    biaxial,
    tag="pieces",
    summary="Pull a rectangle in both directions",
    example={"chart": "K\nP", "material": "acrylic", "strain_x": 0.2, "strain_y": 0.1, "steps": 2},
    job=True,
    command=Command(
        _lines,
    ),
)
