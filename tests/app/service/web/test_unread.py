"""A connection whose client does not read its answer, or sends a head without end, is closed; one
that reads slowly is not."""

import contextlib
import os
import socket
import time
from collections.abc import Iterator
from threading import Event
from unittest.mock import Mock

import pytest
from starlette.types import Receive, Scope, Send

from app.service.web import unread
from app.service.web.unread import LEAST_BYTES, MAX_HEAD_BYTES, WatchedProtocol
from tests.app.running import on_a_server

CONTENT = os.urandom(20_000_000)  # more than the buffers of a system hold
PART = 65_536


@pytest.fixture
def client(monkeypatch: pytest.MonkeyPatch) -> Iterator[tuple[socket.socket, Event]]:
    """A client that has sent a request, and an event: the application is no longer held up."""
    ended = Event()

    async def app(scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] != "http":
            return
        length = str(len(CONTENT)).encode()
        headers = [(b"content-length", length)]
        await send({"type": "http.response.start", "status": 200, "headers": headers})
        for start in range(0, len(CONTENT), PART):
            part = CONTENT[start : start + PART]
            await send({"type": "http.response.body", "body": part, "more_body": True})
        ended.set()

    monkeypatch.setattr(unread, "STALLED_S", 1.0)
    with on_a_server(app, http=WatchedProtocol, lifespan="off") as url, socket.socket() as client:
        client.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 100_000)
        client.settimeout(60)
        host, _, port = url.removeprefix("http://").partition(":")
        client.connect((host, int(port)))
        client.sendall(b"GET / HTTP/1.1\r\nHost: here\r\n\r\n")
        yield client, ended


def test_an_unread_answer_ends(client: tuple[socket.socket, Event]) -> None:
    connection, ended = client
    assert ended.wait(60)
    received = 0
    with contextlib.suppress(ConnectionError):
        while part := connection.recv(PART):
            received += len(part)
    assert received < len(CONTENT)


@pytest.mark.parametrize(("taken", "is_closed"), [(LEAST_BYTES, False), (1, True)])
def test_a_byte_now_and_then_keeps_no_connection(
    monkeypatch: pytest.MonkeyPatch, taken: int, is_closed: bool
) -> None:
    protocol = object.__new__(WatchedProtocol)
    protocol.loop, protocol.transport = Mock(), Mock()
    monkeypatch.setattr(protocol, "_unread_bytes", lambda: 1_000_000)
    protocol._look(1_000_000 + taken)
    assert protocol.transport.abort.called is is_closed
    assert protocol.loop.call_later.called is not is_closed


def test_a_slow_reader_gets_everything(client: tuple[socket.socket, Event]) -> None:
    connection, _ = client
    received, began = 0, time.monotonic()
    while received < len(CONTENT):
        received += len(connection.recv(PART, socket.MSG_WAITALL))
        if time.monotonic() - began < 3:  # far longer than an answer may stand still
            time.sleep(0.1)


@pytest.mark.parametrize(
    "head",
    [
        b"".join(b"X-%d:\r\n" % number for number in range(10_000)) + b"\r\n",
        b"X: " + b"x" * 2 * MAX_HEAD_BYTES,
        b"".join(b"X-%d: %s\r\n" % (number, b"x" * 1_000) for number in range(100)),
    ],
    ids=["at once", "in a word", "without end"],
)
def test_a_long_head_is_refused(client: tuple[socket.socket, Event], head: bytes) -> None:
    connection, _ = client
    with socket.create_connection(connection.getpeername()) as other:
        other.sendall(b"GET / HTTP/1.1\r\nHost: here\r\n" + head)
        assert other.recv(PART).startswith(b"HTTP/1.1 400")
