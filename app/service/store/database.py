"""Reading and writing; a write is durable before it is acknowledged."""

import asyncio
import contextlib
import logging
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import Future
from itertools import chain
from pathlib import Path
from typing import Any, TypeVar

from sqlalchemy import (
    Column,
    ColumnElement,
    Connection,
    Float,
    Row,
    Select,
    literal_column,
    make_url,
    text,
    tuple_,
)
from sqlalchemy.exc import DBAPIError, InterfaceError, OperationalError
from sqlalchemy.exc import TimeoutError as PoolTimeoutError

from knitcore.base.errors import InputError

from ..identity import current_user
from ..limits.turns import Turns
from ..problems import DamagedError, StoreError, StoreFullError
from .backend import Backend
from .sqlite import SqliteFile

log = logging.getLogger("knitcore.store")
T = TypeVar("T")
Action = Callable[[Connection], Any]
Change = tuple[Action, Future[Any]]

FAILURES = (OperationalError, InterfaceError, PoolTimeoutError)
"""Failures of the database itself; other errors come from a statement or from this program."""
FULL = ("disk is full", "No space left on device")
DAMAGED = ("malformed", "file is not a database")
MAX_BATCH = 64
BATCH_S = 0.02
"""Time after which no other change shares a commit."""
UNREACHABLE = "The designs cannot be reached or written now ({reason}); {outcome}."
UNCHANGED = "nothing was changed"
UNKNOWN = "the change may not have been made"


class Database:
    """A database with one way to read and one to write.

    Notes
    -----
    SQLite allows one writer at a time and flushes the disk at every commit. One thread writes:
    changes that arrive while it flushes share the next commit, each behind its own savepoint, and
    users take turns. A change is acknowledged after the commit that holds it. PostgreSQL needs none
    of this.

    Parameters
    ----------
    url : SQLAlchemy URL, ``sqlite:///…`` or ``postgresql+psycopg://…``.

    Raises
    ------
    InputError
        If an SQLite file can be neither opened nor made, or cannot be used now.
    """

    def __init__(self, url: str) -> None:
        self.backend = backend_of(url)
        self.backend.open()
        self.engine = self.backend.engine
        self._is_damaged = False
        self._waiting = Turns[Change]()
        self._handed_in = threading.Condition()
        self._is_closing = False
        self._writer: threading.Thread | None = None
        if self.backend.one_writer:
            self._writer = threading.Thread(target=self._write_all, name="store", daemon=True)
            self._writer.start()

    @property
    def clock(self) -> ColumnElement[float]:
        """Seconds since 1970 by the clock of the database, which all its processes share."""
        return literal_column(self.backend.clock, Float)

    def check(self) -> None:
        """Check that the database answers, is still this process's, and was not found damaged.

        Raises
        ------
        StoreError
        """
        if self._is_damaged:
            raise _damaged()
        with self.failures():
            self.backend.check()
        with self.read() as connection:
            connection.execute(text("SELECT 1 FROM alembic_version"))

    def check_pages(self) -> None:
        """Look through an SQLite file for damage, about a second for a gigabyte.

        Raises
        ------
        StoreError
        """
        with self.read() as connection:
            if not self.backend.is_whole(connection):
                raise _damaged()

    @contextlib.contextmanager
    def reserved(self, process: str, at: str = "") -> Iterator[None]:
        """Reserve the data for this process while the block runs: a second one would end its jobs.

        An SQLite file has one service; a PostgreSQL database has one of each name. If the
        reservation is lost meanwhile, the database refuses to write, with a
        :class:`~app.service.problems.DispossessedError`.

        Parameters
        ----------
        process : name of this process.
        at : its address, which a second service shows its user.

        Raises
        ------
        InputError
            If another process has them.
        StoreError
            If the database cannot be reached.
        """
        with contextlib.ExitStack() as stack:
            with self.read():  # opens the files of SQLite, which its lock then lists
                pass
            with self.failures():
                stack.enter_context(self.backend.reserved(process, at))
            yield

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

    def page(
        self,
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
                    "cursor",
                    "is not a cursor of this service.",
                    "Send next_cursor of the page before.",
                ) from None
        with self.read() as connection:
            ordered = chosen.order_by(at.desc(), identifier.desc()).limit(limit + 1)
            rows = connection.execute(ordered).all()
        if len(rows) <= limit:
            return rows, None
        last_row = rows[limit - 1]._mapping
        return rows[:limit], f"{last_row[at.name]!r}_{last_row[identifier.name]}"

    @contextlib.contextmanager
    def snapshot(self) -> Iterator[Connection]:
        """A connection whose later reads see the same state as its first."""
        with self.read() as connection:
            connection.execution_options(**self.backend.snapshot)
            yield connection

    def write(self, action: Callable[[Connection], T]) -> T:
        """Run ``action`` in a transaction and return what it returns, once the change is on disk.

        Raises
        ------
        StoreError
            If it could not be made durable. Then nothing of it is kept, unless the connection to
            a server was lost during the commit.
        """
        if self._writer is None:
            self.backend.check_writable()
            with self.failures(), self.engine.connect() as connection:
                result = action(connection)
                with _failures(UNKNOWN):  # the server may have committed before it was lost
                    connection.commit()
                return result
        with self.failures():
            return self._hand_in(action).result()

    async def written(self, action: Callable[[Connection], T]) -> T:
        """Write from the event loop, without a thread that waits for the disk.

        Raises
        ------
        StoreError
            As in :meth:`write`.
        """
        if self._writer is None:
            return await asyncio.to_thread(self.write, action)
        with self.failures():
            return await asyncio.wrap_future(self._hand_in(action))

    def close(self) -> None:
        """Write pending changes, then close all connections; doing so again has no effect."""
        if self._writer is not None:
            with self._handed_in:
                self._is_closing = True
                self._handed_in.notify()
            self._writer.join()
            self._writer = None
        self.backend.close()

    @contextlib.contextmanager
    def failures(self) -> Iterator[None]:
        """Turn errors of the database itself into a StoreError."""
        try:
            with _failures():
                yield
        except DamagedError:
            self._is_damaged = True
            raise

    def _hand_in(self, action: Callable[[Connection], T]) -> Future[T]:
        done: Future[T] = Future()
        with self._handed_in:
            self._waiting.add(current_user.get(), (action, done))
            self._handed_in.notify()
        return done

    def _next(self, *, wait: bool) -> Change | None:
        """Take the change whose turn it is, unless it was cancelled; None if there is none."""
        while True:
            with self._handed_in:
                while (turn := self._waiting.next()) is None and wait and not self._is_closing:
                    self._handed_in.wait()
            if turn is None or turn[1][1].set_running_or_notify_cancel():
                return turn and turn[1]

    def _write_all(self) -> None:
        while (change := self._next(wait=True)) is not None:
            batch = [change]
            self._commit(batch, self._others(batch))

    def _others(self, batch: list[Change]) -> Iterator[Change]:
        """Add to a batch what waits beside its first change."""
        until = time.monotonic() + BATCH_S
        while len(batch) < MAX_BATCH and time.monotonic() < until:
            if (change := self._next(wait=False)) is None:
                return
            batch.append(change)
            yield change

    def _commit(self, batch: list[Change], others: Iterable[Change] = ()) -> None:
        """Make the first change of a batch, and others that are added to it meanwhile."""
        outcomes: list[tuple[Future[Any], Any, Exception | None]] = []
        try:
            with self.engine.connect() as connection:
                connection.execution_options(knitcore_write=True)
                with connection.begin():
                    for action, done in chain(batch[:1], others):
                        outcomes.append((done, *_attempt(connection, action)))
                    self.backend.check()  # some came after it had begun
        except Exception as error:
            if len(batch) > 1:
                for change in batch:  # one by one, so that only the failing change is refused
                    self._commit([change])
            else:
                batch[0][1].set_exception(error)
            return
        for done, result, refused in outcomes:
            if refused is None:
                done.set_result(result)
            else:
                done.set_exception(refused)


