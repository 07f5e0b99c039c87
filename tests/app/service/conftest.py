from typing import Any

import pytest
from fastapi.testclient import TestClient

from tests.app.clients import state_of


@pytest.fixture
def computed(client: TestClient, monkeypatch: pytest.MonkeyPatch) -> list[tuple[Any, ...]]:
    """The jobs that workers were given, with their arguments."""
    compute, given = state_of(client).compute, list[tuple[Any, ...]]()
    run = compute.run

    async def noted(abandoned: Any, *job: Any, **turn: Any) -> Any:
        given.append(job)
        return await run(abandoned, *job, **turn)

    monkeypatch.setattr(compute, "run", noted)
    return given
