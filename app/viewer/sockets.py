"""Connections of browsers to views: how large a message they may send."""

from typing import Any

from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

ALLOW = "knitcore.allow_bytes"
"""Name of the extension of a connection's scope: a function that sets the largest message."""


class SizedProtocol(WebSocketsSansIOProtocol):
    """uvicorn's protocol of websockets, whose largest message may change while it is open.

    A longer message is refused by its head, before any of it is held in memory.
    """

    def handle_connect(self, event: Any) -> None:
        """Begin a connection, and let the application set its largest message."""
        super().handle_connect(event)
        if self.response.status_code == 101:  # the application runs from the loop's next turn on
            extensions: dict[str, Any] = self.scope["extensions"]
            extensions[ALLOW] = self._allow

    def _allow(self, size: int) -> None:
        self.conn.max_message_size = size
