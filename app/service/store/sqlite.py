"""SQLite: a file and those beside it, made once, watched, and reserved by one service.

SQLite holds its locks by process, not by descriptor: closing *any* descriptor of the file drops the
locks of every connection that the process has to it (POSIX). Other programs then take themselves
for the only one, and remove the log in which the newest changes are. Nothing here opens a
database's file but SQLite.
"""

from __future__ import annotations

import contextlib
import fcntl
import os
import sqlite3
import threading
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any, NamedTuple

from sqlalchemy import (
    Column,
    ColumnElement,
    Connection,
    Integer,
    create_engine,
    event,
    literal_column,
    select,
)
from sqlalchemy.dialects.sqlite import insert
from sqlalchemy.pool import QueuePool

from knitcore.base.errors import InputError

from ..problems import DispossessedError, VanishedError
from .backend import Backend

BUSY_TIMEOUT_MS = 10_000
CONNECTIONS = 24
"""Connections that stay open: as many as there are threads that read and write. One more would be
opened for each time that it is used, which takes longer than most reads."""
BESIDE = ("-wal", "-shm")
"""Files that SQLite keeps beside its own while it is open: the newest changes, and their index."""
STOP_FIRST = (
    "Stop the service (SIGTERM, not a kill: it then saves what was acknowledged) and start it "
    "again. Remove no file beside the designs while a service runs."
)


class Holder(NamedTuple):
    """The service that has reserved a file."""

    process: str
    address: str
    files: dict[str, int]
    """Inodes of the files that it uses, by name."""

    @property
    def text(self) -> str:
        """Text of the lock's file: a line for the holder, and one for each of its files."""
        files = "".join(f"\n{inode} {name}" for name, inode in self.files.items())
        return f"{self.process} {self.address}".strip() + files

    @classmethod
    def read(cls, text: str) -> Holder:
        """The holder that a lock's file names."""
        first, *files = text.splitlines() or [""]
        process, _, address = first.partition(" ")
        pairs = (line.partition(" ") for line in files)
        inodes = {name: int(inode) for inode, _, name in pairs if inode.isdigit()}
        return cls(process or "unknown", address, inodes)


