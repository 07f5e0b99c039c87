"""A piece that hangs under its own weight."""

from typing import Literal

import numpy as np
from pydantic import Field

from knitcore.cloth.space.curl import MAX_STITCHES, TIME_LIMIT_S
from knitcore.cloth.space.hang import HungBy
from knitcore.cloth.space.hang import hang as hang_piece
from knitcore.garment.shaped import outline_marks

from ...context import Context
from ...drawing.computed import PosedView
from ...requests.base import ResultModel
from ...requests.charts import ChartInput, OutlineInput, to_chart
from ...requests.weighed import (
    FRICTIONLESS,
    Corners,
    TimeLimit,
    WantsCorners,
    WeighedRequest,
    corner_lists,
)
from ..perform import Viewed
from ..registry import Command, Operation


class HangRequest(WeighedRequest):
    """A whole piece and what holds it."""

    chart: ChartInput
    outline: OutlineInput = None
    by: HungBy = Field(
        HungBy.EDGE,
        description="Hold the piece by the edge of its highest stitches, or by its ends.",
    )
    corners: WantsCorners = False
    time_limit_s: TimeLimit = TIME_LIMIT_S


class HangResult(ResultModel):
    """The piece as it hangs."""

    kind: Literal["hang"] = "hang"
    id: str = Field(description="Name of the shape, for 3D views.")
    weight_g: float
    drop_mm: float = Field(description="Height from the highest point to the lowest.")
    width_mm: float
    depth_mm: float
    lengthening: float = Field(description="Strain of the middle column.")
    converged: bool = Field(
        description="True if the shape is at rest; otherwise it is only a preview."
    )
    corners_mm: Corners = None
    notes: list[str]


def hang(request: HangRequest, context: Context) -> Viewed[HangResult]:
    """Shape of a piece that hangs from its top edge, or from its two top corners, by its weight.

    Edges curl against the weight. Pieces may have up to 10,000 stitches.
    """
    chart, material = to_chart(request.chart), context.material(request.material)
    stitches = None if request.outline is None else outline_marks(request.outline)
    hanging = request.pass_to(
        hang_piece,
        chart,
        material,
        stitches=stitches,
        size=request.relaxed_size,
        cancelled=context.cancelled,
    )
    result = HangResult.of(
        hanging,
        id=OPERATION.key(request),
        corners_mm=corner_lists(hanging.corners_mm, hanging.used) if request.corners else None,
        notes=[FRICTIONLESS],
    )
    return Viewed(result, PosedView(hanging.corners_mm.astype(np.float32)))


def _lines(r: HangResult) -> list[str]:
    return [
        f"weight       {r.weight_g:.1f} g",
        f"drop         {r.drop_mm:.0f} mm" + ("" if r.converged else "  NOT converged"),
        f"width        {r.width_mm:.0f} mm, depth {r.depth_mm:.0f} mm",
        f"lengthening  {r.lengthening:.1%} of the middle column",
    ]


OPERATION = Operation(
    hang,
    tag="mechanics",
    summary="Shape of a piece that hangs under its own weight",
    most_stitches=MAX_STITCHES,
    example={
        "chart": {"fabric": "garter", "columns": 6, "rows": 8},
        "material": "acrylic",
        "linear_density_g_per_m": 0.5,
    },
    job=True,
    command=Command(_lines, names={"corners": None}),
)
