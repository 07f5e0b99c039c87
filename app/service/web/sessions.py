"""Users of the service: tokens made by a command, stored as hashes, and sessions of browsers, begun
with a token and kept in signed cookies."""

import hmac
import re
import secrets
import time

from itsdangerous import BadSignature, URLSafeTimedSerializer
from pydantic import AwareDatetime, BaseModel, Field
from sqlalchemy import ColumnElement, Connection, and_, delete, insert, or_, select, update

from knitcore.base.errors import InputError

from ..identity import LOCAL_USER
from ..limits.user_limits import Use
from ..store.database import Database
from ..store.tables import access_tokens, hash_of, now, service_keys, sessions

SESSION_S = 30 * 86_400
MAX_SESSIONS = 50
"""Sessions of one user at once."""
USER = re.compile(r"[A-Za-z0-9][A-Za-z0-9._@-]{0,79}")
REMEMBERED_S = 5.0
"""Time for which an answer of the database is kept; a revoked token may still work for as long."""
MAX_REMEMBERED = 10_000
ENVIRONMENT = "environment"
"""Identifier of the token in the settings."""


class TokenSummary(BaseModel):
    """A token without its secret."""

    id: str
    user: str
    label: str
    created_at: AwareDatetime
    expires_at: AwareDatetime | None
    revoked_at: AwareDatetime | None


class NewToken(TokenSummary):
    """A new token; its secret is shown only here."""

    token: str


class TokenList(BaseModel):
    """All tokens, oldest first."""

    tokens: list[TokenSummary]


