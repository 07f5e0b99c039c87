"""Connections that ask for nothing."""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import queue
import socket
import threading
import time
from collections.abc import Iterator
from functools import partial

import pytest
import uvicorn
import uvloop
from starlette.types import Receive, Scope, Send
from uvicorn.server import ServerState

from app.http.connections import (
    FRAMES_AT_ONCE,
    FREE_PARTS,
    MAX_AHEAD,
    MAX_HEADERS,
    MIN_BYTES_PER_S,
    Connection,
    Door,
    Socket,
)

KEPT_S = 60
"""Of the service's clock, which tests set forward."""
PATIENCE_S = 60.0
MOST = 6
DOOR = Door(most=100, most_each=MOST)
HEAD = b"GET / HTTP/1.1\r\nHost: here\r\n"


class _Loop(asyncio.SelectorEventLoop):
    """Its clock can be set forward."""

    _ahead_s = 0.0

    def time(self) -> float:
        return super().time() + self._ahead_s

    def set_forward(self, seconds: float) -> None:
        """From another thread; what was due until then has been done afterwards."""

        async def leap() -> None:
            self._ahead_s += seconds
            for _ in range(10):
                await asyncio.sleep(0)

        asyncio.run_coroutine_threadsafe(leap(), self).result(PATIENCE_S)


_read: queue.SimpleQueue[int] = queue.SimpleQueue()
"""Sizes of the parts of a body as they are read."""


async def _app(scope: Scope, receive: Receive, send: Send) -> None:
    assert scope["type"] == "http"
    if scope["path"] == "/upload":
        more = True
        while more:
            message = await receive()
            _read.put(len(message.get("body", b"")))
            more = message.get("more_body", False)
    await send(
        {"type": "http.response.start", "status": 200, "headers": [(b"content-length", b"2")]}
    )
    await send({"type": "http.response.body", "body": b"ok"})


@contextlib.contextmanager
def _serving(loop: asyncio.AbstractEventLoop) -> Iterator[tuple[str, int]]:
    """Address of a service that runs in a loop."""
    with socket.create_server(("127.0.0.1", 0)) as listener:
        server = uvicorn.Server(
            uvicorn.Config(
                _app,
                http=partial(Connection, door=DOOR, body_grace_s=KEPT_S),  # type: ignore[arg-type]
                timeout_keep_alive=KEPT_S,
                lifespan="off",
                log_config=None,
            )
        )
        thread = threading.Thread(
            target=loop.run_until_complete, args=[server.serve(sockets=[listener])]
        )
        thread.start()
        yield listener.getsockname()
        server.should_exit = True
        thread.join()
        loop.close()


@pytest.fixture
def address() -> Iterator[tuple[str, int]]:
    """Of a service as people run it."""
    with _serving(uvloop.new_event_loop()) as found:
        yield found


@pytest.fixture
def loop() -> _Loop:
    return _Loop()


@pytest.fixture
def timed(loop: _Loop) -> Iterator[tuple[str, int]]:
    """Address of a service whose time passes when a test says so."""
    with _serving(loop) as found:
        yield found


def _is_closed(client: socket.socket, loop: _Loop) -> bool:
    """Whether a connection is closed by the service within a few times ``KEPT_S``."""
    client.settimeout(1)
    for _ in range(4):
        loop.set_forward(KEPT_S)
        try:
            return client.recv(100) == b""
        except ConnectionResetError:  # it had not read all
            return True
        except TimeoutError:
            continue
    return False


def _is_answered(client: socket.socket) -> bool:
    """Head and body may come one after the other."""
    answer = b""
    while part := client.recv(1000):
        answer += part
        if answer.endswith(b"ok"):
            return True
    return False


def test_a_client_that_sends_no_request_in_time_is_disconnected(
    timed: tuple[str, int], loop: _Loop
) -> None:
    with (
        socket.create_connection(timed) as silent,
        socket.create_connection(timed) as half,
        socket.create_connection(timed) as served,
    ):
        half.sendall(HEAD)
        served.sendall(HEAD + b"\r\n")
        assert _is_answered(served)
        served.sendall(HEAD[:9])  # the head of a second request, begun
        for client in (silent, half, served):
            assert _is_closed(client, loop)


def _upload(size: int) -> bytes:
    return f"POST /upload HTTP/1.1\r\nHost: here\r\nContent-Length: {size}\r\n\r\n".encode()


def _until_read(size: int) -> None:
    while size > 0:
        size -= _read.get(timeout=PATIENCE_S)


def test_a_body_that_comes_fast_enough_is_waited_for(timed: tuple[str, int], loop: _Loop) -> None:
    part = bytes(MIN_BYTES_PER_S * KEPT_S)
    with socket.create_connection(timed, timeout=PATIENCE_S) as client:
        client.sendall(_upload(3 * len(part)))
        for _ in range(3):
            client.sendall(part)
            _until_read(len(part))
            loop.set_forward(0.8 * KEPT_S)
        assert _is_answered(client)


def test_a_client_that_sends_a_body_byte_by_byte_is_disconnected(
    timed: tuple[str, int], loop: _Loop
) -> None:
    with (
        socket.create_connection(timed) as silent,
        socket.create_connection(timed) as slow,
    ):
        silent.sendall(_upload(100))
        slow.sendall(_upload(100) + b"a")
        _until_read(1)
        loop.set_forward(0.5 * KEPT_S)
        slow.sendall(b"b")
        _until_read(1)
        assert _is_closed(silent, loop)
        assert _is_closed(slow, loop)


