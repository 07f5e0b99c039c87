"""The 3D view of a design."""

from __future__ import annotations

import asyncio

from fastapi import APIRouter, Request

from app.operations.view import ViewRequest, ViewResult, build_scene
from app.viewer.design_id import DesignId, private_name

router = APIRouter(tags=["views"])


@router.put("/views/{design}", summary="Show a design in its 3D view")
async def put_view(design: DesignId, body: ViewRequest, request: Request) -> ViewResult:
    """Draw the design's scene; whoever watches `/view/{design}/` sees it change at once."""
    state = request.app.state
    stretch = state.recent.get(body.stretch.id) if body.stretch else None

    name = private_name(design)

    def draw() -> int:
        scene = build_scene(body, stretch)
        return int(state.views.open(name).show(scene))

    drawn = await asyncio.to_thread(draw)
    return ViewResult(stitches=drawn, url=f"/view/{design}/")
