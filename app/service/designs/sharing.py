"""Links to designs for people who do not own them. A link is a secret; only its hash is kept."""

import secrets

from sqlalchemy import Connection, Row, func, insert, select, update

from ..limits.user_limits import USER_LIMITS, OverLimitError
from ..problems import NotFoundError, RefusedError
from ..store.database import Database
from ..store.tables import designs, hash_of, now, shares
from .conditions import Retry, once
from .document import Design, NewShare, Share, SharedDesign, ShareMode, Shares
from .store import add, copied, document_of, find_design, most_of_one

_OPEN = shares.c.revoked_at.is_(None)


class NotAllowedError(RefusedError):
    """The link allows less than was asked."""

    title = "This link does not allow that"


class Sharing:
    """Share links of all designs."""

    def __init__(self, database: Database) -> None:
        self._database = database

    def give(self, owner: str, design: str, mode: ShareMode) -> NewShare:
        """Make a link; its token is returned this once only."""
        token = secrets.token_urlsafe(32)
        given = {"id": secrets.token_urlsafe(12), "mode": mode.value, "created_at": now()}

        def action(connection: Connection) -> None:
            find_design(connection, owner, design, change=True)
            open_ = select(func.count()).where(shares.c.design_id == design, _OPEN)
            if connection.execute(open_).scalar_one() >= USER_LIMITS.links:
                raise OverLimitError(
                    f"The design has {USER_LIMITS.links} open links, the most allowed.",
                    field="links",
                    remedy="Take some back.",
                )
            kept = {"design_id": design, "token_hash": hash_of(token)}
            connection.execute(insert(shares).values(given | kept))

        self._database.write(action)
        return NewShare.model_validate(given | {"token": token})

    def given(self, owner: str, design: str) -> Shares:
        """The links of a design that still open it."""
        with self._database.read() as connection:
            find_design(connection, owner, design)
            rows = connection.execute(
                select(shares.c.id, shares.c.mode, shares.c.created_at)
                .where(shares.c.design_id == design, _OPEN)
                .order_by(shares.c.created_at, shares.c.id)
            ).all()
        return Shares(shares=[Share.model_validate(row, from_attributes=True) for row in rows])

    def most_given(self, owner: str) -> int:
        """The largest number of open links to any one design of an owner."""
        return most_of_one(self._database, owner, shares, _OPEN)

    def revoke(self, owner: str, design: str, share: str) -> None:
        """Close a link for good."""

        def action(connection: Connection) -> None:
            find_design(connection, owner, design)
            closed = connection.execute(
                update(shares)
                .where(shares.c.id == share, shares.c.design_id == design, _OPEN)
                .values(revoked_at=now())
            )
            if closed.rowcount == 0:
                raise NotFoundError(f"The design has no open link {share}.", field="share")

        self._database.write(action)

    def open(self, token: str) -> SharedDesign:
        """The design behind a link, in its present state."""
        with self._database.read() as connection:
            row = _shared(connection, token)
        return SharedDesign.model_validate({**row._mapping, "document": document_of(row)})

    def copy(self, owner: str, token: str, retry: Retry | None = None) -> Design:
        """A copy of the design behind a link, for the caller.

        Raises
        ------
        NotAllowedError
            If the link is for reading only.
        """

        def action(connection: Connection) -> Design:
            row = _shared(connection, token)
            if row.mode != ShareMode.COPY:
                raise NotAllowedError(
                    "This link is for reading only.", remedy="Ask its owner for a link to copy."
                )
            return add(connection, owner, copied(row))

        return once(self._database, retry, Design, action)


def _shared(connection: Connection, token: str) -> Row[tuple[object, ...]]:
    row = connection.execute(
        select(designs, shares.c.mode)
        .join(shares, shares.c.design_id == designs.c.id)
        .where(shares.c.token_hash == hash_of(token), _OPEN, designs.c.deleted_at.is_(None))
    ).one_or_none()
    if row is None:
        raise NotFoundError(
            "This link does not work: it was revoked, or the design is deleted.",
            field="token",
            remedy="Ask for a new link.",
        )
    return row
