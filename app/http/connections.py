"""Connections to the service: how many, and limits on a request before it is read.

uvicorn limits time only after an answer, and neither heads nor frames of websockets. A client that
sends nothing, or a head or a body byte by byte, would keep its connection, and a file handle of the
service, for ever; an endless head would fill the memory; bodies in tiny pieces, pipelined requests
and pings would hold up the event loop.
"""

from __future__ import annotations

import asyncio
import logging
import time
from collections import Counter
from collections.abc import Callable
from typing import Any

from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol
from websockets.frames import Frame

from app.limits.rate import RateLimit

log = logging.getLogger("knitcore.app")

BODY_GRACE_S = 20.0
MIN_BYTES_PER_S = 20_000
"""Slowest body that is accepted after the grace period."""
MAX_BESIDE_BYTES = 32_000
"""Most bytes of a request besides its body: address, headers, chunk sizes, trailers. Chunk sizes
may add as many as the body has."""
MAX_HEADERS = 100
MAX_AHEAD = 8
"""Most pipelined requests on one connection; browsers send none."""
FREE_PARTS, MIN_PART_BYTES = 1_000, 100
"""A body may come in FREE_PARTS parts of any size; if in more, they must have this mean size."""
FRAMES_PER_S, FRAMES_AT_ONCE = 300.0, 1_200
"""Limits of one websocket; while a view is turned, the page sends one for each screen refresh."""
LOOKED_AT_BYTES = 4_000
"""Bytes read from a websocket at a time; its frames are counted in between."""
TOLD_EVERY_S = 60.0


class Door:
    """Counts open connections, and closes those beyond the limits.

    Parameters
    ----------
    most : connections in all, below the file handles that the process may have.
    most_each : connections of one address.
    is_proxy : whether an address belongs to a trusted proxy, which serves many clients.
    """

    def __init__(
        self, most: int, most_each: int, is_proxy: Callable[[str], bool] = lambda _: False
    ) -> None:
        self._most = most
        self._most_each = most_each
        self._is_proxy = is_proxy
        self._open: Counter[str] = Counter()
        self._told_at = -TOLD_EVERY_S

    def enter(self, address: str) -> bool:
        """Count a new connection; False if it exceeds a limit."""
        full = self._open.total() >= self._most
        if full or (self._open[address] >= self._most_each and not self._is_proxy(address)):
            self._tell("in all" if full else f"of {address}")
            return False
        self._open[address] += 1
        return True

    def leave(self, address: str) -> None:
        """Count a closed connection."""
        self._open[address] -= 1
        if self._open[address] <= 0:
            del self._open[address]

    def __len__(self) -> int:
        return self._open.total()

    def _tell(self, whose: str) -> None:
        now = time.monotonic()
        if now - self._told_at >= TOLD_EVERY_S:
            self._told_at = now
            log.warning("too many connections %s: new ones are closed", whose)


class TooMuchError(Exception):
    """Stops the parser; the client gets status 400."""


