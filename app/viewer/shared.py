"""Files of a design's 3D view to share."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from pathlib import Path

from pydantic import Field

from knitcore.chart.stitch_chart import check_stitches
from knitcore.garment.shaped import outline_marks

from ..context import Context
from ..drawing.computed import PosedView, StretchView
from ..drawing.design_view import StretchStep, ViewRequest, build_scene
from ..drawing.fabric import FabricScene
from ..drawing.solid import MAX_SOLID, solid_glb
from ..requests.charts import to_chart
from .share import page_html, recording
from .still import still_png

MAX_SHARED_STITCHES = 40_000


class SharedViewRequest(ViewRequest):
    """A design, as it lies or with its stretch test as an animation."""

    animated: bool = Field(False, description="Show all steps of the stretch test, not only one.")
    dark: bool = Field(False, description="Dark background of a page.")


Computed = StretchView | PosedView | None
"""Data for the view of a stretch test or a shape that was computed before."""


# These run in workers.


def shared_page(
    request: SharedViewRequest, computed: Computed, data_dir: Path, *, cancelled: Callable[[], bool]
) -> bytes:
    """A page that needs neither the service nor the network."""
    scenes = _scenes(request, computed, Context(data_dir, cancelled=cancelled))
    return page_html(scenes, dark=request.dark).encode()


def shared_recording(
    request: SharedViewRequest, computed: Computed, data_dir: Path, *, cancelled: Callable[[], bool]
) -> bytes:
    """A ``.viser`` recording."""
    return recording(_scenes(request, computed, Context(data_dir, cancelled=cancelled)))


def shared_solid(
    request: SharedViewRequest, computed: Computed, data_dir: Path, *, cancelled: Callable[[], bool]
) -> bytes:
    """The yarn as binary glTF.

    Raises
    ------
    InputError
        If there are too many stitches for a solid of use.
    """
    _check_size(request, MAX_SOLID)
    return solid_glb(build_scene(request, computed, Context(data_dir, cancelled=cancelled)))


def shared_still(
    request: ViewRequest,
    computed: Computed,
    data_dir: Path,
    width: int,
    height: int,
    *,
    cancelled: Callable[[], bool],
) -> bytes:
    """A picture without background, with this many pixels: a PNG."""
    scene = build_scene(request, computed, Context(data_dir, cancelled=cancelled))
    return still_png(scene.drawing(), width, height)


def _scenes(
    request: SharedViewRequest, computed: Computed, context: Context
) -> Iterator[FabricScene]:
    _check_size(request, MAX_SHARED_STITCHES)
    scene = build_scene(request, computed, context)
    if not request.animated or request.stretch is None or not isinstance(computed, StretchView):
        yield scene
        return
    for step in range(len(computed.positions_mm)):
        if context.cancelled():
            return
        at = StretchStep(id=request.stretch.id, step=step)
        yield build_scene(request.model_copy(update={"stretch": at}), computed, context)


def _check_size(request: SharedViewRequest, most: int) -> None:
    stitches = to_chart(request.chart).stitches
    if request.outline is not None:
        stitches = int(outline_marks(request.outline).sum())
    check_stitches(stitches, most)
