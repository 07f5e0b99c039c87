"""Designs in the database. Every method is one transaction; users see their own designs only."""

import secrets
from collections.abc import Callable
from functools import cache
from typing import Any

from sqlalchemy import (
    ColumnElement,
    Connection,
    Row,
    Select,
    Table,
    bindparam,
    func,
    insert,
    select,
    update,
)

from knitcore.chart.stitch_chart import StitchChart
from knitcore.formats.designs.layout import DesignLayout, check_layout

from ..limits.user_limits import USER_LIMITS, OverLimitError
from ..problems import NotFoundError
from ..store.database import Database
from ..store.tables import design_versions, designs, now
from .conditions import ConflictError, Retry, check_match, once
from .document import (
    Design,
    DesignDocument,
    DesignPage,
    DesignPatch,
    DesignSummary,
    Painted,
    Strokes,
    Version,
    Versions,
    VersionSummary,
)
from .painting import clear_painted, kinds_around, paint

DELETED_KEPT_S = 30 * 86_400.0
"""Time for which a deleted design can be recovered."""

_SUMMARY = [designs.c[name] for name in DesignSummary.model_fields]
_VERSION_SUMMARY = [design_versions.c[name] for name in VersionSummary.model_fields]
_CHANGE = update(designs).where(designs.c.id == bindparam("design"))


class DesignStore:
    """The designs of all owners.

    Parameters
    ----------
    database : where they are.
    changed : called with owner, design and revision after a change.
    """

    def __init__(
        self, database: Database, changed: Callable[[str, str, int], None] | None = None
    ) -> None:
        self._database = database
        self._tell = changed or (lambda *_: None)

    def create(self, owner: str, document: DesignDocument, retry: Retry | None = None) -> Design:
        """Keep a new design."""
        content = _content(document)
        return once(self._database, retry, Design, lambda c: add(c, owner, content))

    def duplicate(self, owner: str, design: str, retry: Retry | None = None) -> Design:
        """Keep a copy of the caller's design."""

        def action(connection: Connection) -> Design:
            return add(connection, owner, copied(find_design(connection, owner, design)))

        return once(self._database, retry, Design, action)

    def get(self, owner: str, design: str) -> Design:
        """A design that is not deleted."""
        with self._database.read() as connection:
            return _design_of(find_design(connection, owner, design))

    def page(
        self, owner: str, *, limit: int, cursor: str | None, deleted: bool, part: str = ""
    ) -> DesignPage:
        """Designs of an owner whose names contain a part, the latest changes first."""
        chosen = select(*_SUMMARY).where(
            designs.c.owner == owner,
            designs.c.deleted_at.is_not(None) if deleted else designs.c.deleted_at.is_(None),
        )
        if part:
            chosen = chosen.where(designs.c.name.icontains(part, autoescape=True))
        rows, following = self._database.page(
            chosen, designs.c.changed_at, designs.c.id, limit=limit, cursor=cursor
        )
        summaries = [DesignSummary.model_validate(row, from_attributes=True) for row in rows]
        return DesignPage(designs=summaries, next_cursor=following)

    def replace(
        self, owner: str, design: str, document: DesignDocument, if_match: str | None
    ) -> Design:
        """Put a whole document in the place of the present one."""
        content = _content(document)
        return self._change(owner, design, if_match, lambda *_: content)

    def patch(self, owner: str, design: str, patch: DesignPatch, if_match: str | None) -> Design:
        """Change some fields."""
        values = patch.model_dump(exclude_none=True)
        return self._change(owner, design, if_match, lambda *_: values)

    async def paint(self, owner: str, design: str, strokes: Strokes) -> Painted:
        """Merge strokes into the present chart, also if others have painted since.

        Asynchronous, because strokes are more frequent than all other changes.

        Raises
        ------
        ConflictError
            If the chart has another size by now.
        """

        def action(connection: Connection) -> Painted:
            row = find_design(connection, owner, design, change=True)
            if (row.rows, row.columns) != (strokes.rows, strokes.columns):
                raise ConflictError(
                    f"The chart has {row.columns}x{row.rows} stitches now; these strokes were "
                    f"painted on {strokes.columns}x{strokes.rows}.",
                    field="rows",
                    remedy="Read the design again and paint on that.",
                )
            values = {
                "chart": paint(row.chart, row.rows, row.columns, strokes.runs),
                "layout": clear_painted(row.layout, strokes.runs),
                "revision": row.revision + 1,
                "changed_at": now(),
            }
            connection.execute(_CHANGE, values | {"design": row.id})
            kinds = kinds_around(values["chart"], row.rows, row.columns, strokes.runs)
            return Painted.model_validate(values | {"map": kinds})

        painted = await self._database.written(action)
        self._tell(owner, design, painted.revision)
        return painted

    def delete(self, owner: str, design: str, if_match: str | None) -> None:
        """Put a design aside; it can be recovered for 30 days."""

        def action(connection: Connection) -> None:
            row = find_design(connection, owner, design, change=True)
            if if_match is not None:
                check_match(if_match, row.revision)
            put_aside = {"deleted_at": self._database.clock}
            connection.execute(update(designs).where(designs.c.id == design).values(put_aside))

        self._database.write(action)

    def recover(self, owner: str, design: str) -> Design:
        """Bring a deleted design back."""
        return self._change(owner, design, "*", lambda *_: {"deleted_at": None}, deleted=True)

    def keep_version(
        self, owner: str, design: str, name: str, retry: Retry | None = None
    ) -> VersionSummary:
        """Keep the present state under a name."""

        def action(connection: Connection) -> VersionSummary:
            row = find_design(connection, owner, design, change=True)
            return _keep(connection, row, name, automatic=False)

        return once(self._database, retry, VersionSummary, action)

    def versions(self, owner: str, design: str) -> Versions:
        """The kept states, oldest first."""
        with self._database.read() as connection:
            find_design(connection, owner, design)
            rows = connection.execute(
                select(*_VERSION_SUMMARY)
                .where(design_versions.c.design_id == design)
                .order_by(design_versions.c.number)
            )
            summaries = [VersionSummary.model_validate(row, from_attributes=True) for row in rows]
        return Versions(versions=summaries)

    def version(self, owner: str, design: str, number: int) -> Version:
        """A kept state."""
        with self._database.read() as connection:
            find_design(connection, owner, design)
            row = _version(connection, design, number)
        document = document_of(row, row.design_name)
        return Version.model_validate({**row._mapping, "document": document})

    def restore(self, owner: str, design: str, number: int, if_match: str | None) -> Design:
        """Restore a version; the present state is saved as a version first."""

        def earlier(connection: Connection, row: Row[Any]) -> dict[str, Any]:
            kept = _version(connection, design, number)
            _keep(connection, row, f"Before “{kept.name}” was restored"[:200], automatic=True)
            chart = StitchChart.parse(kept.chart)
            content = {n: getattr(kept, n) for n in ("material", "chart", "note", "layout")}
            size = {"rows": chart.rows, "columns": chart.columns}
            return {"name": kept.design_name, **content, **size}

        return self._change(owner, design, if_match, earlier)

    def kept(self, owner: str) -> tuple[int, int]:
        """Number of an owner's designs, deleted ones included, and their bytes with versions."""
        with self._database.read() as connection:
            return _count(connection, owner), _kept_bytes(connection, owner)

    def most_versions(self, owner: str) -> int:
        """The largest number of versions that any one design of an owner has."""
        return most_of_one(self._database, owner, design_versions)

    def forget_deleted(self) -> int:
        """Remove designs that were deleted 30 days ago for good; returns their number."""
        gone = designs.delete().where(designs.c.deleted_at < self._database.clock - DELETED_KEPT_S)
        return self._database.write(lambda connection: connection.execute(gone).rowcount)

    def _change(
        self,
        owner: str,
        design: str,
        if_match: str | None,
        values: Callable[[Connection, Row[Any]], dict[str, Any]],
        *,
        deleted: bool = False,
    ) -> Design:
        """Change a design that is in the state of If-Match, and tell those who follow it."""

        def action(connection: Connection) -> Design:
            row = find_design(connection, owner, design, change=True, deleted=deleted)
            check_match(if_match, row.revision)
            changes = values(connection, row)
            if not changes.keys().isdisjoint(_SIZED):
                changes = _sized(connection, owner, changes, row)
            stamped = changes | {"revision": row.revision + 1, "changed_at": now()}
            connection.execute(_CHANGE, stamped | {"design": design})
            return _stored(connection, design)

        changed = self._database.write(action)
        self._tell(owner, design, changed.revision)
        return changed


