"""Reading and writing; a write is durable before it is acknowledged."""

from __future__ import annotations

import asyncio
import contextlib
import logging
import os
import queue
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future
from pathlib import Path
from typing import Any, TypeVar

from fastapi.concurrency import run_in_threadpool
from sqlalchemy import (
    ColumnElement,
    Connection,
    Engine,
    Float,
    Insert,
    Table,
    create_engine,
    event,
    literal_column,
    make_url,
    text,
)
from sqlalchemy.dialects.postgresql import insert as postgresql_insert
from sqlalchemy.dialects.sqlite import insert as sqlite_insert
from sqlalchemy.exc import DatabaseError, InterfaceError, OperationalError
from sqlalchemy.exc import TimeoutError as PoolTimeoutError
from sqlalchemy.pool import QueuePool

from ..problems import DamagedError, StoreError, StoreFullError
from .file import DatabaseFile
from .name_lock import NameLock

log = logging.getLogger("knitcore.store")
T = TypeVar("T")
Action = Callable[[Connection], Any]

FAILURES = (OperationalError, InterfaceError, PoolTimeoutError)
"""Failures of the database itself; other errors come from a statement or from this program."""
FULL = ("disk is full", "No space left on device")
DAMAGED = ("malformed", "file is not a database")
BUSY_TIMEOUT_MS = 10_000
MAX_BATCH = 64
SQLITE_CLOCK = "(julianday('now') - 2440587.5) * 86400.0"
POSTGRESQL_CLOCK = "CAST(EXTRACT(EPOCH FROM clock_timestamp()) AS double precision)"
UNREACHABLE = "The designs cannot be reached or written now ({reason}); nothing was changed."


class Database:
    """A database with one way to read and one to write.

    Notes
    -----
    SQLite allows one writer at a time and flushes the disk at every commit. One thread writes:
    changes that arrive while it flushes share the next commit, each behind its own savepoint. A
    change is acknowledged after the commit that holds it. PostgreSQL needs none of this.

    Parameters
    ----------
    url : SQLAlchemy URL, ``sqlite:///…`` or ``postgresql+psycopg://…``.

    Raises
    ------
    InputError
        If an SQLite file can be neither opened nor made, or cannot be used now.
    """

    def __init__(self, url: str) -> None:
        path = sqlite_file(url)
        self.is_sqlite = path is not None
        self.file = None if path is None else DatabaseFile(path)
        self.engine = _server_engine(url) if self.file is None else _sqlite_engine(self.file)
        self.name_lock: NameLock | None = None
        self._damaged = False
        self._waiting: queue.SimpleQueue[tuple[Action, Future[Any]] | None] = queue.SimpleQueue()
        self._writer: threading.Thread | None = None
        if self.is_sqlite:
            self._writer = threading.Thread(target=self._write_all, name="store", daemon=True)
            self._writer.start()

    def insert_new(self, table: Table) -> Insert:
        """An insertion that leaves existing rows unchanged."""
        kind = sqlite_insert if self.is_sqlite else postgresql_insert
        return kind(table).on_conflict_do_nothing()

    @property
    def clock(self) -> ColumnElement[float]:
        """Seconds since 1970 by the clock of the database, which all its processes share."""
        now = SQLITE_CLOCK if self.is_sqlite else POSTGRESQL_CLOCK
        return literal_column(now, Float)

    def check(self) -> None:
        """Check that the database answers, is still this process's, and was not found damaged.

        Raises
        ------
        StoreError
        """
        if self._damaged:
            raise _damaged()
        if self.name_lock is not None:
            with self.failures():
                self.name_lock.keep()
        with self.read() as connection:
            connection.execute(text("SELECT 1 FROM alembic_version"))

    def check_pages(self) -> None:
        """Look through an SQLite file for damage, about a second for a gigabyte.

        Raises
        ------
        StoreError
        """
        if self.is_sqlite:
            with self.read() as connection:
                if connection.exec_driver_sql("PRAGMA quick_check(1)").scalar() != "ok":
                    raise _damaged()

    def copy_to(self, file: Path) -> None:
        """Copy an SQLite database as it is now to a new file, readable by this user only.

        Raises
        ------
        StoreError
        """
        with self.failures(), contextlib.closing(self.engine.raw_connection()) as connection:
            os.close(os.open(file, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600))
            connection.cursor().execute("VACUUM INTO ?", (str(file),))

    @contextlib.contextmanager
    def read(self) -> Iterator[Connection]:
        """A connection that sees one state of the database.

        Raises
        ------
        StoreError
            If the database cannot be reached.
        """
        with self.failures(), self.engine.connect() as connection:
            yield connection

    @contextlib.contextmanager
    def snapshot(self) -> Iterator[Connection]:
        """A connection whose later reads see the same state as its first."""
        with self.read() as connection:
            if not self.is_sqlite:  # where every transaction is one already
                connection.execution_options(isolation_level="REPEATABLE READ")
            yield connection

    def write(self, action: Callable[[Connection], T]) -> T:
        """Run ``action`` in a transaction and return what it returns, once the change is on disk.

        Raises
        ------
        StoreError
            If it could not be made durable; then nothing of it is kept.
        """
        if self._writer is None:
            if self.name_lock is not None:
                self.name_lock.check()
            with self.failures(), self.engine.begin() as connection:
                return action(connection)
        with self.failures():
            return self._hand_in(action).result()

    async def written(self, action: Callable[[Connection], T]) -> T:
        """The same for the event loop, without a thread that waits for the disk.

        Raises
        ------
        StoreError
            As in :meth:`write`.
        """
        if self._writer is None:
            return await run_in_threadpool(self.write, action)
        with self.failures():
            return await asyncio.wrap_future(self._hand_in(action))

    def close(self) -> None:
        """Write pending changes, then close all connections; doing so again has no effect."""
        if self._writer is not None:
            self._waiting.put(None)
            self._writer.join()
            self._writer = None
        self.engine.dispose()
        if self.file is not None:
            self.file.close()

    @contextlib.contextmanager
    def failures(self) -> Iterator[None]:
        """Turn errors of the database itself into a StoreError."""
        try:
            yield
        except DatabaseError as error:
            reason = str(error).splitlines()[0]
            if any(words in reason for words in DAMAGED):
                self._damaged = True
                log.error("the database is damaged: %s", reason)
                raise _damaged() from error
            if not isinstance(error, FAILURES):
                raise
            raise _failed(reason) from error
        except FAILURES as error:
            raise _failed(str(error).splitlines()[0]) from error

    def _hand_in(self, action: Callable[[Connection], T]) -> Future[T]:
        done: Future[T] = Future()
        self._waiting.put((action, done))
        return done

    def _write_all(self) -> None:
        open_ = True
        while open_:
            batch = []
            entry = self._waiting.get()
            while entry is not None:
                if entry[1].set_running_or_notify_cancel():  # not cancelled meanwhile
                    batch.append(entry)
                if len(batch) == MAX_BATCH:
                    break
                try:
                    entry = self._waiting.get_nowait()
                except queue.Empty:
                    break
            open_ = entry is not None
            if batch:
                self._commit(batch)

    def _commit(self, batch: list[tuple[Action, Future[Any]]]) -> None:
        outcomes: list[tuple[Future[Any], Any, Exception | None]] = []
        attempt = _attempt if len(batch) > 1 else _do
        try:
            with self.engine.connect() as connection:
                connection.execution_options(knitcore_write=True)
                with connection.begin():
                    for action, done in batch:
                        outcomes.append((done, *attempt(connection, action)))
        except Exception as error:
            if len(batch) > 1:
                for entry in batch:  # one by one, so that only the failing change is refused
                    self._commit([entry])
            else:
                batch[0][1].set_exception(error)
            return
        for done, result, refused in outcomes:
            if refused is None:
                done.set_result(result)
            else:
                done.set_exception(refused)


