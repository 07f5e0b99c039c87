"""One service process per set of data: a second one would end the first one's jobs."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator

from knitcore.base.errors import InputError

from .database import Database, sqlite_file
from .file import holder_of
from .name_lock import NameLock


@contextlib.contextmanager
def held(database: Database, process: str, at: str = "") -> Iterator[None]:
    """Reserve the data for this process while the block runs.

    An SQLite file has one service; a PostgreSQL database has one of each name. If the reservation
    is lost meanwhile, the database refuses to write, with a
    :class:`~app.service.problems.DispossessedError`.

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
    if database.file is not None:
        with database.read():  # opens the files, which the lock's file then lists
            pass
        with database.file.reserved(at):
            yield
        return
    lock = NameLock(database.engine, process)
    with database.failures():
        is_ours = lock.take()
    if not is_ours:
        raise InputError(
            "process_name",
            f"another service on this database is called {process!r}.",
            "Stop that one, or give each its own KNITCORE_PROCESS_NAME.",
        )
    database.name_lock = lock
    try:
        with lock.watched():
            yield
    finally:
        database.name_lock = None


def holder(url: str, process: str) -> str | None:
    """The service that has the data of a URL now, in words; None if there is none.

    Raises
    ------
    StoreError
        If the database cannot be reached.
    """
    file = sqlite_file(url)
    if file is None:
        with contextlib.closing(Database(url)) as database, database.failures():
            is_taken = NameLock(database.engine, process).is_taken()
        return f"A service called {process!r} runs on this database." if is_taken else None
    service = holder_of(file)
    if service is None:
        return None
    at = f", at {service.address}" if service.address else ""
    return f"Process {service.process} runs on it{at}."
