"""Pressure on a limb over REST."""

from __future__ import annotations

from fastapi import APIRouter

from app.operations.pressure import PressureRequest, PressureResult, run_pressure

router = APIRouter(tags=["mechanics"])


@router.post("/pressure", summary="Pressure of a knitted tube on a limb")
def post_pressure(request: PressureRequest) -> PressureResult:
    """An interval by Laplace's law with warnings, never a medical class."""
    return run_pressure(request)
