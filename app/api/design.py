"""Inverse design over REST."""

from __future__ import annotations

from fastapi import APIRouter, Request

from app.operations.atlas import AtlasRequest, AtlasResult, run_atlas
from app.operations.fill import FillRequest, FillResult, run_fill
from app.operations.find import FindRequest, FindResult, run_find
from app.operations.shape import ShapeRequest, ShapeResult, run_shape

router = APIRouter(tags=["design"])


@router.post("/atlas", summary="Predicted constants of all small repeats of a material")
async def post_atlas(body: AtlasRequest, request: Request) -> AtlasResult:
    """Columns for a scatter of stiffness course-wise against wale-wise."""
    compute = request.app.state.compute
    result: AtlasResult = await compute.run(request.is_disconnected, run_atlas, body)
    return result


@router.post("/find", summary="Fabrics that do what is wanted")
async def post_find(body: FindRequest, request: Request) -> FindResult:
    """Ranked repeats with intervals and knitting cost; says so when nothing reaches the wishes."""
    compute = request.app.state.compute
    result: FindResult = await compute.run(request.is_disconnected, run_find, body)
    return result


@router.post("/fill", summary="A chart for a map of wanted stiffness")
async def post_fill(body: FillRequest, request: Request) -> FillResult:
    """Patches from the atlas, fitted to each other; tells what is not reached."""
    compute = request.app.state.compute
    result: FillResult = await compute.run(request.is_disconnected, run_fill, body)
    return result


@router.post("/shape", summary="A chart that takes a wanted outline when it is stretched")
async def post_shape(body: ShapeRequest, request: Request) -> ShapeResult:
    """Bands across the pull, chosen, pulled in the finite swatch and chosen again."""
    compute = request.app.state.compute
    result: ShapeResult = await compute.run(request.is_disconnected, run_shape, body)
    return result
