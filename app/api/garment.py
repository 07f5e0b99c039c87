"""Garments over REST."""

from __future__ import annotations

from fastapi import APIRouter

from app.operations.garment import GarmentRequest, GarmentResult, run_garment

router = APIRouter(tags=["garments"])


@router.post("/garment", summary="A garment from measurements")
def post_garment(request: GarmentRequest) -> GarmentResult:
    """Outline, regions, fills, yarn and warnings of a template."""
    return run_garment(request)
