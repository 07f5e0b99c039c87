"""Tests of cut cloth: a strip at an angle, a rectangle pulled both ways, a sheared square."""

import math
from typing import Literal

import numpy as np
from pydantic import Field

from knitcore.cloth.cut import CutPiece
from knitcore.cloth.cut.standard_tests import bias_test, biaxial_test, trellis_test

from ...context import Context
from ...requests.base import EndsOfList, Floats
from ...requests.pieces import PieceTestRequest, PieceTestResult, Size
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

    def cut(self) -> CutPiece:
        """The rectangle that is tested."""
        return CutPiece.rectangle(self.width_mm, self.length_mm)


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


class BiaxialRequest(PieceTestRequest):
    """A rectangle and how far its edges are pulled."""

    strain_x: float = Field(ge=0, le=5, description="Last strain along x.")
    strain_y: float = Field(ge=0, le=5, description="Last strain along y.")
    width_mm: Size = Field(100.0, description="Length along x.")
    length_mm: Size = Field(100.0, description="Length along y.")
    grain_deg: float = Field(0.0, ge=-180, le=180, description="Angle from the x axis to the rows.")

    def cut(self) -> CutPiece:
        """The rectangle that is tested."""
        return CutPiece.rectangle(self.width_mm, self.length_mm)


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


class TrellisRequest(PieceTestRequest):
    """A square and how far it is sheared."""

    angle_deg: float = Field(
        gt=0, le=68, description="Angle by which the frame's right angle closes at the last step."
    )
    side_mm: Size = Field(100.0, description="Side of the square.")
    grain_deg: float = Field(
        0.0, ge=-180, le=180, description="Angle from a bar of the frame to the rows."
    )

    def cut(self) -> CutPiece:
        """The square that is tested."""
        return CutPiece.rectangle(self.side_mm, self.side_mm)


class TrellisResult(PieceTestResult):
    """A simulated trellis (picture frame) test."""

    kind: Literal["trellis"] = "trellis"
    angle_deg: Floats
    force_n: Floats = Field(description="Force that pulls two opposite corners of the frame apart.")
    force_interval_n: EndsOfList
    moment_n_mm: Floats = Field(description="Moment about the hinges: work per radian of shear.")
    shear_stress_n_per_mm: Floats = Field(description="Moment over the relaxed area.")


def bias(request: BiasRequest, context: Context) -> BiasResult:
    """Force and waist of a strip cut at an angle, on the bias by default."""
    return BiasResult.of_pull(*request.pull(bias_test, context))


def biaxial(request: BiaxialRequest, context: Context) -> BiaxialResult:
    """Forces on the edges of a rectangle that is pulled in both directions."""
    return BiaxialResult.of_pull(*request.pull(biaxial_test, context))


def trellis(request: TrellisRequest, context: Context) -> TrellisResult:
    """Force of a hinged frame that shears a square."""
    angle = math.radians(request.angle_deg)
    test, material = request.pull(trellis_test, context, shear_angle=angle)
    return TrellisResult.of_pull(test, material, angle_deg=np.degrees(test.shear_angle))


def _table(heads: str, *columns: list[float]) -> list[str]:
    """Lines of a table; headings are parted by commas."""
    return [
        " ".join(f"{head:>12}" for head in heads.split(",")),
        *(" ".join(f"{value:12.4f}" for value in row) for row in zip(*columns, strict=True)),
    ]


def _bias_lines(r: BiasResult) -> list[str]:
    heads = "strain,force N,low N,high N,sideways N,waist"
    return _table(heads, r.strain, r.force_n, *r.force_interval_n, r.sideways_n, r.waist_strain)


def _biaxial_lines(r: BiaxialResult) -> list[str]:
    along_x = r.force_x_n, *r.force_x_interval_n
    along_y = r.force_y_n, *r.force_y_interval_n
    heads = "strain x,strain y,force x N,low N,high N,force y N,low  N,high  N"
    return _table(heads, r.strain_x, r.strain_y, *along_x, *along_y)


def _trellis_lines(r: TrellisResult) -> list[str]:
    force = r.force_n, *r.force_interval_n
    heads = "angle °,force N,low N,high N,N·mm,N/mm"
    return _table(heads, r.angle_deg, *force, r.moment_n_mm, r.shear_stress_n_per_mm)


BIAS = Operation(
    bias,
    tag="pieces",
    summary="Pull a strip cut at an angle",
    example={"chart": "K", "material": "acrylic", "strain": 0.2, "steps": 2, "mesh_mm": 10},
    job=True,
    command=Command(_bias_lines, more="It is cut on the bias by default."),
)
BIAXIAL = Operation(
    biaxial,
    tag="pieces",
    summary="Pull a rectangle in both directions",
    example={"chart": "K\nP", "material": "acrylic", "strain_x": 0.2, "strain_y": 0.1, "steps": 2},
    job=True,
    command=Command(_biaxial_lines),
)
TRELLIS = Operation(
    trellis,
    tag="pieces",
    summary="Shear a square in a hinged frame",
    example={"chart": "K", "material": "acrylic", "angle_deg": 20, "steps": 2},
    job=True,
    command=Command(_trellis_lines, more="The test is called picture frame."),
)
