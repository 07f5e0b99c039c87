import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient

from app.context import Context
from app.service.store.database import Database
from app.service.store.tables import metadata
from scripts.composition import postgres_programs
from tests.app.clients import served
from tests.app.databases import empty, opened, postgres


@pytest.fixture(scope="session")
def anyio_backend() -> str:
    """Loop of asynchronous tests."""
    return "asyncio"


@pytest.fixture(scope="session")
def client() -> Iterator[TestClient]:
    """A client of the running service on loopback."""
    with served() as client:
        yield client


@pytest.fixture(scope="session")
def schema(client: TestClient) -> dict[str, Any]:
    """The OpenAPI schema of the service."""
    document: dict[str, Any] = client.get("/openapi.json").json()
    return document


@pytest.fixture
def context(tmp_path: Path) -> Context:
    """The surroundings of an operation without a service."""
    return Context(tmp_path)


@pytest.fixture(scope="session")
def postgres_url() -> Iterator[str]:
    if postgres_programs() is None:
        pytest.skip("PostgreSQL is not installed here")
    with tempfile.TemporaryDirectory(prefix="knit-pg-", dir="/tmp") as folder:
        Path(folder).chmod(0o711)  # the server runs as another user
        with postgres(Path(folder)) as url:
            yield url


@pytest.fixture
def sqlite_database(tmp_path: Path) -> Iterator[Database]:
    with opened(tmp_path) as database:
        yield database


@pytest.fixture
def postgres_database(postgres_url: str) -> Iterator[Database]:
    with opened(postgres_url) as database:
        yield database
        with database.engine.begin() as connection:
            for table in reversed(metadata.sorted_tables):
                connection.execute(table.delete())


BOTH = ["sqlite", pytest.param("postgres", marks=pytest.mark.postgres)]
"""The same tests on both databases; ``make test-hard`` runs those on PostgreSQL."""


MOSTLY_SQLITE = ["sqlite", pytest.param("postgres", marks=[pytest.mark.postgres, pytest.mark.slow])]
"""Both databases, for tests that hardly depend on which, or wait for it often."""


@pytest.fixture(params=BOTH)
def database(request: pytest.FixtureRequest) -> Database:
    """An empty database with its tables."""
    database: Database = request.getfixturevalue(f"{request.param}_database")
    return database


@pytest.fixture(params=BOTH)
def place(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Path | str]:
    """Where there is no database yet: a folder, or the URL of an empty one."""
    if request.param == "sqlite":
        yield tmp_path
    else:
        with empty(request.getfixturevalue("postgres_url")) as url:
            yield url
