"""Durable writes, shared commits, and what happens when the database fails."""

import asyncio
import contextlib
import hashlib
import threading
from collections.abc import AsyncIterator, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import pytest
from alembic.autogenerate import compare_metadata
from alembic.runtime.migration import MigrationContext
from sqlalchemy import Connection, event, text
from sqlalchemy.exc import DBAPIError, IntegrityError, ProgrammingError
from sqlalchemy.schema import CreateIndex, CreateTable

from app.service.identity import current_user
from app.service.problems import StoreError
from app.service.store import database as database_module
from app.service.store.database import Database
from app.service.store.schema import migrate, revision
from app.service.store.tables import metadata
from knitcore.base.errors import InputError
from tests.app.databases import opened


@pytest.fixture
def database(place: Path | str) -> Iterator[Database]:
    with opened(place, migrated=False) as database:
        yield database


@pytest.fixture
def file(tmp_path: Path) -> Iterator[Database]:
    """A database of the kind that is one file."""
    with opened(tmp_path, migrated=False) as database:
        yield database


def _insert(value: int) -> Any:
    return lambda c: c.execute(text("INSERT INTO t VALUES (:v)"), {"v": value})


def _table(database: Database) -> None:
    database.write(lambda c: c.execute(text("CREATE TABLE t (v INTEGER PRIMARY KEY)")))


def _values(database: Database) -> list[int]:
    with database.read() as connection:
        return list(connection.execute(text("SELECT v FROM t ORDER BY v")).scalars())


def test_the_migrations_make_the_tables(database: Database) -> None:
    """The first migration has the number of the schema that programs wrote before it."""
    migrate(database)
    migrate(database)
    assert revision(database) == "0010"
    with database.read() as connection:
        assert compare_metadata(MigrationContext.configure(connection), metadata) == []


def test_tables_change_with_a_migration_only() -> None:
    """Databases of schema 0008 are in use. To change a table, write it as it was into the migration
    that makes it, which takes that of today, and the change into another."""
    tables = [str(CreateTable(table)) for table in metadata.sorted_tables]
    indexes = [str(CreateIndex(i)) for table in metadata.sorted_tables for i in table.indexes]
    digest = hashlib.sha256("".join(sorted(tables + indexes)).encode()).hexdigest()
    assert digest.startswith("fd0b35c44016f7ae")


def test_a_database_of_an_unknown_schema_is_left_alone(database: Database) -> None:
    migrate(database)
    database.write(lambda c: c.execute(text("UPDATE alembic_version SET version_num='0005'")))
    with pytest.raises(InputError, match="0005, which this program does not know"):
        migrate(database)
    assert revision(database) == "0005"


def test_a_migration_keeps_a_copy_of_the_file(file: Database, tmp_path: Path) -> None:
    migrate(file, "0008")
    migrate(file)
    assert revision(file) == "0010"
    assert (tmp_path / "knitcore.sqlite3.before-0010").is_file()


def test_commits_are_flushed_to_disk(file: Database) -> None:
    with file.read() as connection:
        assert connection.exec_driver_sql("PRAGMA journal_mode").scalar() == "wal"
        assert connection.exec_driver_sql("PRAGMA synchronous").scalar() == 2  # FULL
        assert connection.exec_driver_sql("PRAGMA foreign_keys").scalar() == 1


@contextlib.asynccontextmanager
async def _inserting(database: Database, value: int) -> AsyncIterator[None]:
    """A change is being made while the block runs."""
    begun, go_on = threading.Event(), threading.Event()

    def change(connection: Connection) -> None:
        begun.set()
        go_on.wait(60)
        _insert(value)(connection)

    opening = asyncio.create_task(database.written(change))
    assert await asyncio.to_thread(begun.wait, 60)
    yield
    go_on.set()
    await opening


async def test_waiting_changes_share_a_commit_and_fail_alone(
    file: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(database_module, "BATCH_S", 60.0)
    database = file
    _table(database)
    commits: list[int] = []
    event.listen(database.engine, "commit", lambda _: commits.append(1))
    async with _inserting(database, 0):
        rest = [asyncio.create_task(database.written(_insert(n % 10))) for n in range(1, 15)]
        await asyncio.sleep(0)  # all of them have handed their change in
    outcomes = await asyncio.gather(*rest, return_exceptions=True)
    refused = [isinstance(outcome, IntegrityError) for outcome in outcomes]
    assert refused == [False] * 9 + [True] * 5  # 10 to 14 repeat 0 to 4
    assert _values(database) == list(range(10))
    assert len(commits) == 1


async def test_nobody_waits_for_all_changes_of_another(
    file: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(database_module, "BATCH_S", 0.0)
    _table(file)
    order: list[str] = []

    async def write(user: str) -> None:
        current_user.set(user)
        await file.written(lambda _: order.append(user))

    async with _inserting(file, 0):
        rest = [asyncio.create_task(write(user)) for user in ("ada", "ada", "ada", "bob")]
        await asyncio.sleep(0)
    await asyncio.gather(*rest)
    assert order == ["ada", "bob", "ada", "ada"]


async def test_a_change_whose_caller_has_gone_is_not_made(file: Database) -> None:
    database = file
    _table(database)
    async with _inserting(database, 1):
        with pytest.raises(TimeoutError):
            await asyncio.wait_for(database.written(_insert(2)), 0.05)
    await database.written(_insert(3))
    assert _values(database) == [1, 3]


def test_a_full_disk_refuses_only_what_does_not_fit(file: Database) -> None:
    """The file may not grow beyond some pages, as on a full disk."""
    database = file
    database.write(lambda c: c.execute(text("CREATE TABLE big (v BLOB)")))

    @event.listens_for(database.engine, "connect")
    def _(connection: Any, _record: Any) -> None:
        connection.execute("PRAGMA max_page_count=40")

    database.engine.dispose()

    def put(size: int) -> None:
        database.write(
            lambda c: c.execute(text("INSERT INTO big VALUES (zeroblob(:n))"), {"n": size})
        )

    put(10_000)
    with pytest.raises(StoreError, match="disk is full"):
        put(1_000_000)
    put(1_000)
    with database.read() as connection:
        assert connection.execute(text("SELECT count(*) FROM big")).scalar() == 2
        assert connection.exec_driver_sql("PRAGMA integrity_check").scalar() == "ok"


@pytest.mark.parametrize("kind", [DBAPIError, ProgrammingError])
def test_a_lost_connection_is_a_failure_of_the_database_whatever_ended_the_statement(
    sqlite_database: Database, kind: type[DBAPIError]
) -> None:
    for is_lost, error in ((True, StoreError), (False, kind)):
        cause = Exception("no result")
        with pytest.raises(error), sqlite_database.failures():
            raise kind("SELECT 1", None, cause, connection_invalidated=is_lost)


def test_reasons_reveal_no_addresses() -> None:
    url = "postgresql+psycopg://somebody:secret@127.0.0.1:9/none"
    with opened(url, migrated=False) as lost, pytest.raises(StoreError) as refused:
        lost.write(lambda c: c.execute(text("SELECT 1")))
    assert "secret" not in str(refused.value)
    assert "127.0.0.1" not in str(refused.value)


def test_pending_changes_are_written_before_closing(place: Path | str) -> None:
    with opened(place, migrated=False) as database, ThreadPoolExecutor(8) as threads:
        _table(database)
        list(threads.map(lambda n: database.write(_insert(n)), range(32)))
    with opened(place, migrated=False) as again:
        assert _values(again) == list(range(32))