class Connection(HttpToolsProtocol):
    """A connection that is closed when a request does not come in time, or is out of bounds.

    A whole head must come within the time that an idle connection may be kept; a body, after a
    grace period, at a least speed.

    Parameters
    ----------
    door : counts connections; None without a limit.
    body_grace_s : how long a body may take, whatever its speed.
    """

    def __init__(
        self,
        *args: Any,
        door: Door | None = None,
        body_grace_s: float = BODY_GRACE_S,
        **kwargs: Any,
    ) -> None:
        super().__init__(*args, **kwargs)
        self._door = door
        self._counted: str | None = None
        self._body_grace_s = body_grace_s
        self._due: asyncio.TimerHandle | None = None
        self._body_since = 0.0
        self._body_bytes = self._body_parts = self._beside_bytes = 0

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Start waiting for the first head."""
        super().connection_made(transport)
        address = self.client[0] if self.client else ""
        if self._door is not None:
            if not self._door.enter(address):
                transport.abort()
                return
            self._counted = address
        self._await_head()

    def connection_lost(self, exc: Exception | None) -> None:
        """Stop waiting."""
        self._stop_waiting()
        self._leave()
        super().connection_lost(exc)

    def handle_websocket_upgrade(self) -> None:
        """Leave websockets to their own protocol; the budgets of users count them."""
        self._stop_waiting()
        self._leave()
        super().handle_websocket_upgrade()

    def data_received(self, data: bytes) -> None:
        """Read on, unless too much has come that is not a body."""
        self._beside_bytes += len(data)
        super().data_received(data)
        too_much = self._beside_bytes > MAX_BESIDE_BYTES + self._body_bytes
        if too_much and not self.transport.is_closing():
            self.send_400_response("The request is too long beside its body.")

    def on_header(self, name: bytes, value: bytes) -> None:
        """A header has come."""
        super().on_header(name, value)
        if len(self.headers) > MAX_HEADERS:
            raise TooMuchError

    def on_message_begin(self) -> None:
        """The head has begun; its end is due."""
        super().on_message_begin()
        if self._due is None:
            self._await_head()

    def on_headers_complete(self) -> None:
        """The head is complete; the body is due."""
        if len(self.pipeline) >= MAX_AHEAD:
            raise TooMuchError
        self._stop_waiting()
        super().on_headers_complete()
        self._body_since = self.loop.time()
        self._due = self.loop.call_later(self._body_grace_s, self._look_at_body)

    def on_body(self, body: bytes) -> None:
        """A part of the body has come."""
        self._body_parts += 1
        self._body_bytes += len(body)
        if self._body_parts > FREE_PARTS + self._body_bytes / MIN_PART_BYTES:
            raise TooMuchError
        self._beside_bytes -= len(body)
        super().on_body(body)

    def on_message_complete(self) -> None:
        """The request is complete; the application takes over."""
        self._stop_waiting()
        self._body_bytes = self._body_parts = self._beside_bytes = 0
        super().on_message_complete()

    def _look_at_body(self) -> None:
        if self.flow.read_paused:  # the application is slow, not the client
            self._body_since += self._body_grace_s
        left = (
            self._body_since
            + self._body_grace_s
            + self._body_bytes / MIN_BYTES_PER_S
            - self.loop.time()
        )
        if left <= 0:
            self.transport.close()
        else:
            self._due = self.loop.call_later(left, self._look_at_body)

    def _await_head(self) -> None:
        self._due = self.loop.call_later(self.timeout_keep_alive, self.transport.close)

    def _stop_waiting(self) -> None:
        if self._due is not None:
            self._due.cancel()
            self._due = None

    def _leave(self) -> None:
        if self._door is not None and self._counted is not None:
            self._door.leave(self._counted)
            self._counted = None


class Socket(WebSocketsSansIOProtocol):
    """A websocket that is closed when its client sends too many frames.

    uvicorn would read all that have come before anybody else has a turn, answer every ping, and
    keep every fragment, also empty ones.
    """

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        super().__init__(*args, **kwargs)
        self._frames = RateLimit(FRAMES_PER_S, FRAMES_AT_ONCE)

    def data_received(self, data: bytes) -> None:
        """Read frames, a few at a time."""
        for start in range(0, len(data), LOOKED_AT_BYTES):
            if self.transport.is_closing():
                return
            super().data_received(data[start : start + LOOKED_AT_BYTES])

    def handle_ping(self) -> None:
        """Answer a ping."""
        if self._may_go_on():
            super().handle_ping()

    def handle_pong(self, event: Frame) -> None:
        """Take the answer to a ping of the service."""
        if self._may_go_on():
            super().handle_pong(event)

    def handle_text(self, event: Frame) -> None:
        """Take a text, or its beginning."""
        if self._may_go_on():
            super().handle_text(event)

    def handle_bytes(self, event: Frame) -> None:
        """Take a message, or its beginning."""
        if self._may_go_on():
            super().handle_bytes(event)

    def handle_cont(self, event: Frame) -> None:
        """Take a fragment of a message."""
        if self._may_go_on():
            super().handle_cont(event)

    def _may_go_on(self) -> bool:
        if self.transport.is_closing():
            return False
        if self._frames.take("")[1]:
            log.warning("a websocket is closed: its client sends too many frames")
            self.transport.abort()
            return False
        return True
