"""Work in processes: results, errors, cancelling, time limits and dying workers."""

from __future__ import annotations

import asyncio
from collections.abc import Iterator
from pathlib import Path

import pytest

from app import compute as compute_module
from app.compute import Compute
from app.problems import UnavailableError
from knitcore import InputError
from tests.app import jobs


async def never() -> bool:
    return False


async def at_once() -> bool:
    return True


@pytest.fixture
def compute() -> Iterator[Compute]:
    pool = Compute(workers=1, timeout_s=60.0)
    asyncio.run(pool.run(never, jobs.add, 0, 0))  # its process is up
    yield pool
    pool.close()


def test_results_and_errors_come_back(compute: Compute) -> None:
    assert asyncio.run(compute.run(never, jobs.add, 2, 3)) == 5
    with pytest.raises(InputError, match="Use less"):
        asyncio.run(compute.run(never, jobs.refuse))


def test_an_abandoned_job_is_stopped_and_the_next_one_runs(
    compute: Compute, tmp_path: Path
) -> None:
    mark = tmp_path / "mark"
    with pytest.raises(UnavailableError, match="abandoned"):
        asyncio.run(compute.run(at_once, jobs.until_cancelled, str(mark)))
    assert mark.read_text() == "stopped"
    assert asyncio.run(compute.run(never, jobs.add, 1, 1)) == 2


def test_a_job_beyond_its_time_is_stopped() -> None:
    compute = Compute(workers=1, timeout_s=0.3)
    try:
        with pytest.raises(UnavailableError, match=r"longer than 0\.3 s"):
            asyncio.run(compute.run(never, jobs.until_cancelled, "/dev/null"))
    finally:
        compute.close()


def test_a_stubborn_job_costs_its_process_only(
    compute: Compute, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(compute_module, "GRACE_S", 0.2)
    with pytest.raises(UnavailableError):
        asyncio.run(compute.run(at_once, jobs.stubborn, 60.0))
    assert asyncio.run(compute.run(never, jobs.add, 4, 4)) == 8


def test_a_worker_that_dies_costs_one_job(compute: Compute) -> None:
    with pytest.raises(UnavailableError, match="died"):
        asyncio.run(compute.run(never, jobs.die))
    assert asyncio.run(compute.run(never, jobs.add, 20, 22)) == 42


def test_too_many_waiting_jobs_are_refused(compute: Compute, tmp_path: Path) -> None:
    async def crowd() -> list[object]:
        waiting = [
            asyncio.create_task(
                compute.run(never, jobs.until_cancelled, str(tmp_path / str(number)))
            )
            for number in range(6)
        ]
        done, _ = await asyncio.wait(waiting, timeout=5, return_when=asyncio.FIRST_COMPLETED)
        outcome = [task.exception() for task in done]
        for slot in range(5):
            compute._flags[slot] = 1
        await asyncio.gather(*waiting, return_exceptions=True)
        return list(outcome)

    refused = asyncio.run(crowd())
    assert len(refused) == 1
    assert isinstance(refused[0], UnavailableError)
