"""Tests in which cloth carries its own weight: over an edge, over a disc, and with a border."""

import math
from typing import Literal

import numpy as np
from pydantic import Field

from knitcore.base.arrays import Array
from knitcore.chart.fabric import Direction, Fabric
from knitcore.chart.stitch_chart import StitchChart
from knitcore.cloth.space.even_cloth import EvenCloth, stitched
from knitcore.cloth.space.weighing import (
    ACROSS,
    DISC_MM,
    MAX_ACROSS,
    PIECE_MM,
    RULE_ROWS,
    RULE_STITCHES,
    advice,
)
from knitcore.cloth.space.weighing import drape as drape_cloth
from knitcore.cloth.space.weighing import overhang as hang_over
from knitcore.draw.body import Body
from knitcore.garment.shaped import ShapedChart

from ...context import Context
from ...drawing.computed import PosedView
from ...requests.base import Ends, ResultModel
from ...requests.charts import CellLines, ChartLines, RepeatInput, to_repeat
from ...requests.weighed import FRICTIONLESS, Corners, WantsCorners, WeighedRequest, corner_lists
from ..perform import Viewed
from ..registry import Command, Operation

TABLE_MM = 40.0
"""Depth of the table in the 3D view, from its edge to the back, mm."""
DISC_THICK_MM = 10.0
"""Thickness of the disc in the 3D view, mm."""
_FROM_QUARTERS = (
    "The repeat is too large for the yarn level, so its bending is the mean of the pure fabrics in "
    "it, without the stiffness that folds add."
)
_CURLS = (
    "This fabric curls. The test is not meant for fabric that rolls up, so it was calculated as if "
    "it lay flat at rest."
)
_RULE = (
    f"Knitters make borders of {RULE_STITCHES[0]} to {RULE_STITCHES[1]} stitches or "
    f"{RULE_ROWS} rows. These hold by friction between the yarns and by blocking, which are "
    "not modelled here."
)
_ROLLS = (
    "Where the weight of a border does not keep the piece flat, a wider border does no better: the "
    "fabric beside it rises."
)

_UNCOUNTED = (
    "The gauge is that of the piece; the border, which nobody has counted, has the computed size."
)


class ClothPiece(ResultModel):
    """The stitches of a piece of cloth in a test, to show them in 3D: chart and shape."""

    id: str = Field(description="Name of the shape, for 3D views of this chart.")
    chart: ChartLines
    outline: CellLines


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


class BorderRequest(WeighedRequest):
    """A piece and the fabric of its border."""

    chart: RepeatInput
    border: Fabric = Field(Fabric.GARTER, description="Fabric of the border.")


class EdgesResult(ResultModel):
    """A border along two opposite edges."""

    moment_n: float = Field(description="Moment per width with which the piece curls there, N.")
    width_mm: float = Field(
        description="Width of a border that its own weight just keeps from tipping over."
    )
    stitches: int = Field(description="The same width in stitches, or rows, of the border.")
    rule_share: float = Field(
        description="Share of the moment that the weight of a border by the knitters' rule holds."
    )
    holds: bool = Field(
        description="True if a border 1.2 times as wide keeps a strip on a smooth table from "
        "rolling up."
    )
    ridge_mm: float = Field(description="Height to which this strip rises beside its borders.")


class BorderResult(ResultModel):
    """Borders of a piece that lies on a table."""

    kind: Literal["border"] = "border"
    sides: EdgesResult
    ends: EdgesResult = Field(description="Borders at the top and bottom.")
    notes: list[str]


def overhang(request: OverhangRequest, context: Context) -> Viewed[OverhangResult]:
    """A strip 25 mm wide bends over the edge of a table by its weight, as in Peirce's test."""
    repeat = to_repeat(request.chart)
    cloth = request.cloth(repeat, context)
    axis = 0 if request.direction is Direction.COURSE else 1
    strip = hang_over(cloth, axis, request.overhang_mm, cancelled=context.cancelled)
    if axis == 0:
        sheet, rectangle = strip.corners_mm.transpose(1, 0, 2), strip.rectangle_mm
    else:  # turned about the vertical, so that the face stays above
        sheet, rectangle = strip.corners_mm[:, ::-1], strip.rectangle_mm[::-1]
    table = TABLE_MM * np.array([(-1.0, -0.5), (0.0, -0.5), (0.0, 0.5), (-1.0, 0.5)])
    body = Body.slab(table, 0.25 * TABLE_MM)
    piece, view = _view(cloth, repeat, sheet, rectangle, body, OVERHANG.key(request))
    result = OverhangResult.of(
        strip,
        piece=piece,
        weight_g_per_m2=cloth.weight_g_per_m2,
        angle_deg=math.degrees(strip.angle_rad),
        yarn_level_rigidity_n_mm=cloth.rigidity_n_mm[axis],
        corners_mm=strip.corners_mm.round(3).tolist() if request.corners else None,
        notes=_notes(cloth),
    )
    return Viewed(result, view)


