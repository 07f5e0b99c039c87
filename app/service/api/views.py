"""The 3D view of a design."""

import asyncio
import contextvars
import logging
from collections.abc import AsyncGenerator, Callable
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from typing import Annotated, Any, TypeVar

from fastapi import APIRouter, Query, Request, Response
from fastapi.responses import StreamingResponse
from pydantic import Field
from starlette.datastructures import State

from knitcore.base.arrays import Mask
from knitcore.base.errors import InputError
from knitcore.garment.shaped import outline_marks

from ...drawing.computed import PosedView, StretchView
from ...drawing.design_view import ViewRequest, ViewResult, build_scene, is_large
from ...drawing.fabric import Box, Drawing
from ...operations.perform import Reply
from ...requests.base import RequestModel
from ...requests.charts import OutlineInput, size_of_chart
from ...viewer.camera import CameraSide
from ...viewer.scene import STILL_S, round_length_mm
from ...viewer.share import (
    Computed,
    SharedViewRequest,
    picture_png,
    shared_page,
    shared_recording,
    shared_solid,
    shared_still,
)
from ...viewer.sheet import build_back, build_drawing, packed_sheet
from ...viewer.views import View, Views
from ..compute.compute import Compute
from ..designs.parameters import DesignId, private_name
from ..identity import current_user
from ..limits.fair_queue import FairLock
from ..limits.user_limits import ConcurrencyLimit
from ..problems import NotFoundError, Problem, ServiceError
from ..web.bodies import BoundedRoute
from ..web.events import abandoned, event_stream, stream_of
from ..web.passes import ViewPasses
from ..web.security import OPENED_BY

log = logging.getLogger("knitcore.app")

EVENT_PERIOD_S = 0.5
MISSING: dict[int | str, dict[str, Any]] = {
    404: {"model": Problem, "description": "This view is not open."}
}

MAX_STILL_HERE = 5_000
"""Letters of a chart whose still the service draws itself, in 0.1 s; others wait for a worker."""

T = TypeVar("T")
Route = TypeVar("Route", bound=Callable[..., Any])
# Separate threads, so that logins and jobs, which use asyncio's, need not wait for drawings.
_drawing = ThreadPoolExecutor(4, "drawing")
_pictures = ThreadPoolExecutor(16, "pictures")  # waiting for browsers, up to 25 s each

router = APIRouter(route_class=BoundedRoute, tags=["views"], responses=MISSING)


class BoxInput(RequestModel):
    """Some stitches: rows ``row0`` (the bottom row is 0) to ``row1 - 1``, columns likewise."""

    row0: int = Field(ge=0, lt=100_000)
    column0: int = Field(ge=0, lt=100_000)
    row1: int = Field(ge=1, le=100_000)
    column1: int = Field(ge=1, le=100_000)


class MarkRequest(RequestModel):
    """Stitches to outline."""

    box: BoxInput | None = None
    part: OutlineInput = Field(
        None, description="The stitches of the box: lines of x and ., the top row first; or all."
    )


class CameraRequest(RequestModel):
    """Side to look from."""

    side: CameraSide


@router.put("/views/{design}", summary="Show a design in its 3D view")
async def put_view(design: DesignId, body: ViewRequest, request: Request) -> ViewResult:
    """Draw the design's scene; everyone who watches `/view/{design}/` sees it change at once."""
    state = request.app.state
    computed, name = _computed(body, request), private_name(design)
    context = state.answers.context()
    passes: ViewPasses = state.passes
    code = passes.give(f"/view/{design}", request.scope.get(OPENED_BY))
    made: tuple[Drawing, bytes | None] | None = None
    if computed is None and is_large(body):
        supplies = await state.answers.supplies(body)
        made = await _by_worker(request, build_drawing, body, supplies)

    def draw() -> tuple[Drawing, bytes | None, ViewResult]:
        if made is None:
            scene = build_scene(body, computed, context)
            drawing, face = scene.drawing(), packed_sheet(scene)
        else:
            drawing, face = made
        return (
            drawing,
            face,
            ViewResult(
                stitches=state.views.open(name, drawing.weight).show(drawing, face),
                source=drawing.part.shapes.source,
                scale_mm=round_length_mm(*drawing.ground.extent_mm),
                url=f"/view/{design}/#{code}",
            ),
        )

    lock: FairLock = state.drawing
    async with lock.turn(current_user.get()):
        drawing, face, result = await _in(_drawing, draw)
    if face is not None:
        back = asyncio.create_task(_show_back(state, name, body, computed, drawing))
        state.backs.add(back)
        back.add_done_callback(state.backs.discard)
    return result


