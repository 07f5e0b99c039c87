"""viser's client page and websocket, served from the page's own port and origin."""

from __future__ import annotations

import asyncio
import contextlib
import logging
from pathlib import Path

import msgspec
import viser
import websockets
from fastapi import APIRouter, Request, WebSocket, WebSocketDisconnect
from fastapi.responses import HTMLResponse, RedirectResponse

from app.viewer.design_id import DesignId, private_name
from app.viewer.private_port import RELAY_HEADERS
from app.viewer.views import Views

log = logging.getLogger("knitcore.app")
router = APIRouter(include_in_schema=False)

CLIENT_PAGE = Path(viser.__file__).parent / "client" / "build" / "index.html"
VIEW_STYLE = """<style>
  /* The page around the view has all controls and states; viser's own would repeat them. */
  .mantine-Paper-root, .mantine-Notifications-root { display: none !important; }
  /* The page's theme shows through. */
  html, body, #root, #root div { background-color: transparent !important; }
  /* Where viser draws rectangles to select with: one more layer that every frame would blend. */
  canvas[width="0"] { display: none !important; }
</style>"""
SHARE_REQUESTS = frozenset({"ShareUrlRequest", "ShareUrlDisconnect"})
"""Messages that would make viser open a public tunnel to this machine."""


@router.get("/view/{design}")
async def with_slash(design: DesignId) -> RedirectResponse:
    """The client finds its websocket beside its own address, so the address must end in a slash."""
    return RedirectResponse(f"/view/{design}/")


@router.get("/view/{design}/")
async def client_page(design: DesignId, request: Request) -> HTMLResponse:
    """viser's client, one self-contained file, without its control panel."""
    page: str = request.app.state.viewer_page
    return HTMLResponse(page, headers={"Cache-Control": "private, max-age=3600"})


@router.websocket("/view/{design}")
async def relay(socket: WebSocket, design: DesignId) -> None:
    """Carry messages between a browser and the design's viser server."""
    views: Views = socket.app.state.views
    name = private_name(design)
    view = views.get(name)
    if view is None:
        await socket.close(code=1013, reason="This view is not open yet.")
        return
    offered = list(socket.scope["subprotocols"])
    async with websockets.connect(
        f"ws://127.0.0.1:{view.port}",
        subprotocols=offered or None,
        additional_headers=RELAY_HEADERS,
        max_size=None,
        compression=None,
    ) as inner:
        await socket.accept(subprotocol=inner.subprotocol)
        views.watch(name, +1)
        try:
            await _carry(socket, inner)
        finally:
            views.watch(name, -1)


async def _carry(socket: WebSocket, inner: websockets.ClientConnection) -> None:
    async def outwards() -> None:
        async for message in inner:
            if isinstance(message, bytes):
                await socket.send_bytes(message)
            else:
                await socket.send_text(message)

    async def inwards() -> None:
        while True:
            message = await socket.receive()
            if message["type"] == "websocket.disconnect":
                return
            data = message.get("bytes") or message.get("text")
            if data and not _asks_for_a_tunnel(data):
                await inner.send(data)

    tasks = [asyncio.create_task(outwards()), asyncio.create_task(inwards())]
    _, pending = await asyncio.wait(tasks, return_when=asyncio.FIRST_COMPLETED)
    for task in pending:
        task.cancel()
    for task in tasks:
        with contextlib.suppress(
            asyncio.CancelledError, WebSocketDisconnect, websockets.ConnectionClosed, RuntimeError
        ):
            await task
    with contextlib.suppress(RuntimeError, WebSocketDisconnect):  # the browser closed first
        await socket.close()


def _asks_for_a_tunnel(data: bytes | str) -> bool:
    if isinstance(data, str):
        return False
    try:
        message = msgspec.msgpack.decode(data)
    except msgspec.DecodeError:
        return True  # what cannot be read is not passed on
    return isinstance(message, dict) and message.get("type") in SHARE_REQUESTS


def viewer_page() -> str:
    """viser's client page with the style that hides its panel."""
    return CLIENT_PAGE.read_text(encoding="utf-8").replace("</head>", f"{VIEW_STYLE}</head>", 1)
