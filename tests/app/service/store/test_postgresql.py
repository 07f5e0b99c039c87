"""The name of a process on PostgreSQL: watched, taken again, and respected if it is lost."""

import asyncio
from collections.abc import Iterator
from contextlib import ExitStack, closing, suppress
from pathlib import Path

import pytest
from sqlalchemy import Connection, event, text
from sqlalchemy.exc import DBAPIError

from app.service.compute.compute import Compute
from app.service.compute.processes import processes
from app.service.jobs import runner as runner_module
from app.service.jobs.document import JobState
from app.service.jobs.kinds import KINDS
from app.service.problems import DispossessedError, StoreError
from app.service.store import postgresql
from app.service.store.database import Database, holder
from app.service.store.postgresql import NameLock, PostgresqlServer
from knitcore.base.errors import InputError
from tests.app.clients import served
from tests.app.databases import away, control, opened
from tests.app.jobs import WORK
from tests.app.running import wait_until
from tests.app.service.jobs.helpers import counted, runner_of, running, task

pytestmark = pytest.mark.postgres


@pytest.fixture
def database(postgres_database: Database) -> Database:
    return postgres_database


@pytest.fixture
def second(postgres_url: str) -> Iterator[Database]:
    """The same database, as another process opens it."""
    with opened(postgres_url, migrated=False) as database:
        yield database


@pytest.fixture
def unwatched(monkeypatch: pytest.MonkeyPatch) -> None:
    """Nobody looks whether a name is still taken, except for the test."""
    monkeypatch.setattr(postgresql, "PING_S", 3600.0)


def _end_lock_of(database: Database) -> None:
    """The server ends the session that holds the lock."""
    held_by = text(
        "SELECT pg_terminate_backend(pid, 10000) FROM pg_locks WHERE locktype = 'advisory'"
    )
    with database.read() as connection:
        assert connection.execute(held_by).scalar() is True


@pytest.mark.parametrize(
    ("moment", "words"), [("begin", "nothing was changed"), ("commit", "may not have been made")]
)
def test_a_loss_says_what_came_of_the_change(database: Database, moment: str, words: str) -> None:
    def lose(connection: Connection) -> None:
        connection.exec_driver_sql("SELECT pg_terminate_backend(pg_backend_pid())")

    event.listen(database.engine, moment, lose)
    with pytest.raises(StoreError, match=words):
        database.write(lambda connection: connection.execute(text("SELECT 1")))
    event.remove(database.engine, moment, lose)


def test_a_restart_of_the_database_frees_no_name(
    database: Database, second: Database, postgres_url: str
) -> None:
    taken = pytest.raises(InputError, match="KNITCORE_PROCESS_NAME")
    with database.reserved("main"):
        control(postgres_url, "-m", "fast", "restart")
        wait_until(lambda: holder(postgres_url, "main"))  # the watch takes it again
        with taken, second.reserved("main"):
            pass
        database.check()
    assert holder(postgres_url, "main") is None


def test_who_only_asks_takes_no_name(
    database: Database, postgres_url: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A command that took it for a moment could be taken for another service."""
    with database.reserved("main"):
        monkeypatch.setattr(NameLock, "take", lambda _: pytest.fail("took it"))
        assert holder(postgres_url, "main") == "A service called 'main' runs on this database."
        assert holder(postgres_url, "another") is None


@pytest.mark.usefixtures("unwatched")
def test_readiness_takes_the_name_again(database: Database, postgres_url: str) -> None:
    with database.reserved("main"):
        with away(postgres_url), pytest.raises(StoreError):
            database.check()
        assert holder(postgres_url, "main") is None
        database.check()
        assert holder(postgres_url, "main") is not None


@pytest.mark.usefixtures("unwatched")
def test_a_lost_connection_of_our_own_is_no_other_service(
    database: Database, postgres_url: str
) -> None:
    """The server may go on holding the lock for a connection that this side has lost."""
    with database.reserved("main"):
        assert isinstance(database.backend, PostgresqlServer)
        lock = database.backend.name_lock
        assert lock is not None
        forgotten, lock._connection = lock._connection, None

        def is_taken_again() -> bool:
            database.check()
            return lock._connection is not None

        wait_until(is_taken_again)
        assert holder(postgres_url, "main") is not None
        assert forgotten is not None
        with suppress(DBAPIError):  # which the server has ended
            forgotten.close()


@pytest.mark.usefixtures("unwatched")
def test_a_service_whose_name_was_taken_stops(
    database: Database, second: Database, tmp_path: Path
) -> None:
    with ExitStack() as stack:
        stack.enter_context(database.reserved("main"))
        client = stack.enter_context(served(database=database, data_dir=tmp_path))
        assert client.get("/readyz").status_code == 200
        _end_lock_of(database)
        stack.enter_context(second.reserved("main"))
        answer = client.get("/readyz")
        assert (answer.status_code, "taken over" in answer.json()["detail"]) == (503, True)
        assert "KNITCORE_PROCESS_NAME" in answer.json()["remedy"]
        design = {"name": "x", "material": "acrylic", "chart": "KP"}
        assert client.post("/api/v1/designs", json=design).status_code == 503
        assert client.get("/api/v1/designs").status_code == 200
        second.check()


@pytest.mark.usefixtures("unwatched")
def test_jobs_stop_where_the_name_was_taken(
    database: Database, second: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(runner_module, "BEAT_S", 0.05)
    monkeypatch.setitem(KINDS, "work", WORK)

    async def scenario(compute: Compute) -> None:
        runner = runner_of(database, compute)
        await runner.resume()
        job = (await runner.submit("ada", "work", task("wait"))).id
        await running(runner, job)
        await asyncio.to_thread(_end_lock_of, database)
        stack.enter_context(second.reserved("main"))
        with pytest.raises(DispossessedError):
            await asyncio.to_thread(database.check)
        await counted(runner, "running", 0)
        assert (await runner.status("ada", job)).state is JobState.RUNNING  # nothing was written
        with pytest.raises(DispossessedError):
            await runner.submit("ada", "work", task("wait"))
        await runner.close()

    with ExitStack() as stack:
        compute = stack.enter_context(closing(Compute(processes(1), timeout_s=60)))
        stack.enter_context(database.reserved("main"))
        asyncio.run(scenario(compute))