async def _show_back(
    state: State, name: str, body: ViewRequest, computed: Computed, drawing: Drawing
) -> None:
    """Show the picture of a cloth's back once the cloth keeps still."""
    views: Views = state.views

    async def changed() -> bool:
        view = views.get(name)
        return view is None or view.writer.drawing is not drawing

    await asyncio.sleep(STILL_S)
    if await changed():
        return
    compute: Compute = state.compute
    try:
        supplies = await state.answers.supplies(body)
        picture = await compute.run(changed, build_back, body, computed, supplies, background=True)
    except ServiceError as error:  # its tubes are shown from behind
        log.info("the back of a cloth is not drawn: %s", error)
        return
    view = views.get(name)
    if view is not None:
        await _in(_drawing, view.writer.show_back, drawing, picture)


def _part(box: BoxInput, lines: str | None) -> Mask | None:
    """The stitches of a box that are outlined, from the bottom."""
    if lines is None:
        return None
    part = outline_marks(lines)
    if part.shape != (box.row1 - box.row0, box.column1 - box.column0):
        raise InputError("part", "it is not as large as the box.", "Give a mark for every stitch.")
    return part


@router.put("/views/{design}/mark", status_code=204, summary="Outline stitches")
async def put_mark(design: DesignId, body: MarkRequest, request: Request) -> None:
    """Outline stitches on both sides of the fabric; without a box nothing is outlined."""
    box = body.box.pass_to(Box, part=_part(body.box, body.part)) if body.box else None
    await asyncio.to_thread(_view(design, request).writer.mark, box)


@router.put("/views/{design}/camera", status_code=204, summary="Look from a side")
async def put_camera(design: DesignId, body: CameraRequest, request: Request) -> None:
    """Turn the camera of everybody who watches, so that the whole fabric is seen."""
    await asyncio.to_thread(_view(design, request).writer.look, body.side)


@router.get(
    "/views/{design}/events", summary="Follow clicks on stitches", **stream_of("Events `stitch`.")
)
async def get_view_events(design: DesignId, request: Request) -> StreamingResponse:
    """Send an event for each click on a stitch in the view, with its row and column from 0.

    Ends with the view.
    """
    _view(design, request)
    return event_stream(request, _clicks(private_name(design), request), EVENT_PERIOD_S)


@router.get(
    "/views/{design}/picture",
    summary="A picture of the view",
    response_class=Response,
    responses={
        200: {"content": {"image/png": {}}, "description": "A PNG."},
        409: {"model": Problem, "description": "No browser shows the view, or sends a picture."},
    },
)
async def get_picture(
    design: DesignId,
    request: Request,
    width: Annotated[int, Query(ge=16, le=4096)] = 1600,
    height: Annotated[int, Query(ge=16, le=4096)] = 1200,
) -> Response:
    """Take a picture as a browser that watches `/view/{design}/` sees it. At least one must
    watch."""
    view = _view(design, request)
    uses: ConcurrencyLimit = request.app.state.concurrency
    with uses.hold("pictures", current_user.get()):
        content = await _in(_pictures, picture_png, view, width, height)
    return Response(content, media_type="image/png")


def _post_for_file(path: str, summary: str, media: str, text: str) -> Callable[[Route], Route]:
    """Declare a route that answers with a file, which is described by a text."""
    answer = {"content": {media: {}}, "description": text}
    return router.post(path, summary=summary, response_class=Response, responses={200: answer})


