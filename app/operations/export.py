"""Charts to files."""

from __future__ import annotations

import base64
from collections.abc import Callable

from pydantic import BaseModel, ConfigDict, Field

from app.models.charts import ChartInput, to_chart
from app.results.own_materials import find_material
from knitcore.chart import StitchChart
from knitcore.errors import InputError
from knitcore.formats.export import (
    ExportedFile,
    ExportKind,
    ExportOptions,
    export_chart,
)
from knitcore.formats.knitout import Finish
from knitcore.formats.layout import DesignLayout
from knitcore.worked import Construction, Side

MAX_KNITOUT_STITCHES = 20_000
MAX_MESH_STITCHES = 2_500
"""Over REST; the command line takes larger ones."""


class ExportRequest(DesignLayout):
    """A chart and the format that it shall become."""

    model_config = ConfigDict(extra="forbid")

    chart: ChartInput
    to: ExportKind
    material: str = Field("acrylic", max_length=80, description="For sizes and values.")
    construction: Construction = Construction.FLAT
    first_side: Side = Field(Side.RS, description="Side of row 1 in flat knitting.")
    finish: Finish = Field(Finish.WASTE, description="How a knitout program ends.")
    name: str = Field("Untitled", min_length=1, max_length=200, pattern=r"^[^\x00-\x1f]+$")
    note: str = Field("", max_length=20_000, pattern=r"^[^\x00]*$", description="Printed.")
    linear_density_tex: float | None = Field(
        None, gt=0, lt=1e5, allow_inf_nan=False, description="Of the yarns, for their mass."
    )


class ExportFacts(BaseModel):
    """What was written."""

    kind: ExportKind
    rows: int
    columns: int
    bytes: int
    transfers: int | None = Field(None, description="Of a knitout program, without finishing.")
    carriers: int | None = Field(None, description="Of a knitout program, without waste.")
    notes: list[str]


class ExportResult(ExportFacts):
    """A file inside JSON."""

    name: str
    media_type: str
    content: str = Field(description="The file, base64.")


def export_facts(chart: StitchChart, file: ExportedFile) -> ExportFacts:
    """The facts of a file."""
    return ExportFacts(
        kind=file.kind,
        rows=chart.rows,
        columns=chart.columns,
        bytes=len(file.content),
        transfers=file.transfers,
        carriers=file.carriers,
        notes=list(file.notes),
    )


def run_export(request: ExportRequest, *, cancelled: Callable[[], bool]) -> ExportResult:
    """Export for the service.

    Raises
    ------
    InputError
        If the chart is too large for this format here.
    """
    chart = to_chart(request.chart)
    mesh = request.to in (ExportKind.GLB, ExportKind.STL)
    limit = {ExportKind.KNITOUT: MAX_KNITOUT_STITCHES}.get(request.to, 10**6)
    limit = MAX_MESH_STITCHES if mesh else limit
    if chart.rows * chart.columns > limit:
        raise InputError(
            "chart",
            f"{chart.columns}x{chart.rows} stitches are too many for {request.to} here.",
            f"Use at most {limit} stitches, or the command line.",
        )
    options = ExportOptions(
        construction=request.construction,
        first_side=request.first_side,
        finish=request.finish,
        name=request.name,
        note=request.note,
        layout=request,
        linear_density_tex=request.linear_density_tex,
    )
    file = export_chart(chart, request.to, find_material(request.material), options)
    return ExportResult(
        **export_facts(chart, file).model_dump(),
        name=_file_name(request.name) + file.suffix,
        media_type=file.media_type,
        content=base64.b64encode(file.content).decode(),
    )


def _file_name(name: str) -> str:
    """A design's name as a file's: letters, digits and a few signs."""
    kept = "".join(c if c.isalnum() or c in " -_." else "-" for c in name).strip(" .")
    return kept[:80] or "chart"
