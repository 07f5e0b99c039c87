"""Charts row by row, for whoever knits them."""

from pydantic import Field

from knitcore.chart.row_sides import Construction, Side
from knitcore.chart.stitch_chart import check_stitches
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.formats.designs.design_file import check_bare
from knitcore.formats.designs.layout import DesignLayout, piece_of
from knitcore.formats.write.sheets.knit_along import knit_along as worked_out
from knitcore.garment.piece import Piece
from knitcore.machine.profile import machine_of
from knitcore.machine.setting import setting_of

from ...context import Context
from ...requests.base import RequestModel, ResultModel
from ...requests.charts import AnyChartInput, MaterialName, to_stitches
from ..registry import Command, Operation
from .machines import machine_text

MAX_STITCHES = 250_000
"""Largest chart over REST."""


class KnitAlongRequest(DesignLayout, RequestModel):
    """A chart and how it is knitted: by hand, if no home machine is named."""

    chart: AnyChartInput
    construction: Construction = Field(
        Construction.FLAT, description="Flat or in the round; on a machine always flat."
    )
    first_side: Side = Field(Side.RS, description="The side of row 1, in flat knitting by hand.")
    from_row: int = Field(1, ge=1, description="The first row, after a break or a jam.")
    material: MaterialName | None = Field(
        None, description="Material of the yarn, for the stitch number of a machine."
    )


class AlongRowResult(ResultModel):
    """A row."""

    number: int
    heading: str = Field(description="Side that faces the knitter, or where the carriage starts.")
    leftwards: bool = Field(description="Worked from the knitter's right to the left.")
    words: list[str] = Field(description="What to do, in order.")
    stitches: str = Field(
        description="Stitches from the knitter's left: P for a purl, or on a machine for a stitch "
        "that is latched up or on the ribber; K for all others."
    )
    first: int = Field(description="Place of the leftmost stitch, counted from the widest row's.")
    yarns: list[tuple[int, int]] = Field(
        description="Stitches and number of the yarn of each stretch, from the left."
    )
    codes: list[str] = Field(
        description="Stitches of a chart with others than knits and purls as they are worked, from "
        "the knitter's left; empty for any other."
    )


class AlongYarn(ResultModel):
    """A yarn."""

    name: str
    colour: str


class KnitAlongResult(ResultModel):
    """All rows of a piece."""

    opening: list[str] = Field(description="What is done before the first row.")
    rows: list[AlongRowResult]
    closing: list[str] = Field(description="What is done after the last row.")
    notes: list[str]
    round: bool = Field(description="Whether rows are rounds.")
    repeat_rows: int = Field(description="Rows after which the pattern begins again.")
    marked: str = Field(description="What the stitches P are.")
    yarns: list[AlongYarn]
    needles: list[str] = Field(description="Names of all needles from the left, on a machine.")


def knit_along(request: KnitAlongRequest, context: Context) -> KnitAlongResult:
    """Each row in words, with its stitches as the knitter sees them: by hand or on a home machine.

    Raises
    ------
    InputError
        If the chart is too large here, or cannot be worked in this way.
    """
    chart = to_stitches(request.chart)
    if not context.local:
        check_stitches(chart.rows * chart.columns, MAX_STITCHES, instead=", or the command line")
    if isinstance(chart, SymbolChart):
        check_bare(request)
        piece: Piece | SymbolChart = chart
    else:
        piece = piece_of(chart, request)
    machine = None if request.machine is None else machine_of(request.machine)
    rows = worked_out(
        piece,
        request.construction,
        first_side=request.first_side,
        machine=machine,
        from_row=request.from_row,
    )
    notes = list(rows.notes)
    if machine is not None and request.material is not None and isinstance(piece, Piece):
        notes.insert(0, setting_of(piece, machine, context.material(request.material)).note)
    return KnitAlongResult.of(rows, notes=notes)


def _command(request: KnitAlongRequest, context: Context) -> KnitAlongResult:
    if request.machine is not None:
        request = request.model_copy(update={"machine": machine_text(request.machine)})
    return knit_along(request, context)


def _lines(result: KnitAlongResult) -> list[str]:
    name = "Rnd" if result.round else "Row"
    rows = []
    for row in result.rows:
        heading = f" ({row.heading})" if row.heading else ""
        rows.append(f"{name} {row.number}{heading}: {' '.join(row.words)}")
    return [*result.opening, *rows, *result.closing, *result.notes]


OPERATION = Operation(
    knit_along,
    tag="files",
    summary="A chart row by row",
    path="/knit-along",
    example={"chart": "KP\nPK"},
    most_stitches=MAX_STITCHES,
    command=Command(
        _lines,
        more="--machine takes a name of `knitcore machines`, or the file of a profile of your own.",
        names={"regions": None, "repeats": None, "shelf": None},
        run=_command,
    ),
)