class SqliteFile(Backend):
    """An SQLite file, made when it is first opened, and never again.

    SQLite would create an empty database in place of a lost one, and would go on writing into
    deleted files.

    Parameters
    ----------
    path : the file.
    """

    one_writer = True
    insert = staticmethod(insert)
    clock = "knitcore_clock()"  # SQLite's own knows no more than milliseconds

    def __init__(self, path: Path) -> None:
        self.path = path
        self.lock = _lock_of(path)
        self._ours: dict[Path, tuple[int, int] | None] = {}
        self._opening = threading.Lock()
        self._kept: sqlite3.Connection | None = None

    def open(self) -> None:
        """Make the file if it is not there; refuse one that was lost, or beside which a service
        lost files."""
        self._check_not_lost()
        self._check_whole()
        _make(self.path)
        self._ours[self.path] = _identity(self.path)
        self.engine = create_engine(
            "sqlite://", creator=self.connect, poolclass=QueuePool, pool_size=CONNECTIONS
        )

        @event.listens_for(self.engine, "connect")
        def _(connection: Any, _record: Any) -> None:
            connection.isolation_level = None  # BEGIN is ours, below
            connection.create_function(self.clock.removesuffix("()"), 0, time.time)
            for pragma in (
                "journal_mode=WAL",
                "synchronous=FULL",  # a commit is on disk, not only in the system's memory
                "foreign_keys=ON",
                f"busy_timeout={BUSY_TIMEOUT_MS}",
            ):
                connection.execute(f"PRAGMA {pragma}")

        @event.listens_for(self.engine, "begin")
        def _(connection: Connection) -> None:
            self.check()
            write = connection.get_execution_options().get("knitcore_write")
            connection.exec_driver_sql("BEGIN IMMEDIATE" if write else "BEGIN")

    def connect(self) -> sqlite3.Connection:
        """A connection to the file; a missing one is not created.

        The first call opens one more, which stays open until :meth:`close`: as long as there is
        one, no process replaces the files beside, and they are known to be ours.

        Raises
        ------
        VanishedError, DispossessedError
        """
        self.check()
        with self._opening:
            if self._kept is None:
                kept = self._connect()
                try:
                    kept.execute("PRAGMA journal_mode=WAL")
                    kept.execute("SELECT 1 FROM sqlite_master").fetchone()  # opens the log
                except sqlite3.Error:
                    kept.close()
                    raise
                self._ours |= {place: _identity(place) for place in self._beside}
                self._kept = kept
        return self._connect()

    def check(self) -> None:
        """Refuse to continue without the file or those beside it.

        Raises
        ------
        VanishedError
            If the file itself is gone or was replaced.
        DispossessedError
            If this holds for a file beside it.
        """
        for place, identity in list(self._ours.items()):
            present = _identity(place)
            if present != identity:
                what = "is gone" if present is None else "was replaced by another"
                if place == self.path:
                    raise VanishedError(f"The file of the designs {what}; nothing was changed.")
                raise DispossessedError(
                    f"The file {place.name} beside the designs {what}; nothing was changed.",
                    remedy=STOP_FIRST,
                )

    def check_unopened(self) -> bool:
        """Refuse a file that was lost, or is open although the lock of its service is gone; False
        if the first start has yet to make it."""
        self._check_not_lost()
        if not self.path.exists():
            return False
        log = self.path.with_name(self.path.name + BESIDE[0])
        if log.exists() and not self.lock.exists():
            raise InputError(
                "data_dir",
                f"{self.path} is open, or a command on it was killed, but {self.lock.name} is not "
                "there.",
                STOP_FIRST,
            )
        return True

    def part_of(
        self,
        connection: Connection,
        column: Column[bytes],
        row: ColumnElement[bool],
        start: int,
        size: int,
    ) -> bytes | None:
        """Bytes of a large value; ``substr`` would read all of it each time."""
        place = select(literal_column("rowid", Integer)).select_from(column.table).where(row)
        rowid = connection.execute(place).scalar()
        if rowid is None:
            return None
        file: sqlite3.Connection = connection.connection.driver_connection  # type: ignore[assignment]
        with file.blobopen(column.table.name, column.name, rowid, readonly=True) as blob:
            blob.seek(start)
            return blob.read(size)

    def is_whole(self, connection: Connection) -> bool:
        """Look through all pages for damage, about a second for a gigabyte."""
        return bool(connection.exec_driver_sql("PRAGMA quick_check(1)").scalar() == "ok")

    def keep_copy(self, name: str) -> None:
        """Copy the database to a file beside it, readable by this user only."""
        copy = self.path.with_name(f"{self.path.name}.{name}")
        if copy.exists():
            return
        partial = copy.with_name(f"{copy.name}.partial")
        partial.unlink(missing_ok=True)  # of a disk that was full
        os.close(os.open(partial, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600))
        with contextlib.closing(self.engine.raw_connection()) as connection:
            connection.cursor().execute("VACUUM INTO ?", (str(partial),))
        partial.rename(copy)

    def close(self) -> None:
        """Close all connections, the one that was kept open last."""
        super().close()
        if self._kept is not None:
            self._kept.close()
            self._kept = None
        for place in self._beside:
            self._ours.pop(place, None)

    @contextlib.contextmanager
    def reserved(self, process: str, at: str) -> Iterator[None]:
        """Reserve the file, which one service may use, whatever its name."""
        del process
        handle = os.open(self.lock, os.O_RDWR | os.O_CREAT, 0o600)
        try:
            try:
                fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
            except OSError:
                other = _holder(handle)
                known = f"Open {other.address} in a browser, or stop" if other.address else "Stop"
                raise InputError(
                    "data_dir",
                    f"{self.path.parent} is used by another service (process {other.process}).",
                    f"{known} that one, set KNITCORE_DATA_DIR to another folder, or share "
                    "PostgreSQL.",
                ) from None
            facts = os.fstat(handle)
            self._ours[self.lock] = facts.st_dev, facts.st_ino
            files = {place.name: identity[1] for place, identity in self._ours.items() if identity}
            os.truncate(handle, 0)
            os.pwrite(handle, Holder(str(os.getpid()), at, files).text.encode(), 0)
            yield
        finally:
            self._ours.pop(self.lock, None)
            os.close(handle)  # which unlocks it, as the end of a killed process does

    def holder(self, process: str) -> str | None:
        """Name the service that has the file now."""
        del process
        service = holder_of(self.path)
        if service is None:
            return None
        at = f", at {service.address}" if service.address else ""
        return f"Process {service.process} runs on it{at}."

    def _check_not_lost(self) -> None:
        """Refuse to make a database where a service had one before, or where a file is empty."""
        path = self.path
        used = ", although a service used it before" if self.lock.exists() else ""
        is_empty = path.is_file() and not path.stat().st_size
        if is_empty or (used and not path.exists()):
            raise InputError(
                "data_dir",
                f"{path} is {'empty' if is_empty else 'gone'}{used}.",
                f"Put it back; or remove it and {self.lock}, to begin with none or to restore a "
                "backup.",
            )

    def _check_whole(self) -> None:
        """Refuse a file beside which a running service lost what it works with.

        What was written into it would not reach the service, and what the service wrote last would
        not be read.
        """
        service = holder_of(self.path)
        for name, inode in service.files.items() if service is not None else ():
            identity = _identity(self.path.with_name(name))
            if service is not None and (identity is None or identity[1] != inode):
                raise InputError(
                    "data_dir",
                    f"{name} was removed or replaced under the service that runs (process "
                    f"{service.process}).",
                    STOP_FIRST,
                )

    @property
    def _beside(self) -> list[Path]:
        return [self.path.with_name(self.path.name + end) for end in BESIDE]

    def _connect(self) -> sqlite3.Connection:
        # threads take turns with a connection; the pool sees to that
        address = f"{self.path.absolute().as_uri()}?mode=rw"
        return sqlite3.connect(address, uri=True, check_same_thread=False)


