"""Charts from files, and the schema of the project file."""

from pathlib import Path
from typing import Any

from pydantic import Field, RootModel

from knitcore.chart.stitch_chart import StitchChart
from knitcore.formats.designs.design_file import design_schema as schema_of_designs
from knitcore.formats.designs.design_file import read_design
from knitcore.formats.designs.layout import DesignLayout, layout_notes, layout_of
from knitcore.formats.read.chart_files import read_chart, read_noted_piece

from ...context import Context
from ...requests.base import NoRequest, RequestModel, ResultModel
from ...requests.charts import ChartLines, RepeatText
from ...requests.uploads import UploadedFile, stored
from ..registry import Command, Operation


class ImportRequest(RequestModel):
    """A file of any kind that holds a chart."""

    file: UploadedFile = Field(
        description="`.txt` (K/P lines, written rows, KnitSpeak), `.ks`, `.png`, `.json` (design) "
        "or `.k` (knitout)."
    )


class FoundDesign(DesignLayout, ResultModel):
    """A design, or the parts of one that a file of another kind holds."""

    chart: ChartLines
    name: str | None = Field(None, description="Outline of a design.")
    material: str | None = None
    note: str | None = None


class ImportResult(FoundDesign):
    """The content of a file."""

    rows: int
    columns: int
    repeat: RepeatText
    notes: list[str] = Field(
        [], description="Parts that may have been read wrongly or lost, such as a region."
    )


def import_(request: ImportRequest, context: Context) -> ImportResult:
    """K/P text, written rows, PNG, knitout and the project file.

    Raises
    ------
    InputError
        If it holds no chart.
    """
    del context
    with stored([request.file]) as (path,):
        design, notes = design_in(path)
    chart = StitchChart.parse(design.chart)
    return ImportResult(
        **dict(design),
        rows=chart.rows,
        columns=chart.columns,
        repeat=chart.repeat_cut().key,
        notes=[*notes, *layout_notes(chart, design)],
    )


def design_in(path: Path) -> tuple[FoundDesign, tuple[str, ...]]:
    """The parts of a design that a file holds, and the notes of its reader.

    Raises
    ------
    InputError
        If it holds no chart.
    """
    if path.suffix.lower() == ".json":
        return FoundDesign.of(read_design(path), chart=read_chart(path).text), ()
    content = read_noted_piece(path)
    return FoundDesign.of(layout_of(content.piece), chart=content.piece.chart.text), content.notes


class DesignSchema(RootModel[dict[str, Any]]):
    """A JSON schema."""


def design_schema(request: NoRequest, context: Context) -> DesignSchema:
    """The JSON schema of a design file."""
    del request, context
    return DesignSchema(schema_of_designs())


IMPORT = Operation(
    import_,
    tag="files",
    summary="The chart in a file",
    example={"file": {"name": "rib.txt", "content": "S1BLUApLUEtQ"}},
    heavy=True,
    command=Command(
        lambda r: [r.chart],
        more="It holds K/P text, written rows, KnitSpeak, PNG, knitout or a design.",
    ),
)
DESIGN_SCHEMA = Operation(
    design_schema,
    method="GET",
    path="/schemas/design",
    tag="files",
    summary="JSON schema of the project file",
)