@cache
def _finding(change: bool, deleted: bool) -> Select[Any]:
    chosen = select(designs).where(
        designs.c.id == bindparam("design"),
        designs.c.owner == bindparam("owner"),
        designs.c.deleted_at.is_not(None) if deleted else designs.c.deleted_at.is_(None),
    )
    return chosen.with_for_update() if change else chosen


def find_design(
    connection: Connection, owner: str, design: str, *, change: bool = False, deleted: bool = False
) -> Row[Any]:
    """An owner's design; with ``change`` it is locked until the transaction ends.

    Raises
    ------
    NotFoundError
        If there is none, it is deleted (or, with ``deleted``, is not), or belongs to someone
        else. The error does not say which.
    """
    keys = {"design": design, "owner": owner}
    row = connection.execute(_finding(change, deleted), keys).one_or_none()
    if row is None:
        raise NotFoundError(
            f"There is no {'deleted ' if deleted else ''}design {design} of yours.",
            field="design",
            remedy="Look it up in the list of your designs.",
        )
    return row


def add(connection: Connection, owner: str, content: dict[str, Any]) -> Design:
    """Insert a design.

    Raises
    ------
    OverLimitError
        If the owner has as many as the service stores.
    """
    if _count(connection, owner) >= USER_LIMITS.designs:
        raise OverLimitError(
            f"You have {USER_LIMITS.designs} designs, including deleted ones: the most allowed.",
            field="designs",
            remedy="Export and delete some; deleted designs are removed permanently after 30 days.",
        )
    content = _sized(connection, owner, content)
    at = now()
    values = content | {
        "id": secrets.token_urlsafe(16),
        "owner": owner,
        "revision": 1,
        "created_at": at,
        "changed_at": at,
    }
    connection.execute(insert(designs).values(values))
    return _stored(connection, values["id"])


