"""Predictions over REST."""

from __future__ import annotations

from fastapi import APIRouter, Request

from app.operations.curve import CurveRequest, CurveResult, run_curve
from app.operations.predict import PredictRequest, PredictResult, predict_request

router = APIRouter(tags=["mechanics"])


@router.post("/predict", summary="Moduli and extensibility of a chart")
def post_predict(request: PredictRequest) -> PredictResult:
    """Effective constants with their 90 % intervals and where they come from."""
    return predict_request(request)


@router.post("/curve", summary="Stress-strain curve of a chart")
async def post_curve(body: CurveRequest, request: Request) -> CurveResult:
    """Strain at each stress, for pure fabrics, ribs, welts and repeats of up to 256 stitches.

    Large repeats take minutes; stops when the caller goes away.
    """
    compute = request.app.state.compute
    result: CurveResult = await compute.run(request.is_disconnected, run_curve, body)
    return result