def drape(request: DrapeRequest, context: Context) -> Viewed[DrapeResult]:
    """A round piece drapes over a disc by its weight; its shadow gives the drape coefficient."""
    repeat = to_repeat(request.chart)
    cloth = request.cloth(repeat, context)
    draped = request.pass_to(drape_cloth, cloth, cancelled=context.cancelled)
    side, body = request.piece_mm / request.across, Body.disc(request.disc_mm, DISC_THICK_MM)
    piece, view = _view(cloth, repeat, draped.corners_mm, (side, side), body, DRAPE.key(request))
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
        notes=_notes(cloth),
    )
    return Viewed(result, view)


def border(request: BorderRequest, context: Context) -> BorderResult:
    """Width of a border that keeps a piece flat on a table.

    The weight of the border balances the moment with which the piece curls; a strip of both shows
    whether that is enough.
    """
    inner = request.cloth(to_repeat(request.chart), context)
    edge = StitchChart.of_fabric(request.border, rows=2, columns=2)
    around = request.model_copy(update={"gauge": None}).cloth(edge, context)
    sides, ends = (advice(inner, around, axis, cancelled=context.cancelled) for axis in (0, 1))
    notes = [_RULE] if max(sides.moment_n, ends.moment_n) > 0.0 else []
    if not (sides.holds and ends.holds):
        notes.append(_ROLLS)
    if request.gauge:
        notes.append(_UNCOUNTED)
    if inner.from_quarters:
        notes.append(_FROM_QUARTERS)
    return BorderResult(sides=EdgesResult.of(sides), ends=EdgesResult.of(ends), notes=notes)


def _view(
    cloth: EvenCloth,
    repeat: StitchChart,
    corners_mm: Array,
    rectangle_mm: tuple[float, float],
    body: Body,
    identifier: str,
) -> tuple[ClothPiece, PosedView]:
    """The stitches of a sheet of rectangles, and their view; lines follow the columns."""
    laid = stitched(corners_mm, rectangle_mm, cloth.stitch_mm, repeat)
    outline = ShapedChart(laid.chart, laid.stitches).outline
    piece = ClothPiece(id=identifier, chart=laid.chart.text, outline=outline)
    return piece, PosedView(laid.corners_mm, body).upright()


def _notes(cloth: EvenCloth) -> list[str]:
    """Notes on what a test of cloth that is flat at rest leaves out."""
    return [
        FRICTIONLESS,
        *([_CURLS] if cloth.curls else []),
        *([_FROM_QUARTERS] if cloth.from_quarters else []),
    ]


def _overhang_lines(r: OverhangResult) -> list[str]:
    return [
        f"overhang        {r.overhang_mm:.0f} mm falls by {r.angle_deg:.1f}°",
        f"bending length  {r.bending_length_mm:.1f} mm",
        f"rigidity        {r.rigidity_n_mm:.4f} N·mm (yarn level {r.yarn_level_rigidity_n_mm:.4f})",
        f"weight          {r.weight_g_per_m2:.0f} g/m²",
    ]


def _drape_lines(r: DrapeResult) -> list[str]:
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


def _border_lines(r: BorderResult) -> list[str]:
    return [
        f"sides           {_edges(r.sides, 'stitches')}",
        f"top and bottom  {_edges(r.ends, 'rows')}",
    ]


def _edges(edges: EdgesResult, unit: str) -> str:
    if edges.moment_n == 0.0:
        return "do not curl: no border needed"
    state = "holds" if edges.holds else "rolls up all the same"
    return (
        f"{edges.moment_n:.4f} N: {edges.width_mm:.0f} mm, {edges.stitches} {unit}; {state}, ridge "
        f"{edges.ridge_mm:.0f} mm; a border by the knitters' rule holds {edges.rule_share:.0%}"
    )


OVERHANG = Operation(
    overhang,
    tag="mechanics",
    summary="Peirce's bending length: a strip over the edge of a table",
    example={"chart": "K/P", "material": "acrylic", "linear_density_g_per_m": 0.5},
    job=True,
    command=Command(
        _overhang_lines, more="The result is Peirce's bending length.", names={"corners": None}
    ),
)
DRAPE = Operation(
    drape,
    tag="mechanics",
    summary="Drape coefficient: a round piece over a disc",
    example={"chart": "K/P", "material": "acrylic", "linear_density_g_per_m": 0.5, "across": 10},
    job=True,
    command=Command(
        _drape_lines, more="The result is Cusick's drape coefficient.", names={"corners": None}
    ),
)
BORDER = Operation(
    border,
    tag="mechanics",
    summary="Width of a border that keeps a piece flat",
    example={"chart": "K", "material": "acrylic", "linear_density_g_per_m": 0.5, "border": "rib"},
    job=True,
    command=Command(_border_lines),
)
