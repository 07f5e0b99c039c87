"""Whether the answer to a request is still wanted."""

from __future__ import annotations

from fastapi import Request

from app.problems.errors import StoppingError


async def abandoned(request: Request) -> bool:
    """Whether the client of a request has gone.

    Raises
    ------
    StoppingError
        If the service stops, which then refuses what is waited for.
    """
    if request.app.state.stopping:
        raise StoppingError("The service is stopping.")
    return await request.is_disconnected()
