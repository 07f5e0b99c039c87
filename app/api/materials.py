"""Materials over REST."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path

from app.operations.materials import MaterialDetail, Materials, explain_material, list_materials

router = APIRouter(tags=["materials"])


@router.get("/materials", summary="The library of materials")
def get_materials() -> Materials:
    """Yarns of the paper on their machine settings, and variants."""
    return list_materials()


@router.get("/materials/{identifier}", summary="Everything known of a material")
def get_material(
    identifier: Annotated[str, Path(max_length=80, examples=["acrylic"])],
) -> MaterialDetail:
    """Laws, sizes, uncertainty, the paper's figures with corrections, and values per stitch."""
    return explain_material(identifier)
