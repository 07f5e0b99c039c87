"""Progress of an answer that is handed to the server; it begins once and ends once."""

import asyncio
from collections.abc import Callable, Iterator
from itertools import chain

from starlette.datastructures import Headers
from starlette.responses import Response
from starlette.types import Message, Receive, Scope, Send
from starlette.websockets import WebSocketClose

from ..problems import ServiceError

PART_BYTES = 65_536
"""Largest part of an answer that is handed over at once; the server takes the next one when the
client has got this one, as far as the system's buffers do not hold it."""


class Answer:
    """The answer to a request or on a websocket, as far as it has been sent.

    Parameters
    ----------
    send : hands a message to the server.
    count : counts bytes of answers that are in memory; raises ServiceError if they are too many.

    Attributes
    ----------
    started : whether the head of a response was sent.
    complete : whether the last part was sent, or the websocket was closed from either side.
    refusal : why the answer was taken over instead of sent: too many wait for this user already.
    """

    def __init__(self, send: Send, count: Callable[[int], None] = lambda _: None) -> None:
        self.started = self.complete = False
        self.refusal: ServiceError | None = None
        self._send = send
        self._count = count
        self._head: Message | None = None  # of an answer of known length, until it is counted
        self._turn = asyncio.Lock()
        self._is_taken_over = False
        self._missing_bytes: int | None = None  # of the length in its head; None without one

    async def send(self, message: Message) -> None:
        """Send what the application says, unless :meth:`take_over` was first.

        Raises
        ------
        ServiceError
            If too much waits already, and this answer has begun.
        """
        size = len(message.get("body", b""))
        if size > PART_BYTES and not self._is_taken_over:
            try:
                self._count(size)
            except ServiceError as error:
                if self.started:
                    raise
                self.refusal, self._is_taken_over = error, True
        if message["type"] == "http.response.start" and "content-length" in Headers(scope=message):
            self._head = message
            return
        head, self._head = self._head, None
        for part in chain([head] if head else [], _parts(message)):
            async with self._turn:
                if not self._is_taken_over:
                    await self._hand_over(part)

    async def take_over(self) -> bool:
        """Send nothing of the application any more, from between two messages on.

        Returns
        -------
        False if the answer is complete.
        """
        async with self._turn:
            self._is_taken_over = not self.complete
            return self._is_taken_over

    async def end(self, instead: Response | WebSocketClose, scope: Scope, receive: Receive) -> None:
        """End an answer that was taken over, so that it cannot be mistaken for a whole one.

        Before its start ``instead`` is sent, and a stream just ends. A part of a response of known
        length is left as it is: the server then closes the connection.
        """
        if not self.started:
            await instead(scope, receive, self._hand_over)
        elif not self._missing_bytes:
            await self._hand_over({"type": "http.response.body", "body": b""})

    def heard(self, message: Message) -> Message:
        """Note what the client says: it may have closed the websocket."""
        self.complete |= message["type"] == "websocket.disconnect"
        return message

    async def _hand_over(self, message: Message) -> None:
        if message["type"] == "http.response.start":
            self.started = True
            length = Headers(scope=message).get("content-length", "")
            self._missing_bytes = int(length) if length.isdigit() else None
        elif message["type"] == "http.response.body":
            self.complete = not message.get("more_body", False)
            if self._missing_bytes is not None:
                self._missing_bytes -= len(message.get("body", b""))
        elif message["type"] in ("websocket.close", "websocket.http.response.start"):
            self.complete = True  # nothing can be added to either
        await self._send(message)


def _parts(message: Message) -> Iterator[Message]:
    """The message, its body in parts."""
    body = message.get("body", b"")
    if message["type"] != "http.response.body" or len(body) <= PART_BYTES:
        yield message
        return
    for start in range(0, len(body), PART_BYTES):
        end = start + PART_BYTES
        more = end < len(body) or message.get("more_body", False)
        yield {**message, "body": bytes(body[start:end]), "more_body": more}