def holder_of(path: Path) -> Holder | None:
    """The service that has reserved an SQLite file now; None if there is none."""
    try:
        handle = os.open(_lock_of(path), os.O_RDONLY)
    except (FileNotFoundError, NotADirectoryError):
        return None
    try:
        fcntl.flock(handle, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except OSError:
        return _holder(handle)
    finally:
        os.close(handle)
    return None


def _lock_of(path: Path) -> Path:
    return path.with_name(f"{path.name}.lock")


def _make(path: Path) -> None:
    """Make a file that is not there; one that is there is only looked at."""
    problem: str | None = None
    try:
        os.close(os.open(path, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600))
    except FileExistsError:
        if not path.is_file():
            problem = "it is no file"
        elif not os.access(path, os.R_OK | os.W_OK):
            problem = "this user may not write it"
    except OSError as error:
        problem = str(error.strerror)
    if problem is not None:
        raise InputError(
            "database_url",
            f"{path} cannot be opened ({problem}).",
            "Name a file that can be written, in a folder that exists.",
        )


def _identity(path: Path) -> tuple[int, int] | None:
    """Device and inode of a file; None if there is none."""
    try:
        facts = os.stat(path)
    except OSError:
        return None
    return facts.st_dev, facts.st_ino


def _holder(handle: int) -> Holder:
    """The service that wrote itself into a lock's file."""
    return Holder.read(os.pread(handle, 4_000, 0).decode(errors="replace"))
