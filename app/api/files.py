"""Files over REST: charts to files, files to charts, and the schema of the project file."""

from __future__ import annotations

from typing import Any

from fastapi import APIRouter, Request

from app.operations.export import ExportRequest, ExportResult, run_export
from app.operations.imports import ImportRequest, ImportResult, run_import
from knitcore.formats.design import design_schema

router = APIRouter(tags=["files"])


@router.post("/export", summary="A chart as a file")
async def post_export(body: ExportRequest, request: Request) -> ExportResult:
    """Knitout (checked on a virtual machine), PNG, SVG, PDF, text, written rows, glTF and more."""
    compute = request.app.state.compute
    result: ExportResult = await compute.run(request.is_disconnected, run_export, body)
    return result


@router.post("/import", summary="The chart in a file")
async def post_import(body: ImportRequest, request: Request) -> ImportResult:
    """K/P text, written rows, PNG, knitout and the project file."""
    compute = request.app.state.compute
    result: ImportResult = await compute.run(request.is_disconnected, run_import, body)
    return result


@router.get("/schemas/design", summary="JSON schema of the project file")
def get_design_schema() -> dict[str, Any]:
    """What a design file may hold."""
    return design_schema()
