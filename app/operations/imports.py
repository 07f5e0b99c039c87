"""Charts from files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from pydantic import BaseModel, ConfigDict, Field

from app.operations.charts import ChartResult, ParsedChart, ParseRequest, parse_chart
from app.operations.uploads import UploadedFile, stored
from knitcore.formats.chart_files import read_chart
from knitcore.formats.design import read_design
from knitcore.formats.layout import (
    DesignLayout,
    DesignRegion,
    DesignRepeat,
    ShelfPattern,
    layout_notes,
)


class ImportRequest(BaseModel):
    """A file of any kind that holds a chart."""

    model_config = ConfigDict(extra="forbid")

    file: UploadedFile = Field(
        description="`.txt` (K/P lines or written rows), `.png`, `.json` (design), `.k` (knitout)."
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
    chart = read_chart(path)
    parsed: ParsedChart = parse_chart(ParseRequest(text=chart.text))
    result = ImportResult(
        rows=chart.rows, columns=chart.columns, chart=chart.text, repeat=parsed.repeat
    )
    if path.suffix.lower() != ".json":
        return result
    design = read_design(path)
    kept = ("name", "material", "note", *DesignLayout.model_fields)
    return result.model_copy(
        update={name: getattr(design, name) for name in kept}
        | {"notes": list(layout_notes(chart, design))}
    )


def run_import(request: ImportRequest, *, cancelled: Callable[[], bool]) -> ImportResult:
    """Import for the service."""
    with stored([request.file]) as (path,):
        return import_path(path)
