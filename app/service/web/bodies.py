"""Bodies of requests: their largest sizes, and the places where they are decoded.

One rule for all addresses: the event loop decodes small bodies at once. A large one goes as it came
to a worker, with its limits on time and memory, where the operation takes it; elsewhere, such as
a design, it is decoded in its turn, one at a time, and has a lower limit; the next one waits as
long again as it has held the loop, so that all others are answered in between. Decoding in threads
would not help: Python runs one at a time.
"""

import asyncio
import time
from collections.abc import Callable, Coroutine
from dataclasses import dataclass
from inspect import iscoroutinefunction
from typing import Any

import numpy as np
from fastapi import Request, Response
from fastapi.routing import APIRoute
from pydantic import WrapValidator
from starlette.types import Message, Receive

from ...requests.base import decoded
from ...requests.charts import MAX_FIELD
from ..identity import current_user
from ..limits.fair_queue import FairLock
from ..problems import TooLargeError

SMALL_BYTES = 64_000
SMALL_SIGNS = 2_000
"""Largest body that is decoded without waiting for a turn, and the commas and colons in it: to
decode 14,000 takes 6 ms, and a dozen may come at once."""
MAX_DECODED_BYTES = 4_000_000
"""Largest body that the service decodes itself; a design of the largest chart is smaller."""
MAX_VALUES = MAX_FIELD + 10_000
"""Values in a JSON body, counted by commas and opening brackets: a field on the largest chart that
has one, and whatever comes with it. Reading and checking them takes some 30 ms. Charts and files
are one value each."""
MAX_NAMES = 100_000
"""Names in a JSON body that the service decodes, counted by colons: to read 140,000 different ones
takes 110 ms."""


@dataclass(frozen=True)
class Undecoded:
    """A body as it came, for a worker to decode."""

    content: bytes


OrUndecoded = WrapValidator(
    lambda value, decode: value if isinstance(value, Undecoded) else decode(value)
)
"""Mark of a body's model: a worker may decode the body if it is large."""


Handler = Callable[[Request], Coroutine[Any, Any, Response]]


class BoundedRoute(APIRoute):
    """A route whose large bodies are decoded in turn, and which takes a thread in turn.

    FastAPI runs functions that are not asynchronous in threads. Without turns, one user's requests
    would take all of them, and everybody else would stand in line behind those that wait.
    """

    to_worker = False

    def get_route_handler(self) -> Handler:
        """Return the function that handles a request."""
        handle = super().get_route_handler()
        if not iscoroutinefunction(self.endpoint):
            handle = _in_turn(handle)

        async def bounded(request: Request) -> Response:
            length = request.headers.get("content-length", "0")
            if not self.to_worker and int(length) > MAX_DECODED_BYTES:
                raise _too_large(MAX_DECODED_BYTES)
            content = await request.body()
            if len(content) <= SMALL_BYTES and _count(content, b",:") <= SMALL_SIGNS:
                return await handle(_Decoded(request.scope, request.receive, content))
            if self.to_worker:
                return await handle(_Uncut(request.scope, request.receive, content))
            if len(content) > MAX_DECODED_BYTES or _count(content, b":") > MAX_NAMES:
                raise _too_large(MAX_DECODED_BYTES)
            lock: FairLock = request.app.state.large_bodies
            large = _Decoded(request.scope, request.receive, content)
            async with lock.turn(current_user.get(), rest=lambda: large.held_s):
                return await handle(large)

        return bounded


def _in_turn(handle: Handler) -> Handler:
    """Handle requests in a thread each, of which users take turns."""

    async def in_turn(request: Request) -> Response:
        threads: FairLock = request.app.state.threads
        async with threads.turn(current_user.get()):
            return await handle(request)

    return in_turn


class WorkerRoute(BoundedRoute):
    """A route whose large bodies are decoded by a worker; the model of its body is marked with
    ``OrUndecoded``."""

    to_worker = True


class _Received(Request):
    """A request whose body has been received."""

    def __init__(self, scope: Any, receive: Receive, content: bytes) -> None:
        super().__init__(scope, receive)
        self._body = content


class _Decoded(_Received):
    """A request whose JSON is decoded by our rules.

    Attributes
    ----------
    held_s : how long decoding and checking it has held the event loop.
    """

    held_s = 0.0

    async def json(self) -> Any:
        """The body, decoded."""
        asyncio.get_running_loop().call_soon(self._let_go, time.monotonic())
        return decoded(self._body)

    def _let_go(self, began: float) -> None:
        self.held_s = time.monotonic() - began


class _Uncut(_Received):
    """A request whose JSON is not decoded."""

    async def json(self) -> Undecoded:
        """The body as it came."""
        return Undecoded(self._body)


def limited(receive: Receive, most_bytes: int, count: Callable[[int], None]) -> Receive:
    """Receive a body and refuse it once it is too large, whatever its head says.

    Parameters
    ----------
    count : called with the bytes of each part; may refuse it.
    """
    seen = values = 0

    async def receive_some() -> Message:
        nonlocal seen, values
        message = await receive()
        if message["type"] == "http.request" and (body := message.get("body", b"")):
            seen += len(body)
            values += _count(body, b",[{")
            if seen > most_bytes or values > MAX_VALUES:
                raise _too_large(most_bytes)
            count(len(body))
        return message

    return receive_some


def _count(body: bytes, signs: bytes) -> int:
    """How often any of some signs stands in a body; ``bytes.count`` takes four times as long."""
    seen = np.frombuffer(body, np.uint8)
    return sum(int(np.count_nonzero(seen == sign)) for sign in signs)


def _too_large(most_bytes: int) -> TooLargeError:
    detail = (
        f"A request has at most {most_bytes} bytes, {MAX_VALUES} values and {MAX_NAMES} names here."
    )
    return TooLargeError(detail, field="body", remedy="Send less at once.")
