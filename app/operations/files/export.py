"""Charts to files."""

import base64
from pathlib import Path
from typing import Annotated

from pydantic import ConfigDict, Field

from knitcore.base.extensions import IDENTIFIER
from knitcore.chart.row_sides import Construction, Side
from knitcore.chart.stitch_chart import StitchChart, check_stitches, size_in_words
from knitcore.chart.symbol_chart import SymbolChart
from knitcore.formats.designs.layout import DesignLayout
from knitcore.formats.write.chart_key import Symbols
from knitcore.formats.write.export import ExportedFile, ExportKind, ExportOptions, export_chart
from knitcore.machine.program import Finish
from knitcore.materials.yarn_per_stitch import MeasuredYarn

from ...cli.options import out_option
from ...context import Context
from ...requests.base import ResultModel
from ...requests.charts import AnyChartInput, MaterialName, to_stitches
from ...requests.fabrics import Gauged, LawsRequest, YarnPerStitch
from ...requests.uploads import Content
from ..registry import Command, Operation
from .machines import machine_text

MAX_STITCHES: dict[str, int] = {
    ExportKind.KNITOUT: 20_000,
    ExportKind.GLB: 2_500,
    ExportKind.STL: 2_500,
}
"""Largest chart over REST, in stitches; the command line accepts larger ones."""


ExtensionName = Annotated[str, Field(pattern=f"^{IDENTIFIER.pattern}$")]
"""The identifier of a format that is not built in."""


class ExportRequest(DesignLayout, Gauged, LawsRequest):
    """A chart and the format to write it in."""

    model_config = ConfigDict(extra="forbid")

    chart: AnyChartInput
    to: ExportKind | ExtensionName = Field(
        description=f"{', '.join(ExportKind)}; or a format of an installed extension."
    )
    material: MaterialName = Field("acrylic", description="Material that gives sizes and values.")
    construction: Construction = Construction.FLAT
    first_side: Side = Field(Side.RS, description="The side of row 1, in flat knitting.")
    finish: Finish = Field(Finish.WASTE, description="The end of a knitout program.")
    stitch_number: float | None = Field(
        None, ge=0, le=10_000, description="Of a knitout program; the machine's own if left out."
    )
    symbols: Symbols = Field(
        Symbols.DOTS,
        description="Symbols of printed charts: a dot or a dash for a purl, or the Japanese ones.",
    )
    from_row: int = Field(
        1, ge=1, description="Row at which a program or a plan begins, after a break or a jam."
    )
    name: str = Field("Untitled", min_length=1, max_length=200, pattern=r"^[^\x00-\x1f]+$")
    note: str = Field("", max_length=20_000, description="Note to print with the chart.")
    linear_density_tex: float | None = Field(
        None, gt=0, lt=1e5, description="Linear density of the yarn, for its mass."
    )
    yarn_per_stitch_mm: YarnPerStitch = Field(
        None,
        description="Yarn in the mean stitch of this chart, as knitted: unravelled, or weighed "
        "(1,000,000 × g ÷ tex ÷ stitches); the material's by default.",
    )
    photo: Content | None = Field(
        None, description="PNG picture of the cloth, base64, for the first page of a pattern."
    )


class ExportFacts(ResultModel):
    """The exported file."""

    kind: str
    rows: int
    columns: int
    bytes: int
    transfers: int | None = Field(
        None, description="Transfers of a knitout program, without the finish."
    )
    carriers: int | None = Field(None, description="Carriers of a knitout program, without waste.")
    notes: list[str]


class ExportResult(ExportFacts):
    """A file inside JSON."""

    name: str
    media_type: str
    content: str = Field(description="The file, base64.")


def export(request: ExportRequest, context: Context) -> ExportResult:
    """Knitout (checked on a virtual machine), PNG, SVG, PDF, text, written rows, glTF and more.

    Raises
    ------
    InputError
        If the chart is too large for this format here.
    """
    chart = to_stitches(request.chart)
    if limit := MAX_STITCHES.get(request.to):
        check_stitches(
            chart.rows * chart.columns, limit, instead=f" for {request.to}, or the command line"
        )
    file = _export(chart, request, context)
    kept = "".join(c if c.isalnum() or c in " -_." else "-" for c in request.name).strip(" .")
    return ExportResult(
        **dict(_facts(chart, file)),
        media_type=file.media_type,
        name=(kept[:80] or "chart") + file.suffix,
        content=base64.b64encode(file.content).decode(),
    )


def _export(
    chart: StitchChart | SymbolChart, request: ExportRequest, context: Context
) -> ExportedFile:
    mm = request.yarn_per_stitch_mm
    options = request.pass_to(
        ExportOptions, layout=request, gauge=request.relaxed_size,
        measured_yarn=None if mm is None else MeasuredYarn(mm),
    )  # fmt: skip
    return export_chart(chart, request.to, context.material(request.material), options)


def _facts(chart: StitchChart | SymbolChart, file: ExportedFile) -> ExportFacts:
    return ExportFacts.of(file, rows=chart.rows, columns=chart.columns, bytes=len(file.content))


@out_option("-o", "--out", required=True, help="FILE to write.")
def _command(request: ExportRequest, context: Context, out: Path) -> ExportFacts:
    if "name" not in request.model_fields_set:
        request = request.model_copy(update={"name": out.stem or "Untitled"})
    if request.machine is not None:
        request = request.model_copy(update={"machine": machine_text(request.machine)})
    chart = to_stitches(request.chart)
    file = _export(chart, request, context)
    out.write_bytes(file.content)
    return _facts(chart, file)


def _lines(facts: ExportFacts) -> list[str]:
    lines = [f"{size_in_words(facts.columns, facts.rows)}, {facts.bytes} bytes of {facts.kind}"]
    if facts.transfers is not None:
        lines.append(f"{facts.transfers} transfers")
    if facts.carriers is not None:
        lines.append(f"{facts.carriers} carriers")
    return lines


OPERATION = Operation(
    export,
    tag="files",
    summary="A chart as a file",
    example={"chart": "KP\nPK", "to": "text"},
    heavy=True,
    command=Command(
        _lines,
        more="Knitout is first run on a virtual machine that checks it. --machine takes a name of "
        "`knitcore machines`, or the file of a profile of your own.",
        names={
            "linear_density_tex": "--tex",
            "photo": None,
            "regions": None,
            "repeats": None,
            "shelf": None,
        },
        run=_command,
    ),
)
