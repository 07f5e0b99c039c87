"""Charts from files, and the schema of the project file."""

from pathlib import Path
from typing import Any

from pydantic import Field, RootModel

from knitcore.chart.fabric import Fabric
from knitcore.chart.stitch_chart import MAX_STITCHES_PER_SIDE, StitchChart
from knitcore.chart.symbol_chart import SymbolChart, as_stitches
from knitcore.formats.designs.design_file import design_schema as schema_of_designs
from knitcore.formats.designs.design_file import read_design
from knitcore.formats.designs.layout import DesignLayout, layout_notes, layout_of
from knitcore.formats.read.chart_files import Aspect, PictureReading, is_design, read_any_stitches

from ...context import Context
from ...requests.base import NoRequest, RequestModel, ResultModel
from ...requests.charts import ChartLines, MaterialName, RepeatText
from ...requests.uploads import UploadedFile, stored
from ..registry import Command, Operation


class ImportRequest(RequestModel):
    """A file of any kind that holds a chart."""

    file: UploadedFile = Field(
        description="`.txt` (a chart of letters or signs, written rows, KnitSpeak), `.ks`, a "
        "picture (`.png`, `.jpg` …), `.json` (design) or `.k` (knitout)."
    )
    columns: int | None = Field(
        None, ge=1, le=MAX_STITCHES_PER_SIDE, description="Width that a picture is scaled to."
    )
    rows: int | None = Field(
        None, ge=1, le=MAX_STITCHES_PER_SIDE, description="Height that a picture is scaled to."
    )
    aspect: Aspect = Field(
        Aspect.KEEP,
        description="How a picture's rows follow from its columns: stitches counted as squares, or "
        "as high as they are knitted, or freely.",
    )
    dark_below: int | None = Field(
        None,
        ge=1,
        le=255,
        description="Grey below which a stitch of a picture is dark, of 255; without it, the grey "
        "or colour that parts the stitches best.",
    )
    light_is_purl: bool = Field(
        False, description="In a picture the light stitches are the purls, not the dark ones."
    )
    material: MaterialName = Field(
        "acrylic", description="Its stockinette gives the stitches their size for `as-knitted`."
    )


class ImportedDesign(DesignLayout, ResultModel):
    """A design, or the parts of one that a file of another kind holds."""

    chart: ChartLines
    name: str | None = Field(None, description="Outline of a design.")
    material: str | None = None
    note: str | None = None


class ImportResult(ImportedDesign):
    """The content of a file."""

    rows: int
    columns: int
    repeat: RepeatText
    notes: list[str] = Field(
        [], description="Parts that may have been read wrongly or lost, such as a region."
    )


def import_(request: ImportRequest, context: Context) -> ImportResult:
    """Charts of letters or signs, written rows, KnitSpeak, pictures, knitout, the project file.

    Raises
    ------
    InputError
        If it holds no chart.
    """
    with stored([request.file]) as (path,):
        design, notes = design_in(path, _reading(request, context))
    chart = as_stitches(design.chart)
    if isinstance(chart, StitchChart):
        notes = (*notes, *layout_notes(chart, design))
    return ImportResult(
        **dict(design),
        rows=chart.rows,
        columns=chart.columns,
        repeat=chart.repeat_cut().key,
        notes=list(notes),
    )


def _reading(request: ImportRequest, context: Context) -> PictureReading | None:
    """How a picture is to be read, if that is said."""
    ratio = None
    if request.aspect is Aspect.AS_KNITTED:
        record = context.material(request.material).record(Fabric.STOCKINETTE)
        ratio = record.stitch_wale_mm / record.stitch_course_mm
    reading = PictureReading(
        request.columns,
        request.rows,
        request.aspect,
        ratio,
        dark_below=request.dark_below,
        light_is_purl=request.light_is_purl,
    )
    return reading if reading != PictureReading() else None


def design_in(
    path: Path, reading: PictureReading | None = None
) -> tuple[ImportedDesign, tuple[str, ...]]:
    """The parts of a design that a file holds, and the notes of its reader.

    Raises
    ------
    InputError
        If it holds no chart.
    """
    if is_design(path):
        design = read_design(path)
        chart = design.to_purl_map() if design.other_stitches else design.to_stitches()
        return ImportedDesign.of(design, chart=chart.text), ()
    read = read_any_stitches(path, reading)
    piece, notes = read.content, read.notes
    if isinstance(piece, SymbolChart):
        return ImportedDesign(chart=piece.text), notes
    if not piece.is_plain:
        outline = "" if piece.is_rectangle else "an outline, and "
        yarns = ", ".join(yarn.name for yarn in piece.yarns)
        notes = (*notes, f"Beside the chart it holds {outline}the yarns: {yarns}.")
    return ImportedDesign.of(layout_of(piece), chart=piece.chart.text), notes


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
        more="It holds K/P text, written rows, KnitSpeak, a picture, knitout or a design.",
    ),
)
DESIGN_SCHEMA = Operation(
    design_schema,
    method="GET",
    path="/schemas/design",
    tag="files",
    summary="JSON schema of the project file",
)
