"""Long lists, page by page."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from sqlalchemy import Column, Row, Select, tuple_

from knitcore.base.errors import InputError

from .database import Database


def one_page(
    database: Database,
    chosen: Select[Any],
    at: Column[float],
    identifier: Column[str],
    *,
    limit: int,
    cursor: str | None,
) -> tuple[Sequence[Row[Any]], str | None]:
    """Rows, the latest first, and the cursor of the page after them; None at the end.

    Parameters
    ----------
    chosen : all rows of the list.
    at, identifier : the columns that order them; of equal times the identifier decides.
    limit : most rows of a page.
    cursor : of the page before; None for the first.

    Raises
    ------
    InputError
        If the cursor is not one.
    """
    if cursor is not None:
        before, _, last = cursor.partition("_")
        try:
            chosen = chosen.where(tuple_(at, identifier) < tuple_(float(before), last))
        except ValueError:
            raise InputError(
                "cursor", "is not a cursor of this service.", "Send next_cursor of the page before."
            ) from None
    with database.read() as connection:
        ordered = chosen.order_by(at.desc(), identifier.desc()).limit(limit + 1)
        rows = connection.execute(ordered).all()
    if len(rows) <= limit:
        return rows, None
    last_row = rows[limit - 1]._mapping
    return rows[:limit], f"{last_row[at.name]!r}_{last_row[identifier.name]}"
