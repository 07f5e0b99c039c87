"""Jobs on a real Dask cluster: a scheduler and two worker processes on loopback."""

from __future__ import annotations

import asyncio
import gzip
import json
import os
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
import yaml

from app.context import Context
from app.operations.chart.curve import CurveRequest, CurveResult, curve
from app.service.compute import cluster as cluster_module
from app.service.compute import compute as compute_module
from app.service.compute.cluster import Cluster, ClusterError, ClusterWorker
from app.service.compute.compute import Compute
from app.service.compute.workers import AbandonedError, TimeLimitError, WorkerDiedError
from app.service.jobs.document import JobState
from app.service.jobs.runner import JobRunner
from app.service.jobs.store import JobStore
from app.service.store.database import Database
from app.service.store.schema import migrate
from knitcore import InputError
from knitcore.chart.fabric import Direction
from tests.app import jobs

ROOT = Path(__file__).resolve().parents[4]
COMPOSE: dict[str, Any] = yaml.safe_load((ROOT / "compose.yaml").read_text())


def _dask(name: str, folder: Path, *options: str, **changed: str) -> subprocess.Popen[bytes]:
    """What the compose file runs, with some of its words changed and options added."""
    service = COMPOSE["services"][name]
    program, *words = service["command"]
    assert program == "dask"
    command = [changed.get(word, word) for word in words]
    with (folder / f"{name}.log").open("w") as log:
        return subprocess.Popen(
            [sys.executable, "-m", "dask", *command, *options],
            env=os.environ | service["environment"] | {"PYTHONPATH": str(ROOT)},
            stdout=log,
            stderr=log,
        )


pytestmark = pytest.mark.slow  # a cluster takes seconds to start


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    folder = tmp_path_factory.mktemp("dask")
    file = folder / "scheduler.json"
    running = [
        _dask("scheduler", folder, "--host=127.0.0.1", "--port=0", f"--scheduler-file={file}")
    ]
    deadline = time.monotonic() + 60
    while not file.exists() or not file.read_text():
        assert time.monotonic() < deadline, (folder / "scheduler.log").read_text()
        time.sleep(0.05)
    found: str = json.loads(file.read_text())["address"]
    (scratch,) = COMPOSE["services"]["worker"]["tmpfs"]
    changed = {"tcp://scheduler:8786": found, scratch: str(folder)}
    running.append(_dask("worker", folder, **changed))
    yield found
    for process in reversed(running):
        process.terminate()
        process.wait(60)


@pytest.fixture(scope="module")
def compute(address: str) -> Iterator[Compute]:
    cluster = Cluster(address)
    yield Compute([ClusterWorker(cluster), ClusterWorker(cluster)], timeout_s=60.0)
    cluster.close()


async def never() -> bool:
    return False


def test_results_errors_and_progress_come_back(compute: Compute, tmp_path: Path) -> None:
    assert asyncio.run(compute.run(never, jobs.add, 2, 3)) == 5
    with pytest.raises(InputError, match="Use less"):
        asyncio.run(compute.run(never, jobs.refuse))
    assert jobs.shares_told_of(compute, tmp_path, 4) == [0.0, 0.25, 0.5, 0.75, 1.0]


def test_a_job_of_the_service_is_done_there(compute: Compute, tmp_path: Path) -> None:
    request = CurveRequest(chart="K\nP", material="acrylic", direction=Direction.WALE)
    database = Database(f"sqlite:///{tmp_path / 'knit.sqlite3'}")
    migrate(database)

    async def scenario() -> bytes | None:
        runner = JobRunner(JobStore(database, "main"), jobs.answers(compute, tmp_path), 150.0)
        job = (await runner.submit("ada", "curve", request.model_dump_json())).id
        while not (status := await runner.status("ada", job)).state.is_final:
            await asyncio.sleep(0.02)
        assert status.state is JobState.DONE, status.problem
        return runner.store.result("ada", job)

    answer = asyncio.run(scenario())
    database.close()
    assert answer is not None
    assert CurveResult.model_validate_json(gzip.decompress(answer)) == curve(
        request, Context(tmp_path)
    )


def test_an_abandoned_job_and_one_beyond_its_time_are_stopped(
    compute: Compute, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(compute_module, "GRACE_S", 60.0)
    mark = tmp_path / "mark"
    begun: list[float] = []

    async def told(share: float) -> None:
        begun.append(share)

    async def once_begun() -> bool:
        return bool(begun)

    with pytest.raises(AbandonedError):
        asyncio.run(compute.run(once_begun, jobs.until_cancelled, str(mark), on_share=told))
    assert mark.read_text() == "stopped"
    mark.unlink()
    with pytest.raises(TimeLimitError):
        asyncio.run(compute.run(never, jobs.until_cancelled, str(mark), timeout_s=0.2))
    assert mark.read_text() == "stopped"


def test_a_job_whose_worker_is_killed_is_retried(compute: Compute, tmp_path: Path) -> None:
    """The other worker goes on with its own job, and takes this one over."""
    mark, done = tmp_path / "mark", tmp_path / "done"

    async def both() -> tuple[str, int]:
        other = asyncio.create_task(compute.run(never, jobs.until_told, str(done), "alive"))
        retried = await compute.run(never, jobs.die_once, str(mark))
        done.touch()
        return await other, retried

    alive, process = asyncio.run(both())
    assert alive == "alive"
    assert mark.exists()
    assert process != os.getpid()


def test_a_job_that_kills_its_workers_fails_alone(compute: Compute) -> None:
    with pytest.raises(WorkerDiedError, match="lost"):
        asyncio.run(compute.run(never, jobs.die))
    assert asyncio.run(compute.run(never, jobs.add, 20, 22)) == 42


def test_a_job_that_does_not_stop_loses_only_its_process(
    compute: Compute, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(compute_module, "GRACE_S", 0.2)
    with pytest.raises(TimeLimitError):
        asyncio.run(compute.run(never, jobs.stubborn, 600.0, timeout_s=0.2))
    pair = asyncio.run(_two(compute))
    assert pair == [4, 6]


async def _two(compute: Compute) -> list[int]:
    """Both workers are free again."""
    runs = (compute.run(never, jobs.add, n, n) for n in (2, 3))
    return await asyncio.gather(*runs)


def test_a_lost_cluster_is_reported_and_found_again(
    address: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    cluster = Cluster("tcp://127.0.0.1:9")
    compute = Compute([ClusterWorker(cluster)], timeout_s=60.0)
    monkeypatch.setattr(cluster_module, "CONNECT_S", 0.5)
    with pytest.raises(ClusterError, match="cannot be reached"):
        asyncio.run(compute.run(never, jobs.add, 1, 1))
    monkeypatch.setattr(cluster_module, "CONNECT_S", 60.0)
    monkeypatch.setattr(cluster, "address", address)
    assert asyncio.run(compute.run(never, jobs.add, 1, 1)) == 2
    cluster.close()