class Tokens:
    """Tokens in the database."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def create(self, user: str, label: str = "", days: float | None = None) -> NewToken:
        """A new token of a user.

        Raises
        ------
        InputError
            If the name cannot be one of a user.
        """
        if not USER.fullmatch(user) or user == LOCAL_USER:
            raise InputError(
                "user",
                f"{user!r} cannot be a user's name.",
                "Use letters, digits, and . _ @ - inside; not “local”.",
            )
        token, at = secrets.token_urlsafe(32), self._database.clock
        values = {
            "id": secrets.token_hex(4),
            "user": user,
            "token_hash": hash_of(token),
            "label": label[:200],
            "created_at": at,
            "expires_at": None if days is None else at + 86_400 * days,
        }
        new = insert(access_tokens).values(values).returning(access_tokens)
        row = self._database.write(lambda c: c.execute(new).one())
        return NewToken.model_validate({**row._mapping, "token": token})

    def all(self) -> TokenList:
        """Every token, including those that no longer work."""
        with self._database.read() as connection:
            rows = connection.execute(select(access_tokens).order_by(access_tokens.c.created_at))
            summaries = [TokenSummary.model_validate(row, from_attributes=True) for row in rows]
        return TokenList(tokens=summaries)

    def revoke(self, token: str) -> None:
        """Close a token, by its id.

        Raises
        ------
        InputError
            If there is none that is open.
        """
        change = (
            update(access_tokens)
            .where(access_tokens.c.id == token, access_tokens.c.revoked_at.is_(None))
            .values(revoked_at=now())
        )
        if not self._database.write(lambda c: c.execute(change).rowcount):
            raise InputError(
                "id", f"there is no active token {token}.", "See `knitcore token list`."
            )

    def find(self, *, hashed: str | None = None, identifier: str | None = None) -> tuple[str, str]:
        """(id, user) of an open token by its hash or id; empty strings if there is none."""
        which = (
            access_tokens.c.token_hash == hashed
            if hashed is not None
            else access_tokens.c.id == identifier
        )
        with self._database.read() as connection:
            row = connection.execute(select(access_tokens).where(which, self._open)).one_or_none()
        return ("", "") if row is None else (row.id, row.user)

    def without_any(self, users: set[str]) -> set[str]:
        """Return those of these users who no longer have an open token."""
        open_ = select(access_tokens.c.user).where(access_tokens.c.user.in_(users), self._open)
        with self._database.read() as connection:
            return users - {LOCAL_USER} - set(connection.execute(open_).scalars())

    @property
    def _open(self) -> ColumnElement[bool]:
        """The tokens that are neither revoked nor expired, by the clock of the database."""
        expires = access_tokens.c.expires_at
        is_fresh = or_(expires.is_(None), expires > self._database.clock)
        return and_(access_tokens.c.revoked_at.is_(None), is_fresh)

    def session_key(self) -> str:
        """The key that signs sessions, made when it is first needed."""

        def action(connection: Connection) -> str:
            query = select(service_keys.c.value).where(service_keys.c.name == "session")
            if connection.execute(query).scalar_one_or_none() is None:
                new = self._database.backend.insert_new(service_keys)
                connection.execute(new.values(name="session", value=secrets.token_urlsafe(32)))
            return str(connection.execute(query).scalar_one())

        return self._database.write(action)


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
        at = self._database.clock
        values = {"id": session, "token": token, "user": user, "created_at": at}
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
            sessions.c.id == session, sessions.c.created_at > self._database.clock - SESSION_S
        )
        with self._database.read() as connection:
            row = connection.execute(query).one_or_none()
        return ("", "") if row is None else (row.token, row.user)

    def of(self, user: str, this: str) -> list[SessionSummary]:
        """All sessions of a user, latest first; ``this`` is the one that asks."""
        query = (
            select(sessions)
            .where(
                sessions.c.user == user, sessions.c.created_at > self._database.clock - SESSION_S
            )
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
        old = delete(sessions).where(sessions.c.created_at < self._database.clock - SESSION_S)
        self._database.write(lambda c: c.execute(old))


class NotRememberedError(LookupError):
    """Error: only the database knows; ``user`` is whom it named last, empty if it named nobody."""

    def __init__(self, user: str) -> None:
        super().__init__(user)
        self.user = user


class Login:
    """Finds the user behind a token or a session, and remembers it for a moment.

    With ``at_once`` its methods do not read the database: they raise a
    :class:`NotRememberedError` where they would have to.

    Parameters
    ----------
    tokens, sessions : of users.
    environment : the token of the settings, if there is one; it stands for the local user.
    """

    def __init__(self, tokens: Tokens, sessions: Sessions, environment: str | None) -> None:
        self._tokens = tokens
        self._sessions = sessions
        self._environment = None if environment is None else hash_of(environment)
        self._signer = URLSafeTimedSerializer(tokens.session_key(), salt="knitcore session")
        self._ended: set[str] = set()
        self._remembered: dict[tuple[str, str], tuple[float, tuple[str, str]]] = {}

    def by_token(self, token: str, *, at_once: bool = False) -> tuple[str, str]:
        """(id, user) of a token; empty strings if it is unknown."""
        hashed = hash_of(token)
        if self._environment is not None and hmac.compare_digest(hashed, self._environment):
            return ENVIRONMENT, LOCAL_USER
        return self._ask("hashed", hashed, at_once)

    def by_session(self, cookie: str, *, at_once: bool = False) -> tuple[str, str]:
        """(session, user) of a cookie; empty strings if this service did not sign it."""
        try:
            session = str(self._signer.loads(cookie))  # how old it is, the database knows
        except (BadSignature, ValueError, TypeError):
            return "", ""
        user = self._ask("session", session, at_once)[1]
        return (session, user) if user else ("", "")

    def begin(self, identifier: str, user: str) -> str:
        """The cookie of a new session, opened with a token of this id."""
        return str(self._signer.dumps(self._sessions.begin(self._opened_with(identifier), user)))

    def end(self, user: str, session: str) -> bool:
        """End a session at once, whatever is remembered; False if the user has none of that id."""
        is_ended = self._sessions.end(user, session)
        if is_ended:
            if len(self._ended) >= MAX_REMEMBERED:
                self._ended.clear()
            self._ended.add(session)
        return is_ended

    def is_open(self, identifier: str, session: str, *, at_once: bool = False) -> bool:
        """Return whether the token or the session that began something still opens the service."""
        if session:
            return bool(self._ask("session", session, at_once)[1])
        return identifier == ENVIRONMENT or bool(self._ask("identifier", identifier, at_once)[1])

    def _opened_with(self, identifier: str) -> str:
        """Return the part of its token that a session stores.

        For the token in the settings it is a part of its hash, so that the session ends when that
        token is changed.
        """
        if identifier != ENVIRONMENT:
            return identifier
        return f"{ENVIRONMENT} {(self._environment or '')[:16]}"

    def _find(self, by: str, value: str) -> tuple[str, str]:
        if by != "session":
            return self._tokens.find(**{by: value})
        token, user = self._sessions.find(value)
        if token.startswith(ENVIRONMENT):
            same = self._environment is not None and token == self._opened_with(ENVIRONMENT)
            return (token, user) if same else ("", "")
        return self._tokens.find(identifier=token) if token else ("", "")

    def _ask(self, by: str, value: str, at_once: bool) -> tuple[str, str]:
        if value in self._ended:
            return "", ""
        at = time.monotonic()
        known = self._remembered.get((by, value))
        if known is not None and at - known[0] < REMEMBERED_S:
            return known[1]
        if at_once:
            raise NotRememberedError(known[1][1] if known is not None else "")
        login = self._find(by, value)
        if not login[1]:  # a stranger's tries would drive out what users are known by
            self._remembered.pop((by, value), None)
            return login
        if len(self._remembered) >= MAX_REMEMBERED:
            self._remembered.clear()
        self._remembered[by, value] = (at, login)
        return login
