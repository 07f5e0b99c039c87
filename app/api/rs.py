"""The reduced-symmetry model over REST."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path

from app.operations.rs import RSResult, rs_material

router = APIRouter(tags=["mechanics"])


@router.get("/rs/{material}", summary="Moduli from the shape of the yarn")
def get_rs(material: Annotated[str, Path(max_length=80, examples=["acrylic"])]) -> RSResult:
    """Even and odd segments as springs, in series and side by side, beside the paper's values."""
    return rs_material(material)