@_post_for_file(
    "/views/page",
    "A page to share",
    "text/html",
    "One file that needs neither the service nor the network.",
)
async def post_page(body: SharedViewRequest, request: Request) -> Response:
    """Make a page in which the fabric turns with the mouse; animated, its stretch test plays."""
    return await _shared(shared_page, body, request, "text/html", "html")


@_post_for_file(
    "/views/recording", "A recording to share", "application/octet-stream", "A `.viser` file."
)
async def post_recording(body: SharedViewRequest, request: Request) -> Response:
    """Make a recording for viser's own player."""
    return await _shared(shared_recording, body, request, "application/octet-stream", "viser")


@_post_for_file(
    "/views/solid", "The yarn as glTF", "model/gltf-binary", "Binary glTF 2.0 in metres."
)
async def post_solid(body: SharedViewRequest, request: Request) -> Response:
    """Export the fabric as it lies, relaxed or stretched, with its colours."""
    return await _shared(shared_solid, body, request, "model/gltf-binary", "glb")


@_post_for_file("/views/still", "A picture of a design", "image/png", "A PNG without background.")
async def post_still(
    body: ViewRequest,
    request: Request,
    width: Annotated[int, Query(ge=16, le=1600)] = 800,
    height: Annotated[int, Query(ge=16, le=1200)] = 600,
) -> Response:
    """Draw the face of the fabric as its view frames it at first; no browser needs to watch.

    Of a chart of more than 40,000 stitches only what the view draws as yarn.
    """
    supplies = await request.app.state.answers.supplies(body)
    draw = partial(shared_still, body, _computed(body, request), supplies, width, height)
    lock: FairLock = request.app.state.drawing
    if size_of_chart(body.chart) > MAX_STILL_HERE:
        content = await _by_worker(request, draw)
    else:
        async with lock.turn(current_user.get()):
            content = await _in(_drawing, partial(draw, cancelled=lambda: False))
    return Response(content, media_type="image/png")


async def _shared(
    make: Callable[..., bytes], body: SharedViewRequest, request: Request, media: str, ending: str
) -> Response:
    supplies = await request.app.state.answers.supplies(body)
    content = await _by_worker(request, make, body, _computed(body, request), supplies)
    headers = {"Content-Disposition": f'attachment; filename="fabric.{ending}"'}
    return Response(content, media_type=media, headers=headers)


async def _by_worker(request: Request, job: Callable[..., T], *args: Any) -> T:
    """Run a job in a worker; stop it when the browser goes away."""
    compute: Compute = request.app.state.compute
    return await compute.run(partial(abandoned, request), job, *args)


async def _in(threads: ThreadPoolExecutor, function: Callable[..., T], *args: Any) -> T:
    """Run a function like ``asyncio.to_thread``, with other threads."""
    context = contextvars.copy_context()
    loop = asyncio.get_running_loop()
    return await loop.run_in_executor(threads, context.run, function, *args)


def _computed(body: ViewRequest, request: Request) -> Computed:
    """Return the view of a test or a shape that was computed before; None if it is forgotten."""
    reference = body.stretch or body.curl
    answer: Reply | None = request.app.state.recent.get(reference.id) if reference else None
    view = answer.view if answer else None
    return view if isinstance(view, StretchView | PosedView) else None


def _view(design: str, request: Request) -> View:
    view: View | None = request.app.state.views.get(private_name(design))
    if view is None:
        raise NotFoundError(
            "This view is not open.", field="design", remedy="Show the design first."
        )
    return view


async def _clicks(name: str, request: Request) -> AsyncGenerator[str | None]:
    state = request.app.state
    with state.views.clicks.listen(name) as queue:
        yield "retry: 2000\n\n"
        while not state.stopping and state.views.get(name) is not None:
            try:
                row, column = await asyncio.wait_for(queue.get(), EVENT_PERIOD_S)
            except TimeoutError:
                yield None
            else:
                yield f'event: stitch\ndata: {{"row": {row}, "column": {column}}}\n\n'
