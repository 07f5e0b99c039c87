"""Measurements over REST."""

from __future__ import annotations

from fastapi import APIRouter, Request

from app.operations.measure import (
    BendingRequest,
    BendingResult,
    CompressionRequest,
    CompressionResult,
    run_bending,
    run_compression,
)

router = APIRouter(tags=["measure"])


@router.post("/measure/bending", summary="Bending modulus from photos of hanging yarn")
async def post_bending(body: BendingRequest, request: Request) -> BendingResult:
    """Traces each photo and fits the heavy elastica."""
    compute = request.app.state.compute
    result: BendingResult = await compute.run(request.is_disconnected, run_bending, body)
    return result


@router.post("/measure/compression", summary="Contact constants from compression tests")
async def post_compression(body: CompressionRequest, request: Request) -> CompressionResult:
    """k and p, per sample and mean."""
    compute = request.app.state.compute
    result: CompressionResult = await compute.run(request.is_disconnected, run_compression, body)
    return result