def sqlite_file(url: str) -> Path | None:
    """The file that a URL names; None for a database server."""
    parts = make_url(url)
    return Path(parts.database or "") if parts.get_backend_name() == "sqlite" else None


def _do(connection: Connection, action: Action) -> tuple[Any, Exception | None]:
    """An action alone in its transaction, which an error ends."""
    return action(connection), None


def _attempt(connection: Connection, action: Action) -> tuple[Any, Exception | None]:
    """An action behind a savepoint; errors of the database itself end the whole transaction."""
    savepoint = connection.begin_nested()
    try:
        result = action(connection)
    except Exception as error:
        if isinstance(error, FAILURES):
            raise
        savepoint.rollback()
        return None, error
    savepoint.commit()
    return result, None


def _failed(reason: str) -> StoreError:
    log.error("the database failed: %s", reason)
    kind = StoreFullError if any(words in reason for words in FULL) else StoreError
    return kind(UNREACHABLE.format(reason=_public(reason)))


def _damaged() -> DamagedError:
    return DamagedError("The file of the designs is damaged.")


def _public(reason: str) -> str:
    """A reason without internal addresses and machine names."""
    for known in (*FULL, "disk I/O error", "database is locked", "readonly database"):
        if known in reason:
            return known
    return "the database does not answer"


def _sqlite_engine(file: DatabaseFile) -> Engine:
    engine = create_engine("sqlite://", creator=file.connect, poolclass=QueuePool)

    @event.listens_for(engine, "connect")
    def _(connection: Any, _record: Any) -> None:
        connection.isolation_level = None  # BEGIN is ours, below
        for pragma in (
            "journal_mode=WAL",
            "synchronous=FULL",  # a commit is on disk, not only in the system's memory
            "foreign_keys=ON",
            f"busy_timeout={BUSY_TIMEOUT_MS}",
        ):
            connection.execute(f"PRAGMA {pragma}")

    @event.listens_for(engine, "begin")
    def _(connection: Connection) -> None:
        file.check()
        write = connection.get_execution_options().get("knitcore_write")
        connection.exec_driver_sql("BEGIN IMMEDIATE" if write else "BEGIN")

    return engine


def _server_engine(url: str) -> Engine:
    return create_engine(
        url,
        pool_pre_ping=True,  # a database that went away and came back is found again
        pool_size=10,
        max_overflow=10,
        pool_timeout=5,
        connect_args={"connect_timeout": 3, "tcp_user_timeout": 10_000},  # s, ms
    )
