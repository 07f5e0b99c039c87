"""Connections of browsers to views: how large a message they may send, and how slowly they read."""

from typing import Any

from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

from ..service.web.unread import EndingStalled

ALLOW = "knitcore.allow_bytes"
"""Name of the extension of a connection's scope: a function that sets the largest message."""


class SizedProtocol(EndingStalled, WebSocketsSansIOProtocol):
    """uvicorn's protocol of websockets, whose largest message may change while it is open.

    A longer message is refused by its head, before any of it is held in memory. What is sent has
    left this process when :meth:`send` returns.
    """

    async def send(self, message: Any) -> None:
        """Send a message, and wait until the client takes it."""
        await super().send(message)
        await self.writable.wait()

    def keepalive_timeout(self) -> None:
        """Close a connection that answers no ping; not while the ping waits behind a message."""
        if self.writable.is_set():
            super().keepalive_timeout()
        else:
            self.pong_timer = self.loop.call_later(self.ping_timeout or 0, self.keepalive_timeout)

    def handle_connect(self, event: Any) -> None:
        """Begin a connection, and let the application set its largest message."""
        super().handle_connect(event)
        if self.response.status_code == 101:  # the application runs from the loop's next turn on
            extensions: dict[str, Any] = self.scope["extensions"]
            extensions[ALLOW] = self._allow

    def _allow(self, size: int) -> None:
        self.conn.max_message_size = size
