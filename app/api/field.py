"""Measured displacement fields over REST."""

from __future__ import annotations

from fastapi import APIRouter, Request

from app.operations.field import (
    CalibrateRequest,
    CalibrateResult,
    CompareRequest,
    CompareResult,
    run_calibrate,
    run_compare,
)

router = APIRouter(tags=["displacement fields"])


@router.post("/compare", summary="A law beside a measured displacement field")
async def post_compare(body: CompareRequest, request: Request) -> CompareResult:
    """Errors of the displacements, picture by picture."""
    result: CompareResult = await request.app.state.compute.run(
        request.is_disconnected, run_compare, body
    )
    return result


@router.post("/calibrate", summary="Shear modulus and couplings from a displacement field")
async def post_calibrate(body: CalibrateRequest, request: Request) -> CalibrateResult:
    """A law that fits a measured field, and forces if tests are given."""
    result: CalibrateResult = await request.app.state.compute.run(
        request.is_disconnected, run_calibrate, body
    )
    return result
