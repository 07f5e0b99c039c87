from collections.abc import Iterator

import pytest

from app.service.compute.compute import Compute
from app.service.compute.processes import processes
from app.service.jobs.kinds import KINDS
from app.service.store.database import Database
from tests.app.conftest import MOSTLY_SQLITE
from tests.app.jobs import WORK


@pytest.fixture(autouse=True)
def _kind(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(KINDS, "work", WORK)


@pytest.fixture(scope="package")
def compute() -> Iterator[Compute]:
    pool = Compute(processes(2), timeout_s=60)
    yield pool
    pool.close()


@pytest.fixture(params=MOSTLY_SQLITE)
def database(request: pytest.FixtureRequest) -> Database:
    """An empty database with its tables; the runner waits so often that PostgreSQL is slow here."""
    database: Database = request.getfixturevalue(f"{request.param}_database")
    return database
