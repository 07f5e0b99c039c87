"""The yarn level over REST."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from typing import Any

from fastapi import APIRouter, Request, Response
from pydantic import BaseModel

from app.operations.bend import BendRequest, BendResult, run_bend
from app.operations.relax import RelaxRequest, RelaxResult, run_relax
from app.operations.sweep import SweepRequest, SweepResult, run_sweep

router = APIRouter(tags=["yarn level"])


@router.post("/relax", summary="Relax a repeat at the yarn level", response_model=RelaxResult)
async def post_relax(body: RelaxRequest, request: Request) -> Response:
    """Shape of least energy of the repeat; stops when the caller goes away.

    A relaxation that was run a short while ago is answered from memory.
    """
    return await _answer(body, request, run_relax)


@router.post("/sweep", summary="Stretch a repeat at the yarn level", response_model=SweepResult)
async def post_sweep(body: SweepRequest, request: Request) -> Response:
    """Stress-strain curve and fitted law of the repeat; stops when the caller goes away.

    A stretch that was run a short while ago is answered from memory.
    """
    return await _answer(body, request, run_sweep)


@router.post("/bend", summary="Bending, curl and shear of a repeat", response_model=BendResult)
async def post_bend(body: BendRequest, request: Request) -> Response:
    """Linear response of the relaxed repeat, without friction; stops when the caller goes away."""
    return await _answer(body, request, run_bend)


async def _answer(body: BaseModel, request: Request, run: Callable[..., BaseModel]) -> Response:
    state = request.app.state
    content = type(body).__name__ + body.model_dump_json()
    key = hashlib.sha256(content.encode()).hexdigest()[:32]
    answer: Any = state.recent.get(key)
    if answer is None:
        result: BaseModel = await state.compute.run(request.is_disconnected, run, body)
        answer = result.model_dump_json()
        state.recent.put(key, answer, len(answer))
    return Response(answer, media_type="application/json")
