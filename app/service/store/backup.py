"""Backups: one compressed file of JSON lines, which any program can read.

The same file moves an installation between SQLite and PostgreSQL.
"""

import gzip
import json
import os
import time
import zlib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from pydantic import BaseModel
from sqlalchemy import Connection, MetaData, func, insert, select
from sqlalchemy.exc import SQLAlchemyError

from knitcore.base.errors import InputError

from .database import Database
from .schema import migrate, revision
from .tables import metadata

FORMAT = "knitcore-backup"
VERSION = 1
LEFT_OUT = frozenset({"results", "idempotency_keys", "service_keys", "sessions"})
"""Left out: can be computed again, expires within a day, or would let a thief sign sessions."""
CHUNK = 200
LEVEL = 6
"""gzip's default, 9, takes thirty times as long on charts and saves 5 %."""


class BackupReport(BaseModel):
    """Numbers of rows written or read."""

    file: str
    tables: dict[str, int]

    @property
    def text(self) -> str:
        """The report in words."""
        return f"{self.file}: {', '.join(f'{n} {name}' for name, n in self.tables.items())}"


def back_up(database: Database, file: Path) -> BackupReport:
    """Write everything that must not be lost to a new file, while the service runs.

    Raises
    ------
    InputError
        If the file exists or cannot be written.
    StoreError
        If the database cannot be read.
    """
    if file.exists():
        raise InputError("file", f"{file} exists.", "Name a new file.")
    tables = [table for table in metadata.sorted_tables if table.name not in LEFT_OUT]
    counts = dict.fromkeys((table.name for table in tables), 0)
    header = {
        "format": FORMAT,
        "version": VERSION,
        "schema": revision(database),
        "written_at": time.time(),
    }
    partial = file.with_name(file.name + ".partial")
    try:
        handle = os.open(partial, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600)
        with os.fdopen(handle, "wb") as raw:
            with (
                gzip.open(raw, "wt", LEVEL, encoding="utf-8") as out,
                database.snapshot() as connection,
            ):
                out.write(json.dumps(header) + "\n")
                for table in tables:
                    for row in connection.execute(select(table)):
                        out.write(json.dumps({"table": table.name, "row": dict(row._mapping)}))
                        out.write("\n")
                        counts[table.name] += 1
                out.write(json.dumps({"end": counts}) + "\n")
            raw.flush()
            os.fsync(raw.fileno())
        partial.rename(file)
    except OSError as error:
        raise InputError(
            "file", f"{file} cannot be written ({error.strerror}).", "Choose another place."
        ) from error
    finally:
        partial.unlink(missing_ok=True)
    return BackupReport(file=str(file), tables=counts)


def restore(database: Database, file: Path) -> BackupReport:
    """Read a backup into an empty database; all of it or nothing.

    Raises
    ------
    InputError
        If the file is not a complete backup, or the database holds designs already.
    StoreError
        If the database cannot be written.
    """
    lines = _lines(file)
    header = next(lines, {})
    if header.get("format") != FORMAT or header.get("version") != VERSION:
        raise InputError("file", f"{file} is not a backup of this program.", "Choose another file.")
    migrate(database, str(header.get("schema")))
    reflected = MetaData()
    with database.read() as connection:
        reflected.reflect(connection)

    def action(connection: Connection) -> dict[str, int]:
        for table in reflected.sorted_tables:
            if table.name != "alembic_version":
                held = connection.execute(select(func.count()).select_from(table)).scalar_one()
                if held:
                    raise InputError(
                        "database_url",
                        f"the database holds {held} rows in {table.name} already.",
                        "Restore into a new data folder or an empty database.",
                    )
        return _fill(connection, reflected, lines, file)

    try:
        counts = database.write(action)
    except (LookupError, TypeError, AttributeError, SQLAlchemyError) as error:
        raise InputError("file", f"{file} is damaged.", "Use another backup.") from error
    migrate(database)
    return BackupReport(file=str(file), tables=counts)


def _fill(
    connection: Connection, tables: MetaData, lines: Iterator[dict[str, Any]], file: Path
) -> dict[str, int]:
    counts: dict[str, int] = {}
    waiting: list[dict[str, Any]] = []
    current = ""
    for line in lines:
        if "end" in line or line["table"] != current or len(waiting) == CHUNK:
            if waiting:
                connection.execute(insert(tables.tables[current]), waiting)
            waiting = []
        if "end" in line:
            if {k: n for k, n in line["end"].items() if n} != counts or any(lines):
                break  # reading on to the end of the file compares its checksum, too
            return dict(line["end"])
        current = line["table"]
        waiting.append(line["row"])
        counts[current] = counts.get(current, 0) + 1
    raise InputError("file", f"{file} is incomplete.", "Use another backup.")


def _lines(file: Path) -> Iterator[dict[str, Any]]:
    try:
        with gzip.open(file, "rt", encoding="utf-8") as text:
            for line in text:
                row = json.loads(line)
                if not isinstance(row, dict):
                    raise ValueError("not an object")
                yield row
    except (OSError, EOFError, ValueError, zlib.error) as error:
        raise InputError(
            "file", f"{file} cannot be read ({error}).", "Use another backup."
        ) from error
