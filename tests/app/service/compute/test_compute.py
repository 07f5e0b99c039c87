"""Work in processes: results, errors, cancelling, limits, dying workers and turns."""

from __future__ import annotations

import asyncio
import contextlib
import os
import signal
import tempfile
import threading
from asyncio import Future
from collections.abc import Iterator
from concurrent.futures.process import _ExecutorManagerThread
from functools import partial
from pathlib import Path

import pytest

from app.service.compute import compute as compute_module
from app.service.compute.compute import Compute
from app.service.compute.processes import NICENESS, SCRATCH, processes
from app.service.compute.workers import (
    AbandonedError,
    MemoryLimitError,
    NotBegunError,
    TimeLimitError,
    WorkerDiedError,
)
from app.service.problems import UnavailableError
from knitcore import InputError
from tests.app import jobs

PATIENCE_S = 120.0
"""For a worker that starts, or answers, on a machine that is busy."""


@pytest.fixture
def compute() -> Iterator[Compute]:
    pool = Compute(processes(1), timeout_s=PATIENCE_S)
    yield pool
    pool.close()


async def never() -> bool:
    return False


async def at_once() -> bool:
    return True


def test_results_and_errors_come_back(compute: Compute) -> None:
    assert asyncio.run(compute.run(never, jobs.add, 2, 3)) == 5
    assert 0 < (compute.workers[0].cpu_s or 0) < 30
    with pytest.raises(InputError, match="Use less"):
        asyncio.run(compute.run(never, jobs.refuse))


def test_an_abandoned_job_is_stopped_and_the_next_one_runs(
    compute: Compute, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(compute_module, "GRACE_S", PATIENCE_S)
    mark = tmp_path / "mark"
    with pytest.raises(AbandonedError):
        asyncio.run(compute.run(at_once, jobs.until_cancelled, str(mark)))
    assert mark.read_text() == "stopped"
    assert asyncio.run(compute.run(never, jobs.add, 1, 1)) == 2


def test_a_job_beyond_its_time_is_stopped(compute: Compute) -> None:
    asyncio.run(compute.run(never, jobs.add, 1, 1))
    with pytest.raises(TimeLimitError, match=r"longer than 0\.1 s"):
        asyncio.run(compute.run(never, jobs.until_cancelled, "/dev/null", timeout_s=0.1))


def test_a_job_that_does_not_stop_loses_only_its_process(
    compute: Compute, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(compute_module, "GRACE_S", 0.2)
    with pytest.raises(AbandonedError):
        asyncio.run(compute.run(at_once, jobs.stubborn, 60.0))
    assert asyncio.run(compute.run(never, jobs.add, 4, 4)) == 8


def test_a_job_stays_within_its_memory() -> None:
    compute = Compute(processes(1, memory_bytes=1_000_000_000), timeout_s=PATIENCE_S)
    try:
        with pytest.raises(MemoryLimitError, match="1 GB"):
            asyncio.run(compute.run(never, jobs.eat, 2_000_000_000))
        assert asyncio.run(compute.run(never, jobs.eat, 1_000)) == 1_000
    finally:
        compute.close()


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
    assert list(scratch.iterdir()) == []
    worker.close()
    assert list(tmp_path.iterdir()) == []


def test_a_closed_worker_leaves_no_thread_that_clears_up() -> None:
    """Python's exit could meet it, and write of that into the log."""
    workers = processes(6)

    async def closed() -> list[threading.Thread]:
        before = set(threading.enumerate())
        for worker in workers:
            job = await worker.submit(partial(jobs.stubborn, 60.0))
            job.add_done_callback(Future.exception)
        for worker in workers:
            worker.replace()
        for worker in workers:
            worker.close()
        left = set(threading.enumerate()) - before
        return [thread for thread in left if isinstance(thread, _ExecutorManagerThread)]

    assert asyncio.run(closed()) == []


def test_a_worker_that_dies_loses_only_its_own_job(tmp_path: Path) -> None:
    compute = Compute(processes(2), timeout_s=PATIENCE_S)
    mark = tmp_path / "mark"

    async def both() -> str:
        other = asyncio.create_task(compute.run(never, jobs.until_told, str(mark), "alive"))
        with pytest.raises(WorkerDiedError, match="died"):
            await compute.run(never, jobs.die)
        assert await compute.run(never, jobs.add, 20, 22) == 42
        mark.touch()
        return await other

    try:
        assert asyncio.run(both()) == "alive"
    finally:
        compute.close()


def test_a_worker_killed_while_idle_loses_nothing() -> None:
    compute = Compute(processes(1), timeout_s=PATIENCE_S)
    os.kill(asyncio.run(compute.run(never, jobs.pid)), signal.SIGKILL)
    with contextlib.suppress(NotBegunError):  # it may be asked before its death is known
        assert asyncio.run(compute.run(never, jobs.add, 1, 2)) == 3
    assert asyncio.run(compute.run(never, jobs.add, 1, 2)) == 3
    compute.close()


def test_progress_is_reported_from_zero_upwards(compute: Compute, tmp_path: Path) -> None:
    assert jobs.shares_told_of(compute, tmp_path, 4) == [0.0, 0.25, 0.5, 0.75, 1.0]


def test_too_many_waiting_jobs_are_refused(compute: Compute, tmp_path: Path) -> None:
    mark = str(tmp_path / "mark")

    async def crowd() -> list[str | BaseException]:
        tasks = [
            asyncio.create_task(compute.run(never, jobs.until_told, mark, str(n))) for n in range(6)
        ]
        refused, _ = await asyncio.wait(
            tasks, timeout=PATIENCE_S, return_when=asyncio.FIRST_COMPLETED
        )
        assert [type(t.exception()) for t in refused] == [UnavailableError]
        Path(mark).touch()
        return await asyncio.gather(*tasks, return_exceptions=True)

    outcome = asyncio.run(crowd())
    assert [o for o in outcome if isinstance(o, str)] == ["0", "1", "2", "3", "4"]


@pytest.mark.skipif(not hasattr(os, "SCHED_IDLE"), reason="only Linux knows idle processes")
@pytest.mark.parametrize("idle", [True, False])
def test_workers_run_at_low_priority(idle: bool) -> None:
    compute = Compute(processes(1, idle=idle), timeout_s=PATIENCE_S)
    try:
        policy, niceness = asyncio.run(compute.run(never, jobs.priority))
    finally:
        compute.close()
    assert (policy == os.SCHED_IDLE) is idle
    assert niceness == max(NICENESS, os.nice(0))
