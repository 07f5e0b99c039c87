"""Views to share: pictures, pages that need no service, recordings."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from typing import Any

from ..drawing.fabric import FabricScene
from ..service.problems import ServiceError
from .client import with_scripts
from .incoming import WantedPicture
from .views import View, new_view

FRAME_S = 0.14
PICTURE_TIMEOUT_S = 25.0


PAGE_POLICY = (
    """<meta http-equiv="Content-Security-Policy" content="default-src 'none'; """
    "script-src 'unsafe-inline' 'wasm-unsafe-eval' data: blob:; style-src 'unsafe-inline'; "
    "img-src data: blob:; font-src data:; connect-src data: blob:; worker-src data: blob:; "
    """base-uri 'none'; form-action 'none'">"""
)
"""A page that was given away reaches no network."""


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


def page_html(scenes: Iterable[FabricScene], *, dark: bool) -> str:
    """A page that shows a fabric, and plays the steps if there are several."""
    with _recorded(scenes) as serializer:
        page: str = serializer.as_html(dark_mode=dark)
    return with_scripts(page, PAGE_POLICY)


def recording(scenes: Iterable[FabricScene]) -> bytes:
    """A ``.viser`` file."""
    with _recorded(scenes) as serializer:
        content: bytes = serializer.serialize()
    return content


@contextmanager
def _recorded(scenes: Iterable[FabricScene]) -> Iterator[Any]:
    """A separate server, so that viewers of the design are not disturbed."""
    view = new_view()
    try:
        remaining = iter(scenes)
        view.show(next(remaining).drawing())
        serializer = view.server.get_scene_serializer()
        played = False  # over and over, unless it has no length
        for scene in remaining:
            serializer.insert_sleep(FRAME_S)
            view.show(scene.drawing())
            played = True
        if played:
            serializer.insert_sleep(FRAME_S)
        yield serializer
    finally:
        view.stop()
