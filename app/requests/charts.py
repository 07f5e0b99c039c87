"""Charts, outlines and materials in requests."""

from typing import Annotated

from pydantic import BaseModel, Discriminator, Field, Tag

from knitcore.chart.fabric import Fabric
from knitcore.chart.stitch_chart import MAX_STITCHES_PER_SIDE, StitchChart
from knitcore.chart.symbol_chart import SymbolChart, as_stitches, plain_chart
from knitcore.garment.shaped import outline_marks

from .base import RequestModel
from .faults import CheckedBy

MAX_TEXT = 1_200_000
"""Characters of a chart text: the largest chart with its line ends and some blanks."""
MAX_FIELD = 400 * 400
"""Largest chart, in stitches, for which a request may give a value per stitch."""


class PureFabricChart(RequestModel):
    """A pure fabric by name and size."""

    fabric: Fabric
    columns: int = Field(ge=1, le=MAX_STITCHES_PER_SIDE)
    rows: int = Field(ge=1, le=MAX_STITCHES_PER_SIDE)


ChartText = Annotated[
    str,
    Field(
        max_length=MAX_TEXT,
        description="K/P lines, the top row first, as seen from the face; or separated by /.",
        examples=["KPKP\nPKPK"],
    ),
]
ChartLines = Annotated[
    str, Field(description="K/P lines, the top row first, as seen from the face.")
]
"""A chart in an answer."""
RepeatText = Annotated[
    str,
    Field(
        description="A repeat: K/P, the top row first, rows separated by /.", examples=["KPKP/PKPK"]
    ),
]
"""A repeat in an answer, spelled as in a design."""
CellLines = Annotated[
    str, Field(description="Lines of x (part of it) and . (not part of it), the top row first.")
]
"""Stitches of a part, in an answer."""
Row = Annotated[int, Field(ge=0, description="Row, counted from 0 at the bottom.")]
Column = Annotated[int, Field(ge=0, description="Column, counted from 0 at the left.")]
TEXT_TAG, FABRIC_TAG = "K/P text", "pure fabric"
"""Tags of the two ways to give a chart; errors leave them out of the field's name."""


def _way(given: object) -> str | None:
    if isinstance(given, str):
        return TEXT_TAG
    return FABRIC_TAG if isinstance(given, dict | PureFabricChart) else None


ChartInput = Annotated[
    Annotated[ChartText, Tag(TEXT_TAG)] | Annotated[PureFabricChart, Tag(FABRIC_TAG)],
    Discriminator(
        _way,
        custom_error_type="chart_type",
        custom_error_message="Input should be a text of K and P or a fabric with its size",
    ),
    CheckedBy(lambda chart, _: to_chart(chart)),
]
ANY_STITCHES = "any stitches"
AnyChartInput = Annotated[
    Annotated[
        str,
        Field(
            max_length=MAX_TEXT,
            description="Lines of stitches, the top row first, as seen from the face: K and P, or "
            "those of the list of stitches, such as O/KK (yarn over, knit 2 together, knit 2).",
            examples=["KPKP\nPKPK"],
        ),
        Tag(TEXT_TAG),
    ]
    | Annotated[PureFabricChart, Tag(FABRIC_TAG)],
    Discriminator(
        _way,
        custom_error_type="chart_type",
        custom_error_message="Input should be a text of stitches or a fabric with its size",
    ),
    CheckedBy(lambda chart, _: to_stitches(chart)),
    ANY_STITCHES,
]
"""A chart that may have lace, cables, slipped and tucked stitches."""
IS_REPEAT = "repeat"
RepeatInput = Annotated[ChartInput, IS_REPEAT]
"""A chart that stands for its repeat: a pure fabric needs no size on the command line."""
AnyRepeatInput = Annotated[AnyChartInput, IS_REPEAT]

OutlineInput = Annotated[
    str | None,
    Field(
        max_length=MAX_TEXT,
        description="Lines of x (stitch) and . (no stitch), the top row first; all stitches if "
        "left out.",
    ),
    CheckedBy(lambda outline, _: outline_marks(outline)),
]
MaterialName = Annotated[
    str,
    Field(
        max_length=1000,
        description="Identifier of a material of the library.",
        examples=["acrylic"],
    ),
    CheckedBy(lambda name, context: context.material(name)),
]


def size_of(request: BaseModel) -> int:
    """About how many stitches a request holds: the letters of its texts, and named fabrics."""
    return sum(
        size_of_chart(value) for _, value in request if isinstance(value, str | PureFabricChart)
    )


def size_of_chart(chart: ChartInput) -> int:
    """About how many stitches it has, without reading it."""
    return len(chart) if isinstance(chart, str) else chart.rows * chart.columns


def to_chart(chart: ChartInput) -> StitchChart:
    """The chart of a request."""
    if isinstance(chart, PureFabricChart):
        return StitchChart.of_fabric(chart.fabric, rows=chart.rows, columns=chart.columns)
    return plain_chart(chart)


def to_stitches(chart: AnyChartInput) -> StitchChart | SymbolChart:
    """The chart of a request that takes every stitch."""
    return as_stitches(chart) if isinstance(chart, str) else to_chart(chart)


def to_repeat(chart: ChartInput) -> StitchChart:
    """The repeat of a request: the chart itself, or a pure fabric's own repeat."""
    if isinstance(chart, PureFabricChart):
        return StitchChart.of_fabric(chart.fabric).repeat()
    return plain_chart(chart)
