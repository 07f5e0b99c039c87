"""Fitting over REST."""

from __future__ import annotations

from fastapi import APIRouter, Request

from app.operations.fit import FitRequest, FitResult, run_fit

router = APIRouter(tags=["measure"])


@router.post("/fit", summary="A law from two stretch tests")
async def post_fit(body: FitRequest, request: Request) -> FitResult:
    """Eight constants with standard errors from a course-wise and a wale-wise test."""
    result: FitResult = await request.app.state.compute.run(request.is_disconnected, run_fit, body)
    return result
