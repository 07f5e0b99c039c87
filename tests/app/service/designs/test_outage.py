"""A real database server that goes away and comes back."""

from __future__ import annotations

import pytest

from app.service.designs.document import DesignDocument
from app.service.designs.store import DesignStore
from app.service.problems import StoreError
from app.service.store.database import Database
from app.service.store.schema import migrate
from tests.app.databases import control

RIB = DesignDocument(name="Cuff", material="acrylic", chart="KPKP\nKPKP")


@pytest.mark.postgres
def test_a_server_that_was_away_is_found_again(postgres_url: str) -> None:
    database = Database(postgres_url)
    migrate(database)
    designs = DesignStore(database)
    kept = designs.create("outage", RIB)
    control(postgres_url, "-m", "immediate", "stop")
    try:
        with pytest.raises(StoreError, match="nothing was changed"):
            designs.create("outage", RIB)
        with pytest.raises(StoreError):
            designs.get("outage", kept.id)
    finally:
        control(postgres_url, "start")
    assert designs.get("outage", kept.id) == kept
    assert designs.create("outage", RIB).revision == 1
    database.close()
