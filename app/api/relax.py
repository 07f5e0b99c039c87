"""The yarn level over REST."""

from __future__ import annotations

from fastapi import APIRouter, Request

from app.operations.relax import RelaxRequest, RelaxResult, run_relax
from app.operations.sweep import SweepRequest, SweepResult, run_sweep

router = APIRouter(tags=["yarn level"])


@router.post("/relax", summary="Relax a repeat at the yarn level")
async def post_relax(body: RelaxRequest, request: Request) -> RelaxResult:
    """Shape of least energy of the repeat; stops when the caller goes away."""
    result: RelaxResult = await request.app.state.compute.run(
        request.is_disconnected, run_relax, body
    )
    return result


@router.post("/sweep", summary="Stretch a repeat at the yarn level")
async def post_sweep(body: SweepRequest, request: Request) -> SweepResult:
    """Stress-strain curve and fitted law of the repeat; stops when the caller goes away."""
    result: SweepResult = await request.app.state.compute.run(
        request.is_disconnected, run_sweep, body
    )
    return result
