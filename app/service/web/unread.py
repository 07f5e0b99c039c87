"""Close connections whose clients do not read their answers, or send heads without end."""

import asyncio
import contextlib
import fcntl
import logging
import struct
import termios
from typing import Any

from httptools import HttpParserError
from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol

log = logging.getLogger("knitcore.app")

TESTED_UVICORN = "0.54"
"""The minor version that this module and :mod:`app.viewer.sockets` were tested with.

``pyproject.toml`` allows no other, since both change protocols that uvicorn does not document.
"""

STALLED_S = 30.0
"""Time in which a client must take a part of an answer, or the rest of it."""
MAX_HEAD_BYTES = 65_536
"""Longest head of a request; a proxy allows half of it."""
MAX_HEADERS = 200
LEAST_BYTES = 65_536
"""Size of that part: with less, one byte now and then would keep a large answer for ever."""


class EndingStalled:
    """Part of a protocol of uvicorn: closes a connection whose client reads no more."""

    loop: asyncio.AbstractEventLoop
    transport: asyncio.Transport
    _watch: asyncio.TimerHandle | None = None

    def connection_made(self, transport: Any) -> None:
        """Begin, with :meth:`pause_writing` called as soon as a single byte has to wait."""
        super().connection_made(transport)  # type: ignore[misc]
        transport.set_write_buffer_limits(0)

    def pause_writing(self) -> None:
        """Begin to check, from time to time, whether the client takes what waits."""
        super().pause_writing()  # type: ignore[misc]
        self._look_after(self._unread_bytes())

    def resume_writing(self) -> None:
        """End the checks: the client has taken everything."""
        self._stop_looking()
        super().resume_writing()  # type: ignore[misc]

    def connection_lost(self, exc: Exception | None) -> None:
        """End the checks: the connection is closed."""
        self._stop_looking()
        super().connection_lost(exc)  # type: ignore[misc]

    def _look_after(self, before: int) -> None:
        self._watch = self.loop.call_later(STALLED_S, self._look, before)

    def _look(self, before: int) -> None:
        unread = self._unread_bytes()
        if before - unread >= LEAST_BYTES:
            self._look_after(unread)
            return
        log.info(
            "closed a connection whose client had read %d bytes in %g s", before - unread, STALLED_S
        )
        self.transport.abort()  # to close it would wait for the client

    def _stop_looking(self) -> None:
        if self._watch is not None:
            self._watch.cancel()

    def _unread_bytes(self) -> int:
        """Bytes that wait here, and those in the system's buffer that the client has not got."""
        unread = self.transport.get_write_buffer_size()
        with contextlib.suppress(OSError):  # not every system tells
            socket = self.transport.get_extra_info("socket")
            (there,) = struct.unpack("i", fcntl.ioctl(socket.fileno(), termios.TIOCOUTQ, bytes(4)))
            unread += there
        return unread


class WatchedProtocol(EndingStalled, HttpToolsProtocol):
    """HTTP that keeps no connection whose client reads no more, or whose head has no end; uvicorn's
    would."""

    _head_bytes: int | None = None  # of a head that has not come to its end

    def data_received(self, data: bytes) -> None:
        """Read what has come, and refuse a head that is long and goes on."""
        super().data_received(data)
        if self._head_bytes is not None:
            self._head_bytes += len(data)
            if self._head_bytes > MAX_HEAD_BYTES and not self.transport.is_closing():
                self.send_400_response("The head is too long.")

    def on_message_begin(self) -> None:
        """Begin a request."""
        self._head_bytes = 0
        super().on_message_begin()

    def on_header(self, name: bytes, value: bytes) -> None:
        """Read a header, one of few."""
        if len(self.headers) == MAX_HEADERS:
            raise HttpParserError
        super().on_header(name, value)

    def on_headers_complete(self) -> None:
        """Refuse a long head that came at once."""
        self._head_bytes = None
        if sum(len(name) + len(value) + 4 for name, value in self.headers) > MAX_HEAD_BYTES:
            raise HttpParserError
        super().on_headers_complete()