def backend_of(url: str) -> Backend:
    """The database that a URL names, unopened."""
    parts = make_url(url)
    if parts.get_backend_name() == "sqlite":
        return SqliteFile(Path(parts.database or ""))
    from .postgresql import PostgresqlServer  # its dialect loads for 0.05 s

    return PostgresqlServer(url)


def holder(url: str, process: str) -> str | None:
    """The service that has the data of a URL now, in words; None if there is none.

    Raises
    ------
    StoreError
        If the database cannot be reached.
    """
    with _failures():
        return backend_of(url).holder(process)


@contextlib.contextmanager
def _failures(outcome: str = UNCHANGED) -> Iterator[None]:
    """Turn errors of the database itself into a StoreError that says what came of a change."""
    try:
        yield
    except (DBAPIError, PoolTimeoutError) as error:
        reason = str(error).splitlines()[0]
        if any(words in reason for words in DAMAGED):
            log.error("the database is damaged: %s", reason)
            raise _damaged() from error
        # a lost connection can end a statement with an error of any kind
        is_lost = isinstance(error, DBAPIError) and error.connection_invalidated
        if not (is_lost or isinstance(error, FAILURES)):
            raise
        raise _failed(reason, outcome) from error


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


def _failed(reason: str, outcome: str) -> StoreError:
    log.error("the database failed: %s", reason)
    kind = StoreFullError if any(words in reason for words in FULL) else StoreError
    return kind(UNREACHABLE.format(reason=_public(reason), outcome=outcome))


def _damaged() -> DamagedError:
    return DamagedError("The file of the designs is damaged.")


def _public(reason: str) -> str:
    """A reason without internal addresses and machine names."""
    for known in (*FULL, "disk I/O error", "database is locked", "readonly database"):
        if known in reason:
            return known
    return "the database does not answer"