def test_an_address_has_so_many_connections(address: tuple[str, int]) -> None:
    with contextlib.ExitStack() as stack:
        clients = [
            stack.enter_context(socket.create_connection(address, timeout=PATIENCE_S))
            for _ in range(MOST + 2)
        ]
        for client in clients:
            with contextlib.suppress(OSError):  # closed already
                client.sendall(HEAD + b"\r\n")
        assert [_is_served(client) for client in clients] == [True] * MOST + [False] * 2
    deadline = time.monotonic() + PATIENCE_S
    while len(DOOR):  # until the others are gone
        assert time.monotonic() < deadline
        time.sleep(0.01)
    with socket.create_connection(address, timeout=PATIENCE_S) as next_one:
        next_one.sendall(HEAD + b"\r\n")
        assert _is_answered(next_one)


def _is_served(client: socket.socket) -> bool:
    try:
        return _is_answered(client)
    except ConnectionError:
        return False


def test_a_proxy_speaks_for_many_and_handles_are_bounded(
    caplog: pytest.LogCaptureFixture,
) -> None:
    door = Door(most=5, most_each=2, is_proxy=lambda address: address == "proxy")
    assert [door.enter("a") for _ in range(3)] == [True, True, False]
    assert [door.enter("proxy") for _ in range(4)] == [True, True, True, False]
    door.leave("a")
    assert door.enter("b")
    assert len([r for r in caplog.records if "too many connections" in r.message]) == 1


def _chunk(size: int) -> bytes:
    return b"%x\r\n%s\r\n" % (size, b" " * size)


CHUNKED = b"POST /upload HTTP/1.1\r\nHost: here\r\nTransfer-Encoding: chunked\r\n\r\n"
ENDLESS = {
    "address": (b"GET /", itertools.repeat(b"a" * 10_000, 10)),
    "header": (HEAD + b"A: ", itertools.repeat(b"a" * 10_000, 10)),
    "headers": (HEAD, itertools.repeat(b"a: b\r\n", MAX_HEADERS + 1)),
    "chunks of one byte": (CHUNKED, itertools.repeat(_chunk(1), 2 * FREE_PARTS)),
    "trailer": (CHUNKED + b"0\r\nA: ", itertools.repeat(b"a" * 10_000, 10)),
    "requests ahead": (b"", itertools.repeat(HEAD + b"\r\n", 10 * MAX_AHEAD)),
}


@pytest.mark.parametrize("endless", ENDLESS)
def test_endless_heads_crumbs_and_requests_ahead_are_refused(
    address: tuple[str, int], endless: str
) -> None:
    """The service answers 400 and closes; what it has left unread may reset the connection, so
    that the answer is lost. One that waited for more would end this test by its time limit.
    """
    begin, more = ENDLESS[endless]
    answers, reset = b"", False
    with socket.create_connection(address, timeout=PATIENCE_S) as client:
        try:
            client.sendall(begin + b"".join(more))
            while part := client.recv(10_000):
                answers += part
        except (ConnectionResetError, BrokenPipeError):
            reset = True
    assert reset or b"HTTP/1.1 400" in answers
    assert answers.count(b"HTTP/1.1 200") <= MAX_AHEAD


def test_usual_chunks_and_heads_pass(address: tuple[str, int]) -> None:
    many = b"".join(b"a%d: b\r\n" % n for n in range(MAX_HEADERS - 2))
    with socket.create_connection(address, timeout=PATIENCE_S) as client:
        client.sendall(HEAD + many + b"\r\n")
        assert _is_answered(client)
        client.sendall(CHUNKED + b"".join([_chunk(200)] * 2 * FREE_PARTS) + b"0\r\n\r\n")
        assert _is_answered(client)


class _Wire:
    """A transport that keeps what is written."""

    def __init__(self) -> None:
        self.written, self.closed = b"", False

    def write(self, data: bytes) -> None:
        self.written += data

    def abort(self) -> None:
        self.closed = True

    close = abort

    def is_closing(self) -> bool:
        return self.closed

    def get_extra_info(self, name: str, default: object = None) -> object:
        return default

    def pause_reading(self) -> None:
        pass


FRAMES = {"ping": 0x89, "pong": 0x8A, "text": 0x81, "message": 0x82}


@pytest.mark.parametrize("kind", FRAMES)
def test_a_websocket_with_too_many_frames_is_closed(kind: str) -> None:
    async def app(scope: Scope, receive: Receive, send: Send) -> None:
        await send({"type": "websocket.accept"})
        await asyncio.Event().wait()

    async def flood() -> tuple[bool, bool]:
        config = uvicorn.Config(app, log_config=None, lifespan="off")  # type: ignore[arg-type]
        config.load()
        wire = _Wire()
        end = Socket(config=config, server_state=ServerState(), app_state={})
        end.connection_made(wire)  # type: ignore[arg-type]
        end.data_received(
            b"GET / HTTP/1.1\r\nHost: here\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
            b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: YWFhYWFhYWFhYWFhYWFhYQ==\r\n\r\n"
        )
        while b"101" not in wire.written:
            await asyncio.sleep(0)
        frame = bytes([FRAMES[kind], 0x80]) + b"\0\0\0\0"
        end.data_received(frame * FRAMES_AT_ONCE)
        before = wire.closed
        end.data_received(frame * 10 * FRAMES_AT_ONCE)  # more than it may send in half a minute
        return before, wire.closed

    assert asyncio.run(flood()) == (False, True)
