"""Width of a border that keeps a curling piece flat."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from knitcore.chart.fabric import Fabric
from knitcore.chart.stitch_chart import StitchChart
from knitcore.cloth.space.border import RULE_ROWS, RULE_STITCHES, advice

from ...context import Context
from ...requests.base import ResultModel
from ...requests.charts import RepeatInput, to_repeat
from ...requests.weighed import FROM_QUARTERS, WeighedRequest
from ..registry import Command, Operation

_RULE = (
    f"Knitters make borders of {RULE_STITCHES[0]} to {RULE_STITCHES[1]} stitches or "
    f"{RULE_ROWS} rows. These hold by friction between the yarns and by blocking, which are "
    "not modelled here."
)
_ROLLS = (
    "Where the weight of a border does not keep the piece flat, a wider border does no better: the "
    "fabric beside it rises."
)


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


def border(request: BorderRequest, context: Context) -> BorderResult:
    """Width of a border that keeps a piece flat on a table.

    The weight of the border balances the moment with which the piece curls; a strip of both shows
    whether that is enough.

    Raises
    ------
    InputError, ConvergenceError, CancelledError
    """
    inner = request.cloth(to_repeat(request.chart), context)
    edge = StitchChart.of_fabric(request.border, rows=2, columns=2)
    around = request.cloth(edge, context)
    sides, ends = (advice(inner, around, axis, cancelled=context.cancelled) for axis in (0, 1))
    notes = [_RULE] if max(sides.moment_n, ends.moment_n) > 0.0 else []
    if not (sides.holds and ends.holds):
        notes.append(_ROLLS)
    if inner.from_quarters:
        notes.append(FROM_QUARTERS)
    return BorderResult(sides=EdgesResult.of(sides), ends=EdgesResult.of(ends), notes=notes)


def _lines(r: BorderResult) -> list[str]:
    return [
        f"sides           {_told(r.sides, 'stitches')}",
        f"top and bottom  {_told(r.ends, 'rows')}",
    ]


def _told(edges: EdgesResult, unit: str) -> str:
    if edges.moment_n == 0.0:
        return "do not curl: no border needed"
    state = "holds" if edges.holds else "rolls up all the same"
    return (
        f"{edges.moment_n:.4f} N: {edges.width_mm:.0f} mm, {edges.stitches} {unit}; {state}, ridge "
        f"{edges.ridge_mm:.0f} mm; a border by the knitters' rule holds {edges.rule_share:.0%}"
    )


OPERATION = Operation(
    border,
    tag="mechanics",
    summary="Width of a border that keeps a piece flat",
    example={"chart": "K", "material": "acrylic", "linear_density_g_per_m": 0.5, "border": "rib"},
    job=True,
    command=Command(_lines),
)
