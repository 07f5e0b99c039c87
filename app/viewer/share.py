"""Files of 3D views to give away: pictures, pages that need no service, recordings, solids."""

import re
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

from pydantic import Field

from knitcore.chart.stitch_chart import check_stitches
from knitcore.garment.shaped import outline_marks

from ..context import Context, Supplies
from ..drawing.computed import PosedView, StretchView
from ..drawing.design_view import StretchStep, ViewRequest, build_scene
from ..drawing.fabric import MAX_SOLID, FabricScene, solid_glb
from ..requests.charts import to_stitches
from ..service.problems import ServiceError
from .incoming import WantedPicture
from .relay import with_scripts
from .sheet import packed_sheet
from .still import still_png
from .views import View, new_view

FRAME_S = 0.14
PICTURE_TIMEOUT_S = 25.0
MAX_SHARED_STITCHES = 40_000
PAGE_TITLE = "Knitted fabric in 3D"
PAGE_POLICY = (
    """<meta http-equiv="Content-Security-Policy" content="default-src 'none'; """
    "script-src 'unsafe-inline' 'wasm-unsafe-eval' data: blob:; style-src 'unsafe-inline'; "
    "img-src data: blob:; font-src data:; connect-src data: blob:; worker-src data: blob:; "
    """base-uri 'none'; form-action 'none'">"""
)
"""Content policy of a page that is given away: it may not use the network."""


class NoPictureError(ServiceError):
    """Error: no picture of the view can be taken now."""

    status, type, title = 409, "conflict", "No picture can be taken"


def picture_png(view: View, width: int, height: int) -> bytes:
    """A picture as the last of the browsers that look sees it, with a transparent background.

    Raises
    ------
    NoPictureError
        If no browser shows the view or answers, or another picture is being taken.
    """
    clients = sorted(view.server.get_clients().items())
    if not clients:
        raise NoPictureError(
            "No browser shows this view, so there is no picture of it.", remedy="Open the view."
        )
    if not view.picturing.acquire(blocking=False):
        raise NoPictureError("Another picture of this view is being taken.", remedy="Wait for it.")
    view.picture = picture = WantedPicture(width, height)
    try:
        clients[-1][1].get_render(height, width, transport_format="png", timeout=PICTURE_TIMEOUT_S)
    except (TimeoutError, RuntimeError, ConnectionError) as error:
        raise _silent() from error
    finally:
        view.picture = None
        view.picturing.release()
    if picture.content is None:
        raise _silent()
    return picture.content


def _silent() -> NoPictureError:
    return NoPictureError(
        "The browser that shows this view sent no picture.", remedy="Bring it to the front."
    )


class SharedViewRequest(ViewRequest):
    """A design, as it lies or with its stretch test as an animation."""

    animated: bool = Field(False, description="Show all steps of the stretch test, not only one.")
    dark: bool = Field(False, description="Dark background of a page.")


Computed = StretchView | PosedView | None
"""Data for the view of a stretch test or a shape that was computed before."""


# These run in workers.


def shared_page(
    request: SharedViewRequest,
    computed: Computed,
    supplies: Supplies,
    *,
    cancelled: Callable[[], bool],
) -> bytes:
    """A page that needs neither the service nor the network, and plays the steps if there are
    several."""
    with _recorded(request, computed, supplies.context(cancelled=cancelled)) as serializer:
        page: str = serializer.as_html(dark_mode=request.dark)
    named = re.sub(r"<title>[^<]*</title>", f"<title>{PAGE_TITLE}</title>", page, count=1)
    return with_scripts(named, PAGE_POLICY).encode()


def shared_recording(
    request: SharedViewRequest,
    computed: Computed,
    supplies: Supplies,
    *,
    cancelled: Callable[[], bool],
) -> bytes:
    """A ``.viser`` recording."""
    with _recorded(request, computed, supplies.context(cancelled=cancelled)) as serializer:
        content: bytes = serializer.serialize()
    return content


def shared_solid(
    request: SharedViewRequest,
    computed: Computed,
    supplies: Supplies,
    *,
    cancelled: Callable[[], bool],
) -> bytes:
    """The yarn as binary glTF.

    Raises
    ------
    InputError
        If there are too many stitches for a solid of use.
    """
    _check_size(request, MAX_SOLID)
    return solid_glb(build_scene(request, computed, supplies.context(cancelled=cancelled)))


def shared_still(
    request: ViewRequest,
    computed: Computed,
    supplies: Supplies,
    width: int,
    height: int,
    *,
    cancelled: Callable[[], bool],
) -> bytes:
    """A picture without background, with this many pixels: a PNG."""
    scene = build_scene(request, computed, supplies.context(cancelled=cancelled))
    return still_png(scene, width, height)


@contextmanager
def _recorded(request: SharedViewRequest, computed: Computed, context: Context) -> Iterator[Any]:
    """A separate server, so that viewers of the design are not disturbed."""
    view = new_view()
    try:
        scenes = _scenes(request, computed, context)
        first = next(scenes)
        drawing = first.drawing()
        if request.animated:
            view.show(drawing)
        else:
            view.show(drawing, packed_sheet(first))
            view.writer.show_back(drawing, packed_sheet(first, back=True))
        serializer = view.server.get_scene_serializer()
        played = False  # over and over, unless it has no length
        for scene in scenes:
            serializer.insert_sleep(FRAME_S)
            view.show(scene.drawing())
            played = True
        if played:
            serializer.insert_sleep(FRAME_S)
        yield serializer
    finally:
        view.stop()


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
    chart = to_stitches(request.chart)
    stitches = chart.rows * chart.columns
    if request.outline is not None:
        stitches = int(outline_marks(request.outline).sum())
    check_stitches(stitches, most)
