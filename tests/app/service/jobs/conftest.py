from collections.abc import Iterator

import pytest

from app.service.compute.compute import Compute
from app.service.compute.processes import processes
from app.service.jobs.kinds import KINDS
from tests.app.jobs import WORK


@pytest.fixture(autouse=True)
def _kind(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setitem(KINDS, "work", WORK)


@pytest.fixture(scope="package")
def compute() -> Iterator[Compute]:
    pool = Compute(processes(2), timeout_s=60)
    yield pool
    pool.close()
