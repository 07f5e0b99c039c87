"""How large a message a browser may send into a view, and how long it may read nothing of one."""

import contextlib
import socket
from threading import Event
from typing import Any
from unittest.mock import Mock

import pytest
import uvicorn
import websockets.sync.client
from websockets.exceptions import ConnectionClosed

from app.service.web import unread
from app.viewer.sockets import ALLOW, SizedProtocol
from tests.app.running import on_a_server

SMALL, LARGE = 1_000, 100_000
UPGRADE = (
    b"GET / HTTP/1.1\r\nHost: here\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
    b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n\r\n"
)


async def _echo_of_sizes(scope: Any, receive: Any, send: Any) -> None:
    """An application that takes large messages once it was told to, and answers their sizes."""
    await receive()
    await send({"type": "websocket.accept"})
    while (message := await receive())["type"] == "websocket.receive":
        if message.get("text") == "allow":
            scope["extensions"][ALLOW](LARGE)
        await send({"type": "websocket.send", "text": str(len(message.get("bytes") or b""))})


def test_a_large_message_is_refused_until_it_is_allowed() -> None:
    with on_a_server(
        _echo_of_sizes, lifespan="off", ws=SizedProtocol, ws_max_size=SMALL
    ) as url, websockets.sync.client.connect(url.replace("http", "ws")) as browser:  # fmt: skip
        browser.send("allow")
        assert browser.recv() == "0"
        browser.send(bytes(LARGE))
        assert browser.recv() == str(LARGE)
        with websockets.sync.client.connect(url.replace("http", "ws")) as other:
            other.send(bytes(SMALL + 1))
            with pytest.raises(ConnectionClosed, match="1009"):
                other.recv()
        browser.send(bytes(LARGE))
        assert browser.recv() == str(LARGE)


def test_a_browser_that_reads_nothing_is_left(monkeypatch: pytest.MonkeyPatch) -> None:
    ended = Event()

    async def app(scope: Any, receive: Any, send: Any) -> None:
        await receive()
        await send({"type": "websocket.accept"})
        with contextlib.suppress(OSError):
            await send({"type": "websocket.send", "bytes": bytes(50_000_000)})
        ended.set()

    monkeypatch.setattr(unread, "STALLED_S", 0.5)
    with on_a_server(app, lifespan="off", ws=SizedProtocol) as url:
        host, _, port = url.removeprefix("http://").partition(":")
        with socket.create_connection((host, int(port))) as browser:
            browser.sendall(UPGRADE)
            assert ended.wait(60)


@pytest.mark.parametrize("is_read", [True, False])
async def test_a_ping_waits_behind_a_message_that_is_being_read(is_read: bool) -> None:
    config = uvicorn.Config(Mock(), ws_ping_timeout=20.0)
    config.load()
    protocol = SizedProtocol(config, Mock(), {})
    protocol.loop, protocol.transport = Mock(), Mock(is_closing=lambda: False)
    if is_read:
        protocol.writable.clear()
    protocol.keepalive_timeout()
    assert protocol.transport.close.called is not is_read
