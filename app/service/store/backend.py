"""All that differs between SQLite and PostgreSQL; no other code asks which one it is."""

import contextlib
from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping
from types import MappingProxyType
from typing import Any

from sqlalchemy import Column, ColumnElement, Connection, Engine, Insert, Table, func, select


class Backend(ABC):
    """A database that a URL names.

    Attributes
    ----------
    one_writer : whether changes wait for one thread, which writes them together.
    clock : seconds since 1970, in SQL.
    snapshot : options of a connection whose reads all see the same state.
    insert : makes an insertion in its dialect.
    engine : once it is open.
    """

    one_writer: bool
    clock: str
    snapshot: Mapping[str, Any] = MappingProxyType({})
    insert: Callable[[Table], Any]
    engine: Engine

    @abstractmethod
    def open(self) -> None:
        """Make the engine.

        Raises
        ------
        InputError
            If an SQLite file can be neither opened nor made, or cannot be used now.
        """

    def insert_new(self, table: Table) -> Insert:
        """An insertion that leaves existing rows unchanged."""
        new: Insert = self.insert(table).on_conflict_do_nothing()
        return new

    @abstractmethod
    def reserved(self, process: str, at: str) -> contextlib.AbstractContextManager[None]:
        """Reserve the data for a process, which is reached at an address.

        Raises
        ------
        InputError
            If another process has them.
        """

    @abstractmethod
    def holder(self, process: str) -> str | None:
        """Name the service that has the data now; they need not be open here."""

    def check_unopened(self) -> bool:
        """Refuse a database that should not be opened; False if there is none yet.

        Raises
        ------
        InputError
        """
        return True

    def check(self) -> None:  # noqa: B027 - nothing, where a process reserved nothing
        """Refuse to go on with a database that is no longer this process's.

        Raises
        ------
        StoreError, SQLAlchemyError
        """

    def take_turns(self, connection: Connection, name: str) -> None:  # noqa: B027 - one writer
        """Let other transactions of this name wait until this one ends."""

    def check_writable(self) -> None:  # noqa: B027
        """Refuse to change a database that is not this process's any more; asks no server."""

    def part_of(
        self,
        connection: Connection,
        column: Column[bytes],
        row: ColumnElement[bool],
        start: int,
        size: int,
    ) -> bytes | None:
        """Bytes of a large value, without the rest of it; None if its row is gone."""
        part = func.substr(column, start + 1, size)
        content: bytes | None = connection.execute(select(part).where(row)).scalar()
        return content

    def is_whole(self, connection: Connection) -> bool:
        """Return whether no page is damaged."""
        del connection
        return True

    def keep_copy(self, name: str) -> None:  # noqa: B027 - who runs a server makes its copies
        """Keep a copy of the present state under a name, unless there is one."""

    def close(self) -> None:
        """Close all connections; doing so again has no effect."""
        self.engine.dispose()
