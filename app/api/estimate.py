"""Estimates for a new yarn over REST."""

from __future__ import annotations

from fastapi import APIRouter

from app.operations.estimate import (
    EstimateRequest,
    EstimateResult,
    ModelReport,
    model_report,
    run_estimate,
)

router = APIRouter(tags=["materials"])


@router.post("/estimate", summary="The four fabrics of a yarn that is not in the library")
def post_estimate(request: EstimateRequest) -> EstimateResult:
    """Extension under load first, then moduli and laws, with 90 % intervals."""
    return run_estimate(request)


@router.get("/estimate/report", summary="How well left-out yarns are predicted")
def get_report() -> ModelReport:
    """The model refitted from the packaged tables."""
    return model_report()
