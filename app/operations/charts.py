"""Charts at the border, and reading them."""

from __future__ import annotations

from typing import Annotated

from pydantic import BaseModel, ConfigDict, Discriminator, Field, Tag

from knitcore.chart import MAX_STITCHES_PER_SIDE, StitchChart
from knitcore.fabric import Fabric

MAX_TEXT = 1_200_000
"""Characters of a chart text: the largest chart with its line ends and some blanks."""


class PureFabricChart(BaseModel):
    """A pure fabric by name and size."""

    model_config = ConfigDict(extra="forbid")

    fabric: Fabric
    columns: int = Field(ge=1, le=MAX_STITCHES_PER_SIDE)
    rows: int = Field(ge=1, le=MAX_STITCHES_PER_SIDE)


ChartText = Annotated[
    str,
    Field(
        max_length=MAX_TEXT,
        description="K/P lines, the top row first, as seen from the face.",
        examples=["KPKP\nPKPK"],
    ),
]
TEXT_TAG, FABRIC_TAG = "K/P text", "pure fabric"
"""Names of the two ways to give a chart; errors leave them out of the field's name."""

ChartInput = Annotated[
    Annotated[ChartText, Tag(TEXT_TAG)] | Annotated[PureFabricChart, Tag(FABRIC_TAG)],
    Discriminator(lambda given: TEXT_TAG if isinstance(given, str) else FABRIC_TAG),
]


def to_chart(chart: ChartInput) -> StitchChart:
    """The chart that a request means."""
    if isinstance(chart, PureFabricChart):
        return StitchChart.of_fabric(chart.fabric, rows=chart.rows, columns=chart.columns)
    return StitchChart.parse(chart)


def to_repeat(chart: ChartInput) -> StitchChart:
    """The repeat that a request means: the chart itself, or a pure fabric's own repeat."""
    if isinstance(chart, PureFabricChart):
        return fabric_repeat(chart.fabric)
    return StitchChart.parse(chart)


def fabric_repeat(fabric: Fabric) -> StitchChart:
    """The repeat of a pure fabric."""
    return StitchChart.of_fabric(fabric, rows=2, columns=2).repeat()


class ParseRequest(BaseModel):
    """A chart text as somebody typed it."""

    model_config = ConfigDict(extra="forbid")

    text: ChartText


class ChartResult(BaseModel):
    """A chart, read and written again in the canonical form."""

    rows: int
    columns: int
    text: str


class ParsedChart(ChartResult):
    """A chart and its smallest repeat."""

    repeat: ChartResult


def parse_chart(request: ParseRequest) -> ParsedChart:
    """Read a chart text and find its repeat."""
    chart = StitchChart.parse(request.text)
    return ParsedChart(**_result(chart).model_dump(), repeat=_result(chart.repeat_cut()))


def _result(chart: StitchChart) -> ChartResult:
    return ChartResult(rows=chart.rows, columns=chart.columns, text=chart.text)
