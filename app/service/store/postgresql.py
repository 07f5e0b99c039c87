"""PostgreSQL: a server of several services, each of which reserves its name by an advisory lock."""

import contextlib
import logging
import secrets
import threading
from collections.abc import Iterator
from types import MappingProxyType

from sqlalchemy import Connection, Engine, create_engine, text
from sqlalchemy.dialects.postgresql import insert
from sqlalchemy.exc import DBAPIError, SQLAlchemyError

from knitcore.base.errors import InputError

from ..problems import DispossessedError
from .backend import Backend

log = logging.getLogger("knitcore.store")

PING_S = 1.0
"""Period in which the connection that holds the lock is tried."""
TRY_LOCK = text("SELECT pg_try_advisory_lock(hashtextextended(:name, 0))")
IS_TAKEN = text(
    "SELECT count(*) > 0 FROM pg_locks JOIN pg_database ON pg_database.oid = pg_locks.database"
    " WHERE datname = current_database() AND locktype = 'advisory' AND granted AND objsubid = 1"
    " AND (classid::bigint << 32 | objid::bigint) = hashtextextended(:name, 0)"
)
TAKE_TURNS = text("SELECT pg_advisory_xact_lock(hashtextextended(:name, 0))")
SET_MARK = text("SELECT set_config('application_name', :mark, false)")
END_MARKED = text(
    "SELECT pg_terminate_backend(pid) FROM pg_stat_activity"
    " WHERE application_name = :mark AND pid <> pg_backend_pid()"
)


class PostgresqlServer(Backend):
    """A database on a server.

    Parameters
    ----------
    url : ``postgresql+psycopg://…``.

    Attributes
    ----------
    name_lock : of the name that this process has reserved.
    """

    one_writer = False
    insert = staticmethod(insert)
    clock = "CAST(EXTRACT(EPOCH FROM clock_timestamp()) AS double precision)"
    snapshot = MappingProxyType({"isolation_level": "REPEATABLE READ"})

    def __init__(self, url: str) -> None:
        self._url = url
        self.name_lock: NameLock | None = None

    def open(self) -> None:
        """Make the engine, which connects when it is used."""
        self.engine = create_engine(
            self._url,
            pool_pre_ping=True,  # a database that went away and came back is found again
            pool_size=10,
            max_overflow=10,
            pool_timeout=5,
            connect_args={"connect_timeout": 3, "tcp_user_timeout": 10_000},  # s, ms
        )

    def check(self) -> None:
        """Ask whether the name is still reserved for this process."""
        if self.name_lock is not None:
            self.name_lock.keep()

    def take_turns(self, connection: Connection, name: str) -> None:
        """Let other transactions of this name wait until this one ends."""
        connection.execute(TAKE_TURNS, {"name": f"knitcore turn {name}"})

    def check_writable(self) -> None:
        """Refuse to write after another process has taken the name."""
        if self.name_lock is not None:
            self.name_lock.check()

    @contextlib.contextmanager
    def reserved(self, process: str, at: str) -> Iterator[None]:
        """Reserve the name of a process."""
        del at
        lock = NameLock(self.engine, process)
        if not lock.take():
            raise InputError(
                "process_name",
                f"another service on this database is called {process!r}.",
                "Stop that one, or give each its own KNITCORE_PROCESS_NAME.",
            )
        self.name_lock = lock
        try:
            with lock.watched():
                yield
        finally:
            self.name_lock = None

    def holder(self, process: str) -> str | None:
        """Name the service that has reserved the name now."""
        self.open()
        try:
            is_taken = NameLock(self.engine, process).is_taken()
        finally:
            self.close()
        return f"A service called {process!r} runs on this database." if is_taken else None


class NameLock:
    """The lock of a name, on a connection of its own that is watched.

    The server frees it when the connection is lost, as at its restart; it is then taken again. If
    another process was faster, the data is that one's, and stays so.

    Parameters
    ----------
    engine : of the database.
    process : the name.
    """

    def __init__(self, engine: Engine, process: str) -> None:
        self._engine = engine
        self._process = process
        self._name = {"name": f"knitcore {process}"}
        self._mark = f"knitcore {secrets.token_hex(8)}"  # finds a connection that we have lost
        self._turn = threading.Lock()
        self._connection: Connection | None = None
        self._is_lost = False

    def is_taken(self) -> bool:
        """Return whether a process has the lock now, without taking it."""
        with self._engine.connect() as connection:
            return bool(connection.execute(IS_TAKEN, self._name).scalar())

    def take(self) -> bool:
        """Take the lock; False if another process has it."""
        connection = self._engine.connect().execution_options(isolation_level="AUTOCOMMIT")
        connection.detach()  # closing it ends its session, and with it the lock
        try:
            connection.execute(SET_MARK, {"mark": self._mark})
            if connection.execute(TRY_LOCK, self._name).scalar():
                self._connection = connection
                return True
        finally:
            if self._connection is not connection:
                connection.close()
        return False

    def check(self) -> None:
        """Refuse to continue after another process has taken the name; asks nobody.

        Raises
        ------
        DispossessedError
        """
        if self._is_lost:
            raise DispossessedError(
                f"Another service called {self._process!r} has taken over the designs.",
                remedy="Stop this one, and give each a KNITCORE_PROCESS_NAME of its own.",
            )

    def keep(self) -> None:
        """Ask whether the lock is still held, and take it again if its connection was lost.

        Raises
        ------
        DispossessedError
            If another process was faster.
        SQLAlchemyError
            If the database cannot be reached.
        """
        with self._turn:
            self.check()
            if self._answers():
                return
            self.free()
            ends_soon = self._ended_own()
            if self.take():
                log.warning("the lock of %r was lost and is taken again", self._process)
            elif not ends_soon:
                self._is_lost = True
                log.error("another service has taken the name %r", self._process)
            self.check()

    def free(self) -> None:
        """Let others take the lock."""
        connection, self._connection = self._connection, None
        if connection is not None:
            with contextlib.suppress(DBAPIError):  # it was lost already
                connection.close()

    @contextlib.contextmanager
    def watched(self) -> Iterator[None]:
        """Keep the lock while the block runs, then free it."""
        stop = threading.Event()

        def watch() -> None:
            while not stop.wait(PING_S):
                try:
                    self.keep()
                except SQLAlchemyError as error:  # whoever uses the database reports it
                    log.debug("the lock of %r waits for the database: %s", self._process, error)
                except DispossessedError:
                    return

        watching = threading.Thread(target=watch, name="name lock", daemon=True)
        watching.start()
        try:
            yield
        finally:
            stop.set()
            watching.join()
            self.free()

    def _answers(self) -> bool:
        if self._connection is None:
            return False
        try:
            self._connection.execute(text("SELECT 1"))
        except DBAPIError:
            return False
        return True

    def _ended_own(self) -> bool:
        """End the session of a connection that we have lost, if the server has not noticed yet."""
        with self._engine.connect() as connection:
            return bool(connection.execute(END_MARKED, {"mark": self._mark}).all())
