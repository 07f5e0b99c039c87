"""Materials over REST."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path

from app.http.problems import NotFoundError, Problem
from app.operations.materials import MaterialDetail, Materials, explain_material, list_materials
from knitcore.errors import InputError

MISSING = {"model": Problem, "description": "It is not in the library."}

router = APIRouter(tags=["materials"])


@router.get("/materials", summary="The library of materials")
def get_materials() -> Materials:
    """Yarns of the paper on their machine settings, and variants."""
    return list_materials()


@router.get(
    "/materials/{identifier}", summary="Everything known of a material", responses={404: MISSING}
)
def get_material(
    identifier: Annotated[str, Path(max_length=80, examples=["acrylic"])],
) -> MaterialDetail:
    """Laws, sizes, uncertainty, the paper's figures with corrections, and values per stitch."""
    try:
        return explain_material(identifier)
    except InputError as error:
        raise NotFoundError(
            f"{error.field}: {error.problem}", field="identifier", remedy=error.remedy
        ) from None
