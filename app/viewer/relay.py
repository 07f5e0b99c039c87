"""viser's client page, with our scripts before its own, and its websocket, served from the page's
own port and origin."""

import asyncio
import contextlib
import hashlib
import logging
import time
from collections.abc import Callable
from dataclasses import dataclass
from importlib.metadata import distribution
from pathlib import Path
from types import NoneType

import websockets
from fastapi import APIRouter, Request, WebSocket, WebSocketDisconnect
from fastapi.responses import HTMLResponse, RedirectResponse, Response
from starlette.websockets import WebSocketState

from ..service.designs.parameters import DesignId, private_name
from ..service.identity import current_user
from ..service.limits.user_limits import ConcurrencyLimit, OverLimitError, RateLimit
from ..service.web.page import script_tag
from .incoming import BURST, MAX_BYTES, MAX_PICTURE_BYTES, PER_S, RefusedMessageError, passed_on
from .sockets import ALLOW
from .views import View, Views

log = logging.getLogger("knitcore.app")
router = APIRouter(include_in_schema=False)

CLIENT_PAGE = Path(str(distribution("viser").locate_file("viser/client/build/index.html")))
SCRIPTS = tuple(f"viser/{name}.js" for name in ("notices", "yarn", "smaller", "aside", "frame"))
STYLE = """<style>
  /* viser's notes are about the computer, not about the fabric. */
  .mantine-Notifications-root { display: none !important; }
  /* viser fades the scene while it loads pictures of surroundings, of which there are none. */
  canvas { opacity: 1 !important; }
  /* Where viser draws rectangles to select with: one more layer that every frame would blend. */
  canvas[width="0"] { display: none !important; }
</style>"""
VIEW_STYLE = """<style>
  /* The page around the view has all controls; viser's own would repeat them. */
  .mantine-Paper-root { display: none !important; }
  /* The page's theme shows through. */
  html, body, #root, #root div { background-color: transparent !important; }
</style>"""
OPENING_S = 8.0
"""Time for which a browser waits for a view: its page may load before its first scene is made."""
LOOK_AGAIN_S = 0.05
REFUSED_AFTER_S = 1.0
"""Time for which one who opens views too often waits for the refusal, before trying once more."""
ENDS = (NoneType, asyncio.CancelledError, WebSocketDisconnect, websockets.ConnectionClosed)
"""Ends of the two directions of a connection, whichever side left."""


@dataclass(frozen=True)
class ViewerPage:
    """The page of a view, without viser's control panel."""

    content: bytes
    tag: str


def viewer_page() -> ViewerPage:
    """Make the page of a view from viser's client and our scripts."""
    page = with_scripts(CLIENT_PAGE.read_text(encoding="utf-8"), VIEW_STYLE).encode()
    return ViewerPage(page, f'"{hashlib.sha256(page).hexdigest()[:16]}"')


def with_scripts(page: str, more: str = "") -> str:
    """A page of viser's client that draws as ours do, with more for its head."""
    scripts = "".join(map(script_tag, SCRIPTS))
    return page.replace("<head>", f"<head>{more}{scripts}{STYLE}", 1)


@router.get("/view/{design}")
async def with_slash(design: DesignId) -> RedirectResponse:
    """The client looks for its websocket next to its own address, which must end in a slash."""
    return RedirectResponse(f"/view/{design}/")


@router.get("/view/{design}/")
async def client_page(design: DesignId, request: Request) -> Response:
    """viser's client, one self-contained file, without its control panel."""
    page: ViewerPage = request.app.state.viewer_page
    headers = {"Cache-Control": "private, no-cache", "ETag": page.tag}
    if page.tag in request.headers.get("if-none-match", ""):
        return Response(status_code=304, headers=headers)
    return HTMLResponse(page.content, headers=headers)


@router.websocket("/view/{design}")
async def relay(socket: WebSocket, design: DesignId) -> None:
    """Carry messages between a browser and the design's viser server."""
    views: Views = socket.app.state.views
    openings: RateLimit = socket.app.state.view_openings
    if openings.take(current_user.get())[1]:
        await asyncio.sleep(REFUSED_AFTER_S)
        await socket.close(code=1013, reason="Views are opened too often.")
        return
    name = private_name(design)
    view = await _opened(views, name)
    if view is None:
        await _refuse(socket)
        return
    uses: ConcurrencyLimit = socket.app.state.concurrency
    try:
        with uses.hold("watchers", current_user.get()):
            await _watched(socket, name, view, views)
    except OverLimitError as error:
        await socket.close(code=1013, reason=error.detail)


async def _watched(socket: WebSocket, name: str, view: View, views: Views) -> None:
    from .private_port import RELAY_HEADERS  # an open view has loaded it

    coarse = "coarse" in socket.query_params
    views.watch(name, +1, coarse=coarse)
    try:
        if coarse:
            await asyncio.to_thread(view.writer.redraw)  # nothing finer is sent
        try:
            inner = await websockets.connect(
                f"ws://127.0.0.1:{view.port}",
                subprotocols=list(socket.scope["subprotocols"]) or None,
                additional_headers=RELAY_HEADERS,
                max_size=None,
                max_queue=0,  # the next message is read when the browser has got this one
                compression=None,
            )
        except (OSError, websockets.InvalidHandshake):  # the view was closed just now
            await _refuse(socket)
            return
        async with inner:
            await socket.accept(subprotocol=inner.subprotocol)
            await _carry(socket, inner, view)
    finally:
        views.watch(name, -1, coarse=coarse)


async def _refuse(socket: WebSocket) -> None:
    await socket.close(code=1013, reason="This view is not open yet.")


async def _opened(views: Views, name: str) -> View | None:
    """The view, also where the browser is a little ahead of the request that opens it."""
    deadline = time.monotonic() + OPENING_S
    while (view := views.get(name)) is None and time.monotonic() < deadline:
        await asyncio.sleep(LOOK_AGAIN_S)
    return view


async def _carry(socket: WebSocket, inner: websockets.ClientConnection, view: View) -> None:
    rate = RateLimit(PER_S, BURST)
    code = 1000

    allow: Callable[[int], None] = socket.scope.get("extensions", {}).get(ALLOW, lambda _: None)

    async def outwards() -> None:
        async for message in inner:
            # the message that asks for a picture comes this way, too
            allow(MAX_BYTES if view.picture is None else MAX_PICTURE_BYTES)
            if isinstance(message, bytes):
                await socket.send_bytes(message)
            else:
                await socket.send_text(message)

    async def inwards() -> None:
        nonlocal code
        while True:
            message = await socket.receive()
            if message["type"] == "websocket.disconnect":
                return
            data = message.get("bytes") or message.get("text") or b""
            try:
                if rate.take("")[1]:
                    raise RefusedMessageError("too many messages")
                kept = passed_on(data, view.picture)
            except RefusedMessageError as refused:
                log.warning("a browser's connection to a view is closed: %s", refused)
                code = 1008
                return
            if kept is not None:
                await inner.send(kept)
            await asyncio.sleep(0)  # others have their turn between messages that wait already

    tasks = [asyncio.create_task(outwards()), asyncio.create_task(inwards())]
    try:
        await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    finally:  # also where this one is cancelled: neither may send after the close
        for task in tasks:
            task.cancel()
        outcomes = await asyncio.gather(*tasks, return_exceptions=True)
    for outcome in outcomes:
        if not isinstance(outcome, ENDS):
            raise outcome
    if socket.client_state is socket.application_state is WebSocketState.CONNECTED:
        with contextlib.suppress(WebSocketDisconnect):  # the browser closes just then
            await socket.close(code)
