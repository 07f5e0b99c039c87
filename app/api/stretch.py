"""The stretch test over REST."""

from __future__ import annotations

from fastapi import APIRouter, Request, Response

from app.http.packed import json_response
from app.operations.stretch import (
    StretchRequest,
    StretchResult,
    StretchRun,
    run_stretch,
    stretch_key,
)

router = APIRouter(tags=["stretch"])


@router.post("/stretch", summary="Pull a chart between two clamps", response_model=StretchResult)
async def post_stretch(body: StretchRequest, request: Request) -> Response:
    """Nonlinear strip test of the whole chart; stops when the caller goes away.

    A test that was run a short while ago is answered from memory.
    """
    state = request.app.state
    key = stretch_key(body)
    run: StretchRun | None = state.recent.get(key)
    if run is None:
        run = await state.compute.run(request.is_disconnected, run_stretch, body)
        state.recent.put(key, run, run.size_bytes)
    return await json_response(run.result, request.headers)
