"""Runners of jobs in tests, and ways to wait for their jobs."""

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path

from app.service.compute.compute import Compute
from app.service.jobs.document import JobState, JobStatus
from app.service.jobs.runner import JobRunner
from app.service.jobs.store import JobStore
from app.service.store.database import Database
from tests.app.jobs import Task, answers

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
    return JobRunner(JobStore(database, name), answers(compute, folder or Path()), timeout_s)


def task(what: str, mark: Path | str = "/nonexistent") -> str:
    """The request of a job of the kind ``work``."""
    return Task(what=what, mark=str(mark)).model_dump_json()


async def until(true: Callable[[], Awaitable[bool]]) -> None:
    """Wait until something is true."""
    async with asyncio.timeout(PATIENCE_S):
        while not await true():
            await asyncio.sleep(0.02)


async def ended(runner: JobRunner, job: str, owner: str = "ada") -> JobStatus:
    """The state of a job once it has ended."""

    async def is_final() -> bool:
        return (await runner.status(owner, job)).state.is_final

    await until(is_final)
    return await runner.status(owner, job)


async def running(runner: JobRunner, job: str) -> None:
    """Wait until a job runs."""

    async def is_running() -> bool:
        return (await runner.status("ada", job)).state is JobState.RUNNING

    await until(is_running)


async def counted(runner: JobRunner, state: str, count: int) -> None:
    """Wait until so many jobs wait, or run."""

    async def is_reached() -> bool:
        return runner.counts()[state] == count

    await until(is_reached)
