"""Connections that ask for nothing."""

from __future__ import annotations

import socket
import threading
import time
from collections.abc import Iterator

import pytest
import uvicorn
from starlette.types import Receive, Scope, Send

from app.http.connections import Connection

KEPT_S = 1
HEAD = b"GET / HTTP/1.1\r\nHost: here\r\n"


async def _app(scope: Scope, receive: Receive, send: Send) -> None:
    assert scope["type"] == "http"
    if scope["path"] == "/upload":
        while (await receive()).get("more_body"):
            pass
    await send(
        {"type": "http.response.start", "status": 200, "headers": [(b"content-length", b"2")]}
    )
    await send({"type": "http.response.body", "body": b"ok"})


@pytest.fixture
def address() -> Iterator[tuple[str, int]]:
    with socket.create_server(("127.0.0.1", 0)) as listener:
        server = uvicorn.Server(
            uvicorn.Config(
                _app, http=Connection, timeout_keep_alive=KEPT_S, lifespan="off", log_config=None
            )
        )
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
        thread.start()
        yield listener.getsockname()
        server.should_exit = True
        thread.join()


def _is_closed(client: socket.socket) -> bool:
    client.settimeout(4 * KEPT_S)
    try:
        return client.recv(100) == b""
    except TimeoutError:
        return False


def _is_answered(client: socket.socket) -> bool:
    """Head and body may come one after the other."""
    answer = b""
    while part := client.recv(1000):
        answer += part
        if answer.endswith(b"ok"):
            return True
    return False


def test_who_asks_nothing_in_time_is_let_go(address: tuple[str, int]) -> None:
    with (
        socket.create_connection(address) as silent,
        socket.create_connection(address) as half,
        socket.create_connection(address) as served,
    ):
        half.sendall(HEAD)
        served.sendall(HEAD + b"\r\n")
        assert _is_answered(served)
        served.sendall(HEAD[:9])  # the head of a second request, begun
        for client in (silent, half, served):
            assert _is_closed(client)


def test_a_slow_body_is_waited_for(address: tuple[str, int]) -> None:
    with socket.create_connection(address, timeout=10) as client:
        client.sendall(b"POST /upload HTTP/1.1\r\nHost: here\r\nContent-Length: 3\r\n\r\n")
        for part in (b"a", b"b", b"c"):
            time.sleep(0.6 * KEPT_S)
            client.sendall(part)
        assert _is_answered(client)
