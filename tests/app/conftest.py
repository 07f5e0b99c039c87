from __future__ import annotations

import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient

from app.service.main import create_app
from app.service.settings import Settings
from app.service.store.database import Database
from app.service.store.schema import migrate
from app.service.store.tables import metadata
from tests.app.databases import postgres, postgres_programs


@pytest.fixture(scope="session")
def client() -> Iterator[TestClient]:
    """A client of the running service on loopback."""
    app = create_app(Settings(workers=1))
    with TestClient(app, base_url="http://127.0.0.1", raise_server_exceptions=False) as client:
        yield client


@pytest.fixture(scope="session")
def schema(client: TestClient) -> dict[str, Any]:
    """The OpenAPI schema of the service."""
    document: dict[str, Any] = client.get("/openapi.json").json()
    return document


@pytest.fixture(scope="session")
def postgres_url() -> Iterator[str]:
    if postgres_programs() is None:
        pytest.skip("PostgreSQL is not installed here")
    with tempfile.TemporaryDirectory(prefix="knit-pg-", dir="/tmp") as folder:
        Path(folder).chmod(0o711)  # the server runs as another user
        with postgres(Path(folder)) as url:
            yield url


@pytest.fixture(params=["sqlite", pytest.param("postgresql", marks=pytest.mark.postgres)])
def database(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Database]:
    """The same tests on both databases; ``make test-hard`` runs those on PostgreSQL."""
    if request.param == "sqlite":
        url = f"sqlite:///{tmp_path / 'knit.sqlite3'}"
    else:
        url = request.getfixturevalue("postgres_url")
    database = Database(url)
    migrate(database)
    yield database
    if request.param == "postgresql":
        with database.engine.begin() as connection:
            for table in reversed(metadata.sorted_tables):
                connection.execute(table.delete())
    database.close()
