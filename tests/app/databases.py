"""Databases for tests: a fresh SQLite file, and a real PostgreSQL where it is installed."""

import contextlib
import os
import secrets
import shutil
import sqlite3
from collections.abc import Iterator
from pathlib import Path

from sqlalchemy import NullPool, create_engine, text

from app.service.store.database import Database
from app.service.store.schema import migrate
from scripts.composition import postgres as run_program


@contextlib.contextmanager
def opened(place: Path | str, *, migrated: bool = True) -> Iterator[Database]:
    """The database in a folder or at a URL, with its tables."""
    if isinstance(place, Path):
        place.mkdir(exist_ok=True)
        place = f"sqlite:///{place / 'knitcore.sqlite3'}"
    with contextlib.closing(Database(place)) as database:
        if migrated:
            migrate(database)
        yield database


@contextlib.contextmanager
def empty(url: str) -> Iterator[str]:
    """The URL of an empty database of its own on the server at a URL."""
    name = f"knit_{secrets.token_hex(6)}"
    # no connection is kept: the server may be away for a while
    server = create_engine(url, isolation_level="AUTOCOMMIT", poolclass=NullPool)
    try:
        with server.connect() as connection:
            connection.execute(text(f"CREATE DATABASE {name}"))
        yield url.replace("/postgres?", f"/{name}?")
        with server.connect() as connection:
            connection.execute(text(f"DROP DATABASE {name} WITH (FORCE)"))
    finally:
        server.dispose()


@contextlib.contextmanager
def sqlite(file: Path) -> Iterator[sqlite3.Connection]:
    """A connection to a file past the service; what it changes is kept."""
    with contextlib.closing(sqlite3.connect(file)) as connection, connection:
        yield connection


def is_whole(file: Path) -> bool:
    """Return whether SQLite finds no damage in a file."""
    with sqlite(file) as connection:
        return connection.execute("PRAGMA integrity_check").fetchone() == ("ok",)


def control(url: str, *arguments: str) -> None:
    """``pg_ctl`` for the server at a URL of :func:`postgres`."""
    folder = Path(url.partition("host=")[2])
    options = f"-c listen_addresses='' -c unix_socket_directories={folder} -c fsync=off"
    if "start" in arguments:
        arguments = ("-o", options, "-l", str(folder / "log"), *arguments)
    run_program("pg_ctl", "-w", "-D", str(folder / "data"), *arguments)


@contextlib.contextmanager
def away(url: str) -> Iterator[None]:
    """The server at a URL is stopped while the block runs."""
    control(url, "-m", "immediate", "stop")
    try:
        yield
    finally:
        control(url, "start")


@contextlib.contextmanager
def postgres(folder: Path) -> Iterator[str]:
    """A PostgreSQL of our own that listens on a socket in ``folder``; yields its URL."""
    if os.geteuid() == 0:
        shutil.chown(folder, "postgres")
    run_program("initdb", "-D", str(folder / "data"), "-A", "trust", "-U", "knit", "-N")
    url = f"postgresql+psycopg://knit@/postgres?host={folder}"
    control(url, "start")
    try:
        yield url
    finally:
        control(url, "-m", "immediate", "stop")
