"""Clients that wait: server-sent events, and whether somebody still waits for an answer."""

from collections.abc import AsyncGenerator, AsyncIterator
from contextlib import aclosing
from typing import Any

from fastapi import Request
from fastapi.responses import StreamingResponse

from ..identity import current_user
from ..limits.user_limits import ConcurrencyLimit
from ..problems import StoppingError

QUIET_S = 15.0


def stream_of(events: str) -> dict[str, Any]:
    """Options of a route whose answer is a stream of such events."""
    answer = {"content": {"text/event-stream": {}}, "description": events}
    return {"response_class": StreamingResponse, "responses": {200: answer}}


def event_stream(
    request: Request, events: AsyncGenerator[str | None], period_s: float, quiet_s: float = QUIET_S
) -> StreamingResponse:
    """A response that lasts as long as there are events.

    Parameters
    ----------
    events : each as its text; None where a period passed without one.
    period_s : how long a period lasts.
    quiet_s : time without an event after which a line is sent, so that a vanished client is
        noticed.

    Raises
    ------
    OverLimitError
        If the user follows too many streams already.
    """
    concurrency: ConcurrencyLimit = request.app.state.concurrency
    concurrency.check("streams", current_user.get())
    return StreamingResponse(
        _lines(concurrency, current_user.get(), events, round(quiet_s / period_s)),
        media_type="text/event-stream",
        headers={"Cache-Control": "no-store", "X-Accel-Buffering": "no"},
    )


async def _lines(
    concurrency: ConcurrencyLimit, owner: str, events: AsyncGenerator[str | None], most_quiet: int
) -> AsyncIterator[bytes]:
    quiet = 0
    with concurrency.hold("streams", owner):
        async with aclosing(events):
            async for text in events:
                quiet = 0 if text else quiet + 1
                if text:
                    yield text.encode()
                elif quiet % most_quiet == 0:
                    yield b": still there\n\n"


async def abandoned(request: Request) -> bool:
    """Return whether the client of a request has gone.

    Raises
    ------
    StoppingError
        If the service stops, which then refuses what is waited for.
    """
    if request.app.state.stopping:
        raise StoppingError("The service is stopping.")
    return await request.is_disconnected()
