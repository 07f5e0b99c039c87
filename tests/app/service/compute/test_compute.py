"""Work in processes: results, errors, cancelling, limits, dying workers and turns."""

import asyncio
import contextlib
import os
import shutil
import signal
import tempfile
import threading
from asyncio import Future
from collections.abc import Iterator
from concurrent.futures.process import _ExecutorManagerThread
from contextlib import closing
from functools import partial
from pathlib import Path

import pytest

from app.service.compute import compute as compute_module
from app.service.compute.compute import Compute
from app.service.compute.processes import NICENESS, SCRATCH, ProcessWorker, processes
from app.service.compute.workers import MemoryLimitError, NotBegunError, WorkerDiedError
from app.service.problems import UnavailableError
from tests.app import jobs
from tests.app.jobs import never
from tests.app.service.compute.contract import WorkerContract

PATIENCE_S = 120.0
"""For a worker that starts, or answers, on a machine that is busy."""


@pytest.fixture
def compute() -> Iterator[Compute]:
    with closing(Compute(processes(1), timeout_s=PATIENCE_S)) as pool:
        yield pool


class TestProcesses(WorkerContract):
    pass


async def test_a_job_stays_within_its_memory() -> None:
    workers = processes(1, memory_bytes=1_000_000_000)
    with closing(Compute(workers, timeout_s=PATIENCE_S)) as compute:
        with pytest.raises(MemoryLimitError, match="1 GB"):
            await compute.run(never, jobs.eat, 2_000_000_000)
        assert await compute.run(never, jobs.eat, 1_000) == 1_000


def test_uploads_of_a_lost_worker_are_removed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path))
    killed = tmp_path / f"{SCRATCH}{2**22 + 1}-x"  # of a process that cannot be
    killed.mkdir()
    (worker,) = processes(1)
    (scratch,) = tmp_path.iterdir()
    upload = scratch / "knitcore-1"
    upload.mkdir()
    (upload / "secret.csv").touch()
    worker.replace()
    assert not upload.exists()
    worker.close()
    assert list(tmp_path.iterdir()) == []


async def test_a_worker_outlasts_a_cleaner_of_its_folder(compute: Compute) -> None:
    (worker,) = compute.workers
    assert isinstance(worker, ProcessWorker)
    for is_replaced in (False, True):
        shutil.rmtree(worker._scratch)
        if is_replaced:
            worker.replace()
        assert await compute.run(never, jobs.temporary_folder) == str(worker._scratch)


async def test_a_closed_worker_leaves_no_thread_that_clears_up() -> None:
    """Python's exit could meet it, and write of that into the log."""
    workers = processes(6)
    before = set(threading.enumerate())
    for worker in workers:
        job = await worker.submit(partial(jobs.stubborn, 60.0))
        job.add_done_callback(Future.exception)
    for worker in workers:
        worker.replace()
    for worker in workers:
        worker.close()
    left = set(threading.enumerate()) - before
    assert [thread for thread in left if isinstance(thread, _ExecutorManagerThread)] == []


async def test_a_worker_that_dies_loses_only_its_own_job(tmp_path: Path) -> None:
    mark = tmp_path / "mark"
    with closing(Compute(processes(2), timeout_s=PATIENCE_S)) as compute:
        other = asyncio.create_task(compute.run(never, jobs.until_told, str(mark), "alive"))
        with pytest.raises(WorkerDiedError, match="died"):
            await compute.run(never, jobs.die)
        assert await compute.run(never, jobs.add, 20, 22) == 42
        mark.touch()
        assert await other == "alive"


async def test_a_worker_killed_while_idle_loses_nothing(compute: Compute) -> None:
    os.kill(await compute.run(never, jobs.process_id), signal.SIGKILL)
    with contextlib.suppress(NotBegunError):  # it may be asked before its death is known
        assert await compute.run(never, jobs.add, 1, 2) == 3
    assert await compute.run(never, jobs.add, 1, 2) == 3
    assert 0 < (compute.workers[0].cpu_s or 0) < 30


async def test_too_many_waiting_jobs_are_refused(compute: Compute, tmp_path: Path) -> None:
    mark = tmp_path / "mark"
    tasks = [
        asyncio.create_task(compute.run(never, jobs.until_told, str(mark), str(n)))
        for n in range(6)
    ]
    refused, _ = await asyncio.wait(tasks, timeout=PATIENCE_S, return_when=asyncio.FIRST_COMPLETED)
    assert [type(t.exception()) for t in refused] == [UnavailableError]
    mark.touch()
    outcome = await asyncio.gather(*tasks, return_exceptions=True)
    assert [o for o in outcome if isinstance(o, str)] == ["0", "1", "2", "3", "4"]


@pytest.mark.skipif(not hasattr(os, "SCHED_IDLE"), reason="only Linux knows idle processes")
@pytest.mark.parametrize("idle", [True, False])
async def test_workers_run_at_low_priority(idle: bool) -> None:
    with closing(Compute(processes(1, idle=idle), timeout_s=PATIENCE_S)) as compute:
        policy, niceness = await compute.run(never, jobs.priority)
    assert (policy == os.SCHED_IDLE) is idle
    assert niceness == max(NICENESS, os.nice(0))


class _Nobody:
    """A place that takes jobs and never begins."""

    share = cpu_s = None

    async def submit(self, job: object) -> asyncio.Future[int]:
        self.future: asyncio.Future[int] = asyncio.get_running_loop().create_future()
        return self.future

    def cancel(self) -> None:
        self.future.cancel()

    replace = cancel


class _Slow:
    """A place that takes jobs slowly."""

    share = cpu_s = None

    def __init__(self) -> None:
        self.submitted, self.go_on = asyncio.Event(), asyncio.Event()
        self.replaced = 0

    async def submit(self, job: object) -> asyncio.Future[int]:
        self.submitted.set()
        await self.go_on.wait()
        return asyncio.get_running_loop().create_future()

    def replace(self) -> None:
        self.replaced += 1


async def test_a_place_is_free_once_it_has_dropped_a_job_cancelled_at_its_beginning() -> None:
    place = _Slow()
    compute = Compute([place], timeout_s=PATIENCE_S)  # type: ignore[list-item]
    running = asyncio.create_task(compute.run(never, print))
    await place.submitted.wait()
    running.cancel()
    await asyncio.sleep(0)
    assert (compute.queue.taken, place.replaced) == (1, 0)
    place.go_on.set()
    with pytest.raises(asyncio.CancelledError):
        await running
    assert (compute.queue.taken, place.replaced) == (0, 1)


async def test_waiting_ends(monkeypatch: pytest.MonkeyPatch) -> None:
    """For a worker that never begins, and for a place that is never free."""
    monkeypatch.setattr(compute_module, "START_S", 0.1)
    monkeypatch.setattr(compute_module, "POLL_S", 0.02)

    compute = Compute([_Nobody()], timeout_s=0.1)  # type: ignore[list-item]
    with pytest.raises(NotBegunError, match="No worker began"):
        await compute.run(never, print)
    compute.queue.enter("ada", background=False)
    with pytest.raises(NotBegunError, match="No worker was free"):
        await compute.run(never, print)
