"""Sessions of browsers: begun with a token, listed, and ended one by one."""

import secrets

from pydantic import AwareDatetime, BaseModel, Field
from sqlalchemy import Connection, delete, insert, select

from ..limits.user_limits import Use
from ..store.database import Database
from ..store.tables import now, sessions

SESSION_S = 30 * 86_400
MAX_SESSIONS = 50
"""Sessions of one user at once."""


class SessionSummary(BaseModel):
    """A browser that is signed in."""

    id: str
    created_at: AwareDatetime
    is_this: bool = Field(description="True if it is the session of this request.")


class SignedIn(BaseModel):
    """The user of this request, with all sessions, and what is used of the limits of one user."""

    user: str = Field(examples=["ada"])
    sessions: list[SessionSummary] = Field(
        description="Sessions, the latest first; scripts have none."
    )
    use: dict[str, Use] = Field(
        description="Use of each limit, by the name that a refusal has in `field`. Where there are "
        "several processes, figures are of this one, except those of stored things."
    )


class Sessions:
    """Sessions in the database."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def begin(self, token: str, user: str) -> str:
        """A new session of a user, by the id of the token that opened it; returns its id.

        The oldest ones beyond :data:`MAX_SESSIONS` end.
        """
        session = secrets.token_urlsafe(18)
        values = {"id": session, "token": token, "user": user, "created_at": now()}
        latest = (
            select(sessions.c.id)
            .where(sessions.c.user == user)
            .order_by(sessions.c.created_at.desc(), sessions.c.id)
            .limit(MAX_SESSIONS)
        )
        others = delete(sessions).where(
            sessions.c.user == user, sessions.c.id != session, sessions.c.id.not_in(latest)
        )

        def write(connection: Connection) -> None:
            connection.execute(insert(sessions).values(values))
            connection.execute(others)

        self._database.write(write)
        return session

    def find(self, session: str) -> tuple[str, str]:
        """(token, user) of a session; empty strings if there is none or it has expired."""
        query = select(sessions.c.token, sessions.c.user).where(
            sessions.c.id == session, sessions.c.created_at > now() - SESSION_S
        )
        with self._database.read() as connection:
            row = connection.execute(query).one_or_none()
        return ("", "") if row is None else (row.token, row.user)

    def of(self, user: str, this: str) -> list[SessionSummary]:
        """All sessions of a user, latest first; ``this`` is the one that asks."""
        query = (
            select(sessions)
            .where(sessions.c.user == user, sessions.c.created_at > now() - SESSION_S)
            .order_by(sessions.c.created_at.desc(), sessions.c.id)
        )
        with self._database.read() as connection:
            rows = connection.execute(query).all()
        return [
            SessionSummary.model_validate({**row._mapping, "is_this": row.id == this})
            for row in rows
        ]

    def end(self, user: str, session: str) -> bool:
        """End a session; False if the user has none of that id."""
        gone = delete(sessions).where(sessions.c.id == session, sessions.c.user == user)
        return self._database.write(lambda c: c.execute(gone).rowcount == 1)

    def tidy(self) -> None:
        """Delete expired sessions."""
        old = delete(sessions).where(sessions.c.created_at < now() - SESSION_S)
        self._database.write(lambda c: c.execute(old))
