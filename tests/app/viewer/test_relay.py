"""Both directions of a connection to a view end with it."""

from __future__ import annotations

import asyncio
import socket
from types import SimpleNamespace
from typing import Any
from unittest.mock import Mock

import pytest
from starlette.websockets import WebSocket

from app.viewer.relay import _carry, _watched


class _Inner:
    """A view that says one thing."""

    def __init__(self) -> None:
        self._words = [b"a scene"]

    def __aiter__(self) -> _Inner:
        return self

    async def __anext__(self) -> bytes:
        return self._words.pop() if self._words else await asyncio.Event().wait()  # type: ignore[return-value]


class _Browser:
    """A browser that is silent, or leaves."""

    def __init__(self, *messages: dict[str, Any]) -> None:
        self._says = [{"type": "websocket.connect"}, *messages]
        self.heard: list[str] = []
        self.has_scene = asyncio.Event()
        self.socket = WebSocket({"type": "websocket"}, self._receive, self._send)

    async def _receive(self) -> Any:
        return self._says.pop(0) if self._says else await asyncio.Event().wait()

    async def _send(self, message: Any) -> None:
        self.heard.append(message["type"])
        if message["type"] == "websocket.send":
            self.has_scene.set()


async def _carrying(browser: _Browser) -> asyncio.Task[None]:
    await browser.socket.accept()
    view: Any = SimpleNamespace(picture=set())
    inner: Any = _Inner()
    return asyncio.create_task(_carry(browser.socket, inner, view))


async def test_a_cancelled_connection_leaves_no_sender() -> None:
    before = asyncio.all_tasks()
    browser = _Browser()
    carrying = await _carrying(browser)
    await browser.has_scene.wait()
    carrying.cancel()
    with pytest.raises(asyncio.CancelledError):
        await carrying
    assert asyncio.all_tasks() == before
    assert browser.heard == ["websocket.accept", "websocket.send"]


async def test_a_view_that_closed_meanwhile_is_refused() -> None:
    with socket.socket() as unused:
        unused.bind(("127.0.0.1", 0))
        closed: Any = SimpleNamespace(port=unused.getsockname()[1])
        views: Any = Mock()
        browser = _Browser()
        browser.socket.scope.update({"subprotocols": [], "query_string": b"", "headers": []})
        await _watched(browser.socket, "a-view", closed, views)
    assert browser.heard == ["websocket.close"]
    assert [call.args for call in views.watch.call_args_list] == [("a-view", 1), ("a-view", -1)]


async def test_a_connection_that_the_browser_closed_is_not_closed_again() -> None:
    browser = _Browser({"type": "websocket.disconnect", "code": 1001})
    await (await _carrying(browser))
    assert "websocket.close" not in browser.heard
