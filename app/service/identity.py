"""The user of a request: set by access control, read by everything behind it."""

from contextvars import ContextVar

LOCAL_USER = "local"
"""The user of this machine, while the service asks for no login."""
NOBODY = "-"
"""Name in the log for requests whose token or session is not known."""

current_user: ContextVar[str] = ContextVar("current_user", default=LOCAL_USER)
current_session: ContextVar[str] = ContextVar("current_session", default="")
"""Id of the browser's session, if it came with one."""


async def asking() -> str:
    """The user whose request this is; asynchronous, because FastAPI runs others in a thread."""
    return current_user.get()
