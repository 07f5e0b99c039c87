"""Charts from files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from pydantic import BaseModel, ConfigDict, Field

from app.models.uploads import UploadedFile, stored
from app.operations.parse import ChartResult
from knitcore.formats.chart_files import read_chart, read_piece
from knitcore.formats.design import read_design
from knitcore.formats.layout import (
    DesignLayout,
    DesignRegion,
    DesignRepeat,
    ShelfPattern,
    layout_fields,
    layout_notes,
    layout_of,
)


class ImportRequest(BaseModel):
    """A file of any kind that holds a chart."""

    model_config = ConfigDict(extra="forbid")

    file: UploadedFile = Field(
        description="`.txt` (K/P lines, written rows, KnitSpeak), `.ks`, `.png`, `.json` (design) "
        "or `.k` (knitout)."
    )


class ImportResult(BaseModel):
    """What a file holds."""

    rows: int
    columns: int
    chart: str = Field(description="K/P lines, the top row first.")
    repeat: ChartResult
    name: str | None = Field(None, description="Of a design.")
    material: str | None = None
    note: str | None = None
    outline: str | None = Field(None, description="Lines of x (stitch) and . (no stitch).")
    regions: list[DesignRegion] = Field([], description="As in the project file.")
    repeats: list[DesignRepeat] = []
    shelf: list[ShelfPattern] = []
    notes: list[str] = Field([], description="What may not be as meant, such as a lost region.")


def import_path(path: Path) -> ImportResult:
    """Read a file.

    Raises
    ------
    InputError
        If it holds no chart.
    """
    if path.suffix.lower() == ".json":
        chart = read_chart(path)
        found = read_design(path)
        known = {name: getattr(found, name) for name in ("name", "material", "note")}
        layout: DesignLayout = found
    else:
        piece = read_piece(path)
        chart, known, layout = piece.chart, {}, layout_of(piece)
    return ImportResult(
        rows=chart.rows,
        columns=chart.columns,
        chart=chart.text,
        repeat=ChartResult.of(chart.repeat_cut()),
        notes=list(layout_notes(chart, layout)),
        **known,
        **layout_fields(layout),
    )


def run_import(request: ImportRequest, *, cancelled: Callable[[], bool]) -> ImportResult:
    """Import for the service."""
    with stored([request.file]) as (path,):
        return import_path(path)
