"""How large a message a browser may send into a view."""

from typing import Any

import pytest
import websockets.sync.client
from websockets.exceptions import ConnectionClosed

from app.viewer.sockets import ALLOW, SizedProtocol
from tests.app.running import on_a_server

SMALL, LARGE = 1_000, 100_000


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
