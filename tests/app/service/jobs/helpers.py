"""Runners of jobs in tests, and ways to wait for their jobs."""

import asyncio
from collections.abc import Callable
from pathlib import Path

from app.service.compute.answers import Answers, RecentResults
from app.service.compute.compute import Compute
from app.service.jobs.document import JobState, JobStatus
from app.service.jobs.runner import JobRunner
from app.service.jobs.store import JobStore
from app.service.store.database import Database
from app.service.store.material_store import MaterialStore
from tests.app.jobs import Task

PATIENCE_S = 150.0
"""For a worker that starts, or answers, on a machine that is busy."""


def runner_of(
    database: Database,
    compute: Compute,
    name: str = "main",
    *,
    timeout_s: float = 60.0,
    folder: Path | None = None,
) -> JobRunner:
    """A runner of the jobs of a process."""
    answers = Answers(compute, RecentResults(), folder or Path(), MaterialStore(database))
    return JobRunner(JobStore(database, name), answers, timeout_s)


def task(what: str, mark: Path | str = "/nonexistent") -> str:
    """The request of a job of the kind ``work``."""
    return Task(what=what, mark=str(mark)).model_dump_json()


async def until(true: Callable[[], object]) -> None:
    """Wait until something is true."""
    async with asyncio.timeout(PATIENCE_S):
        while not true():
            await asyncio.sleep(0.02)


async def status_when(
    runner: JobRunner, job: str, true: Callable[[JobStatus], bool], owner: str = "ada"
) -> JobStatus:
    """Wait until something is true of the state of a job, and return the state."""
    async with asyncio.timeout(PATIENCE_S):
        while not true(status := await runner.status(owner, job)):
            await asyncio.sleep(0.02)
    return status


async def ended(runner: JobRunner, job: str) -> JobStatus:
    """The state of a job once it has ended."""
    return await status_when(runner, job, lambda status: status.state.is_final)


async def running(runner: JobRunner, job: str) -> None:
    """Wait until a job runs."""
    await status_when(runner, job, lambda status: status.state is JobState.RUNNING)


async def counted(runner: JobRunner, state: str, count: int) -> None:
    """Wait until so many jobs wait, or run."""
    await until(lambda: runner.counts()[state] == count)
