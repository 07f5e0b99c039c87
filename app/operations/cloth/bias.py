"""A strip cut at an angle to its rows, pulled between clamps."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from knitcore.cloth.cut.standard_tests import bias_test

from ...context import Context
from ...requests.base import EndsOfList, Floats
from ...requests.pieces import PieceTestRequest, PieceTestResult, Size, text_table
from ..registry import Command, Operation


class BiasRequest(PieceTestRequest):
    """A strip and how far it is pulled."""

    strain: float = Field(gt=0, le=5, description="Last clamp-to-clamp strain: 0.5 is 50 %.")
    width_mm: Size = Field(50.0, description="Distance between the free sides.")
    length_mm: Size = Field(100.0, description="Distance between the clamps.")
    angle_deg: float = Field(
        45.0,
        ge=-180,
        le=180,
        description="Angle from the width to the rows: 0 pulls along columns, 90 along rows.",
    )


class BiasResult(PieceTestResult):
    """A simulated strip test at an angle, not a certified one."""

    kind: Literal["bias"] = "bias"
    strain: Floats
    force_n: Floats = Field(description="Force along the pull.")
    force_interval_n: EndsOfList
    sideways_n: Floats = Field(
        description="Force across the pull: the clamps keep the cloth from shearing sideways."
    )
    stress_n_per_mm: Floats = Field(description="Force per width.")
    waist_strain: Floats


def bias(request: BiasRequest, context: Context) -> BiasResult:
    """Force and waist of a strip cut at an angle, on the bias by default.

    Raises
    ------
    InputError, CancelledError
    """
    size = request.width_mm, request.length_mm
    return BiasResult.of_pull(*request.pull(bias_test, size, context))


def _lines(r: BiasResult) -> list[str]:
    columns = {
        "strain": r.strain,
        "force N": r.force_n,
        "low N": r.force_interval_n[0],
        "high N": r.force_interval_n[1],
        "sideways N": r.sideways_n,
        "waist": r.waist_strain,
    }
    return text_table(columns)


OPERATION = Operation(
    bias,
    tag="pieces",
    summary="Pull a strip cut at an angle",
    example={"chart": "K", "material": "acrylic", "strain": 0.2, "steps": 2, "mesh_mm": 10},
    job=True,
    command=Command(
        _lines,
        more="It is cut on the bias by default.",
    ),
)
