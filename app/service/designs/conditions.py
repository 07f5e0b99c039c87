"""Conditional requests: every change says which state it was made on. A client may send a request
twice because the answer was lost."""

from __future__ import annotations

import hashlib
from collections.abc import Callable
from dataclasses import asdict, dataclass
from typing import TypeVar

from pydantic import BaseModel
from sqlalchemy import Connection, Delete, insert, select
from sqlalchemy.exc import IntegrityError

from ..problems import ServiceError
from ..store.database import Database
from ..store.tables import idempotency_keys

Reply = TypeVar("Reply", bound=BaseModel)
KEPT_S = 86_400.0
MAX_KEYS = 100
"""Keys of one user that are known, the latest; each holds an answer, such as a large design."""


class StaleError(ServiceError):
    """Someone else changed the design in the meantime."""

    status, type, title = 412, "stale", "The design has changed in the meantime"


class ConflictError(ServiceError):
    """The request conflicts with the current version."""

    status, type, title = 409, "conflict", "This conflicts with the current version"


class UnconditionalError(ServiceError):
    """The request must say which state it was made on."""

    status, type, title = 428, "condition", "Say which state you have changed"


def etag(revision: int) -> str:
    """The ETag of a revision."""
    return f'"{revision}"'


def knows(tags: str, revision: int) -> bool:
    """Return whether the ETags of an If-Match or If-None-Match name this revision, or any.

    A proxy that packs answers makes them weak.
    """
    offered = {tag.strip().removeprefix("W/") for tag in tags.split(",")}
    return "*" in offered or etag(revision) in offered


def check_match(if_match: str | None, revision: int) -> None:
    """Let a change through that was made on the present revision.

    Raises
    ------
    UnconditionalError
        Without If-Match.
    StaleError
        If it names another revision.
    """
    if if_match is None:
        raise UnconditionalError(
            "A change must say which state it was made on.",
            field="If-Match",
            remedy='Send the ETag of the design you have changed as If-Match, or "*" to overwrite.',
        )
    if not knows(if_match, revision):
        raise StaleError(
            f"The design is at revision {revision} now; your change was made on another one, and "
            "nothing was overwritten.",
            field="If-Match",
            remedy="Read the design again, apply your change to it, and send the result.",
        )


class ReusedKeyError(ServiceError):
    """One key for two different requests."""

    status, type, title = 422, "input", "This idempotency key was used before"


@dataclass(frozen=True)
class Retry:
    """An Idempotency-Key and the request that it stands for.

    Attributes
    ----------
    owner : who asks.
    key : as sent by the client.
    fingerprint : of method, path and body.
    """

    owner: str
    key: str
    fingerprint: str

    @classmethod
    def of(cls, owner: str, key: str, *request: str) -> Retry:
        """A key with the fingerprint of its request."""
        digest = hashlib.sha256("\0".join(request).encode()).hexdigest()
        return cls(owner, key, digest)


def once(
    database: Database,
    retry: Retry | None,
    kind: type[Reply],
    action: Callable[[Connection], Reply],
) -> Reply:
    """Run an action in a transaction; where the request has a key, once for that key.

    Raises
    ------
    ReusedKeyError
        If the key came with another request before.
    """
    if retry is None:
        return database.write(action)

    def guarded(connection: Connection) -> Reply:
        known = connection.execute(
            select(idempotency_keys.c.fingerprint, idempotency_keys.c.answer).where(
                idempotency_keys.c.owner == retry.owner, idempotency_keys.c.key == retry.key
            )
        ).one_or_none()
        if known is not None:
            if known.fingerprint != retry.fingerprint:
                raise ReusedKeyError(
                    "This key came with another request before.",
                    field="Idempotency-Key",
                    remedy="Use a new key for every new request.",
                )
            return kind.model_validate_json(known.answer)
        answer = action(connection)
        values = {"answer": answer.model_dump_json(), "created_at": database.clock}
        connection.execute(insert(idempotency_keys).values(asdict(retry) | values))
        connection.execute(_all_but_latest(retry))
        return answer

    try:
        return database.write(guarded)
    except IntegrityError:
        return database.write(guarded)  # its twin was faster: now its answer is there


def _all_but_latest(retry: Retry) -> Delete:
    """Delete what a user's keys hold beyond the latest ones."""
    keys = idempotency_keys.c
    latest = (
        select(keys.key)
        .where(keys.owner == retry.owner, keys.key != retry.key)
        .order_by(keys.created_at.desc())
        .limit(MAX_KEYS - 1)
    )
    mine = (keys.owner == retry.owner) & (keys.key != retry.key)
    return idempotency_keys.delete().where(mine, keys.key.not_in(latest))


def forget_old_keys(database: Database) -> None:
    """Drop keys after a day."""
    old = idempotency_keys.c.created_at < database.clock - KEPT_S
    database.write(lambda connection: connection.execute(idempotency_keys.delete().where(old)))
