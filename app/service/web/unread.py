"""Close connections whose clients do not read their answers."""

import asyncio
import contextlib
import fcntl
import logging
import struct
import termios

from uvicorn.protocols.http.httptools_impl import HttpToolsProtocol

log = logging.getLogger("knitcore.app")

TESTED_UVICORN = "0.54"
"""The minor version that this module and :mod:`app.viewer.sockets` were tested with.

``pyproject.toml`` allows no other, since both change protocols that uvicorn does not document.
"""

STALLED_S = 30.0
"""Time in which a client must take a part of an answer, or the rest of it."""
LEAST_BYTES = 65_536
"""Size of that part: with less, one byte now and then would keep a large answer for ever."""


class WatchedProtocol(HttpToolsProtocol):
    """HTTP that closes a connection whose client reads no more; uvicorn's would keep it."""

    _watch: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]
        """Begin, with :meth:`pause_writing` called as soon as a single byte has to wait."""
        super().connection_made(transport)
        transport.set_write_buffer_limits(0)

    def handle_websocket_upgrade(self) -> None:
        """Hand the connection on, with the limits that its next protocol expects."""
        self.transport.set_write_buffer_limits()
        super().handle_websocket_upgrade()

    def pause_writing(self) -> None:
        """Begin to check, from time to time, whether the client takes what waits."""
        super().pause_writing()
        self._look_after(self._unread_bytes())

    def resume_writing(self) -> None:
        """End the checks: the client has taken everything."""
        self._stop_looking()
        super().resume_writing()

    def connection_lost(self, exc: Exception | None) -> None:
        """End the checks: the connection is closed."""
        self._stop_looking()
        super().connection_lost(exc)

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
