"""Jobs on a real Dask cluster: a scheduler and two worker processes on loopback."""

import asyncio
import os
from collections.abc import Iterator
from pathlib import Path

import pytest

from app.context import Context
from app.operations.chart.curve import CurveRequest, CurveResult, curve
from app.service.compute import cluster as cluster_module
from app.service.compute.cluster import Cluster, ClusterError, ClusterWorker
from app.service.compute.compute import Compute
from app.service.compute.workers import WorkerDiedError
from app.service.jobs.document import JobState
from app.service.store.database import Database
from knitcore.chart.fabric import Direction
from scripts.composition import COMPOSE, dask
from tests.app import jobs
from tests.app.clusters import scheduler
from tests.app.jobs import never
from tests.app.service.compute.contract import WorkerContract
from tests.app.service.jobs.helpers import ended, runner_of

pytestmark = pytest.mark.slow  # a cluster takes seconds to start


@pytest.fixture(scope="module")
def address(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    folder = tmp_path_factory.mktemp("dask")
    (scratch,) = COMPOSE["services"]["worker"]["tmpfs"]
    with scheduler(folder) as address:
        changed = {"tcp://scheduler:8786": address, scratch: str(folder)}
        with dask("worker", folder, changed):
            yield address


@pytest.fixture(scope="module")
def compute(address: str) -> Iterator[Compute]:
    """A service's view of the cluster that waits for a worker, however busy the machine is."""
    cluster = Cluster(address)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(cluster_module, "CONNECT_S", 600.0)
        patch.setattr(cluster_module, "WORKERS_S", 600.0)
        yield Compute([ClusterWorker(cluster), ClusterWorker(cluster)], timeout_s=600.0)
    cluster.close()


class TestCluster(WorkerContract):
    pass


async def test_a_job_of_the_service_is_done_there(
    sqlite_database: Database, compute: Compute, tmp_path: Path
) -> None:
    request = CurveRequest(chart="K\nP", material="acrylic", direction=Direction.WALE)
    runner = runner_of(sqlite_database, compute, folder=tmp_path)
    job = (await runner.submit("ada", "curve", request.model_dump_json())).id
    status = await ended(runner, job)
    assert status.state is JobState.DONE, status.problem
    answer = runner.store.result("ada", job)
    assert answer is not None
    assert CurveResult.model_validate_json(b"".join(answer.unpacked())) == curve(
        request, Context(tmp_path)
    )


async def test_a_job_whose_worker_is_killed_is_retried(compute: Compute, tmp_path: Path) -> None:
    """The other worker goes on with its own job, and takes this one over."""
    mark, done = tmp_path / "mark", tmp_path / "done"
    other = asyncio.create_task(compute.run(never, jobs.until_told, str(done), "alive"))
    process = await compute.run(never, jobs.die_once, str(mark))
    done.touch()
    assert await other == "alive"
    assert mark.exists()
    assert process != os.getpid()


async def test_a_job_that_kills_its_workers_fails_alone(compute: Compute) -> None:
    with pytest.raises(WorkerDiedError, match="lost"):
        await compute.run(never, jobs.die)
    runs = (compute.run(never, jobs.add, n, n) for n in (2, 3))
    assert await asyncio.gather(*runs) == [4, 6]  # both workers are free again


async def test_a_lost_cluster_is_reported_and_found_again(
    address: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    cluster = Cluster("tcp://127.0.0.1:9")
    compute = Compute([ClusterWorker(cluster)], timeout_s=60.0)
    monkeypatch.setattr(cluster_module, "CONNECT_S", 0.5)
    with pytest.raises(ClusterError, match="cannot be reached"):
        await compute.run(never, jobs.add, 1, 1)
    monkeypatch.setattr(cluster_module, "CONNECT_S", 60.0)
    monkeypatch.setattr(cluster, "address", address)
    assert await compute.run(never, jobs.add, 1, 1) == 2
    cluster.close()
