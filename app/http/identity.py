"""Who is asking: the guard tells, and everything behind it may ask."""

from __future__ import annotations

from contextvars import ContextVar

LOCAL_USER = "local"
"""Whoever sits at this machine, while the service asks for no login."""

current_user: ContextVar[str] = ContextVar("current_user", default=LOCAL_USER)
current_session: ContextVar[str] = ContextVar("current_session", default="")
"""Id of the browser's session, if it came with one."""


async def asking() -> str:
    """The user whose request this is; asynchronous, for FastAPI gives others a thread."""
    return current_user.get()
