"""One service process per set of data: a second one would end the first one's jobs."""

from __future__ import annotations

import contextlib
import fcntl
import os
from collections.abc import Iterator
from pathlib import Path

from sqlalchemy import text

from app.store.database import Database
from knitcore.errors import InputError


@contextlib.contextmanager
def held(database: Database, process: str, at: str = "") -> Iterator[None]:
    """Reserve the data for this process while the block runs.

    An SQLite file has one service; a PostgreSQL database has one of each name.

    Parameters
    ----------
    database : the data.
    process : name of this process.
    at : its address, which a second service shows its user.

    Raises
    ------
    InputError
        If another process has them.
    StoreError
        If the database cannot be reached.
    """
    with _of_file(database.lock_file, at) if database.is_sqlite else _of_server(database, process):
        yield


def holder(database: Database, process: str) -> str | None:
    """The service that has the data now, in words; None if there is none.

    Raises
    ------
    StoreError
        If the database cannot be reached.
    """
    if not database.is_sqlite:
        try:
            with _of_server(database, process):
                return None
        except InputError:
            return f"A service called {process!r} runs on this database."
    if not database.lock_file.exists():
        return None
    handle = os.open(database.lock_file, os.O_RDONLY)
    try:
        fcntl.flock(handle, fcntl.LOCK_SH | fcntl.LOCK_NB)
    except OSError:
        pid, address = _holder(handle)
        return f"Process {pid} runs on it{f', at {address}' if address else ''}."
    finally:
        os.close(handle)
    return None


@contextlib.contextmanager
def _of_file(file: Path, at: str) -> Iterator[None]:
    handle = os.open(file, os.O_RDWR | os.O_CREAT, 0o600)
    try:
        try:
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            pid, address = _holder(handle)
            known = f"Open {address} in a browser, or stop" if address else "Stop"
            raise InputError(
                "data_dir",
                f"{file.parent} is used by another service (process {pid}).",
                f"{known} that one, set KNITCORE_DATA_DIR to another folder, or share PostgreSQL.",
            ) from None
        os.truncate(handle, 0)
        os.pwrite(handle, f"{os.getpid()} {at}".strip().encode(), 0)
        yield
    finally:
        os.close(handle)  # which unlocks it, as the end of a killed process does


def _holder(handle: int) -> tuple[str, str]:
    """Number and address of the process that wrote itself into a lock's file."""
    pid, _, address = os.pread(handle, 300, 0).decode(errors="replace").partition(" ")
    return pid or "unknown", address


@contextlib.contextmanager
def _of_server(database: Database, process: str) -> Iterator[None]:
    with database.read() as connection:
        connection.execution_options(isolation_level="AUTOCOMMIT")
        lock = text("SELECT pg_try_advisory_lock(hashtextextended(:name, 0))")
        if not connection.execute(lock, {"name": f"knitcore {process}"}).scalar():
            raise InputError(
                "process_name",
                f"another service on this database is called {process!r}.",
                "Stop that one, or give each its own KNITCORE_PROCESS_NAME.",
            )
        yield
