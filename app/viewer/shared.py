"""Files of a design's 3D view to share."""

from __future__ import annotations

from collections.abc import Iterator

from pydantic import Field

from app.operations.context import Context
from app.operations.curl import CurlView
from app.operations.stretch import StretchView
from app.viewer.design_view import StretchStep, ViewRequest, build_scene
from app.viewer.fabric import FabricScene
from app.viewer.share import MOST_SOLID, page_html, recording, solid_glb
from knitcore.errors import InputError

MAX_SHARED_STITCHES = 40_000


class SharedViewRequest(ViewRequest):
    """A design, as it lies or with its stretch test as an animation."""

    animated: bool = Field(False, description="All steps of the stretch test, not only the one.")
    dark: bool = Field(False, description="Dark background of a page.")


def shared_page(
    request: SharedViewRequest, found: StretchView | CurlView | None, context: Context
) -> bytes:
    """A page that needs neither the service nor the network."""
    return page_html(_scenes(request, found, context), dark=request.dark).encode()


def shared_recording(
    request: SharedViewRequest, found: StretchView | CurlView | None, context: Context
) -> bytes:
    """A ``.viser`` recording."""
    return recording(_scenes(request, found, context))


def shared_solid(
    request: SharedViewRequest, found: StretchView | CurlView | None, context: Context
) -> bytes:
    """The yarn as binary glTF.

    Raises
    ------
    InputError
        If there are too many stitches for a solid of use.
    """
    scene = build_scene(request, found, context)
    _check_size(scene, MOST_SOLID)
    return solid_glb(scene)


def _scenes(
    request: SharedViewRequest, found: StretchView | CurlView | None, context: Context
) -> Iterator[FabricScene]:
    scene = build_scene(request, found, context)
    _check_size(scene, MAX_SHARED_STITCHES)
    if not request.animated or request.stretch is None or not isinstance(found, StretchView):
        yield scene
        return
    for step in range(len(found.positions_mm)):
        at = StretchStep(id=request.stretch.id, step=step)
        yield build_scene(request.model_copy(update={"stretch": at}), found, context)


def _check_size(scene: FabricScene, most: int) -> None:
    stitches = scene.shapes.index.size
    if stitches > most:
        raise InputError(
            "chart", f"{stitches} stitches are too many for this file.", f"Share at most {most}."
        )