def _count(connection: Connection, owner: str) -> int:
    """Number of an owner's designs, deleted ones included."""
    count = select(func.count()).select_from(designs).where(designs.c.owner == owner)
    return int(connection.execute(count).scalar_one())


def most_of_one(
    database: Database, owner: str, parts: Table, *conditions: ColumnElement[bool]
) -> int:
    """The largest number of such rows that any one design of an owner has."""
    each = (
        select(func.count())
        .select_from(parts.join(designs))
        .where(designs.c.owner == owner, *conditions)
        .group_by(parts.c.design_id)
        .order_by(func.count().desc())
        .limit(1)
    )
    with database.read() as connection:
        return connection.execute(each).scalar() or 0


def copied(row: Row[Any]) -> dict[str, Any]:
    """The content of a design for a copy of it."""
    kept = ("material", "chart", "note", "layout", "rows", "columns")
    return {n: getattr(row, n) for n in kept} | {"name": f"{row.name[:190]} (copy)"}


def _stored(connection: Connection, design: str) -> Design:
    return _design_of(connection.execute(select(designs).where(designs.c.id == design)).one())


def _design_of(row: Row[Any]) -> Design:
    """A row as clients get it."""
    return Design.model_validate({**row._mapping, "document": document_of(row)})


def document_of(row: Row[Any], name: str | None = None) -> DesignDocument:
    """The document in a row, by default with the row's name."""
    layout = DesignLayout.model_validate_json(row.layout)
    return DesignDocument.model_construct(
        name=row.name if name is None else name,
        material=row.material,
        chart=row.chart,
        note=row.note,
        **dict(layout),
    )


def _content(document: DesignDocument) -> dict[str, Any]:
    chart = StitchChart.parse(document.chart)
    check_layout(chart, document)
    return {
        "name": document.name,
        "material": document.material,
        "chart": chart.text,
        "note": document.note,
        "layout": document.model_dump_json(include=set(DesignLayout.model_fields)),
        "rows": chart.rows,
        "columns": chart.columns,
    }


_SIZED = ("chart", "note", "layout")


def _sized(
    connection: Connection, owner: str, values: dict[str, Any], row: Row[Any] | None = None
) -> dict[str, Any]:
    """A design's values with their size, if there is room for what is more than before."""
    whole = values if row is None else dict(row._mapping) | values
    size = sum(len(whole.get(name, "").encode()) for name in _SIZED)
    before = 0 if row is None else row.size_bytes
    if size > before:
        _check_room(connection, owner, size - before)
    return values | {"size_bytes": size}


def _check_room(connection: Connection, owner: str, more: int) -> None:
    """Refuse what an owner has no room for."""
    total = _kept_bytes(connection, owner)
    if total + more > USER_LIMITS.kept_bytes:
        raise OverLimitError(
            f"Your designs and their versions have {total / 1e6:.1f} of "
            f"{USER_LIMITS.kept_bytes / 1e6:.0f} MB; this would be {more / 1e6:.1f} MB more.",
            field="kept_bytes",
            remedy="Export and delete some; deleted designs are removed permanently after 30 days.",
        )


def _kept_bytes(connection: Connection, owner: str) -> int:
    """Size of an owner's designs and their versions."""
    kept = select(func.coalesce(func.sum(designs.c.size_bytes), 0)).where(designs.c.owner == owner)
    versions = (
        select(func.coalesce(func.sum(design_versions.c.size_bytes), 0))
        .join(designs, designs.c.id == design_versions.c.design_id)
        .where(designs.c.owner == owner)
    )
    return sum(int(connection.execute(query).scalar_one()) for query in (kept, versions))


def _keep(connection: Connection, row: Row[Any], name: str, *, automatic: bool) -> VersionSummary:
    mine = design_versions.c.design_id == row.id
    last = connection.execute(select(func.max(design_versions.c.number)).where(mine)).scalar()
    number = (last or 0) + 1
    if number > USER_LIMITS.versions:
        raise OverLimitError(
            f"This design has {USER_LIMITS.versions} versions, the most allowed.",
            field="versions",
            remedy="Duplicate the design and continue with the copy.",
        )
    kept = {column.name for column in design_versions.c} & row._mapping.keys()
    values = {n: row._mapping[n] for n in kept} | {
        "design_id": row.id,
        "number": number,
        "name": name,
        "automatic": automatic,
        "design_name": row.name,
        "created_at": now(),
    }
    _check_room(connection, row.owner, row.size_bytes)
    connection.execute(insert(design_versions).values(values))
    return VersionSummary.model_validate(values)


def _version(connection: Connection, design: str, number: int) -> Row[Any]:
    row = connection.execute(
        select(design_versions).where(
            design_versions.c.design_id == design, design_versions.c.number == number
        )
    ).one_or_none()
    if row is None:
        raise NotFoundError(
            f"The design has no version {number}.",
            field="number",
            remedy="Look it up in the list of its versions.",
        )
    return row
