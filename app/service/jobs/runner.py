"""Running jobs: one task each, which waits for its turn, computes, and stores the outcome."""

import asyncio
import contextlib
import logging
import secrets
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from ..compute.answers import Answers
from ..compute.workers import AbandonedError, NotBegunError
from ..designs.conditions import Retry
from ..limits.user_limits import CpuTimeSpentError
from ..periodic import repeated
from ..problems import DispossessedError, NotFoundError, Problem, ServiceError, StoreError
from ..web.bodies import SMALL_BYTES
from ..web.errors import problem_of
from .document import JobState, JobStatus
from .kinds import KINDS, job_key
from .store import JobStore

log = logging.getLogger("knitcore.jobs")

BEAT_S = 2.0
"""Interval at which processes exchange the state of their jobs and cancellations."""
BEATS_TO_LOOK_ROUND = 10
"""Number of them after which jobs of processes that are gone are looked for."""
AGAIN_S = 10.0
"""Wait before a job that no worker began is tried again."""
STORE_RETRY_S = (0.5, 2.0, 5.0, 10.0, 20.0)
"""Times for which a result waits for a database that is away."""


@dataclass(eq=False)
class _Run:
    task: asyncio.Task[None]
    owner: str
    progress: float = 0.0
    begun: bool = False
    cancelled: bool = False


class JobRunner:
    """The jobs of this service process.

    Parameters
    ----------
    store : jobs and results that survive a restart.
    answers : runs the operations.
    timeout_s : longest run of one job.
    """

    def __init__(self, store: JobStore, answers: Answers, timeout_s: float) -> None:
        self.store = store
        self._answers = answers
        self._compute = answers.compute
        self.timeout_s = timeout_s
        self._runs: dict[str, _Run] = {}
        self._stopping = False
        self._reading = asyncio.Lock()
        self._heart: asyncio.Task[None] | None = None
        self._beats = 0

    async def resume(self) -> None:
        """Resume waiting jobs after a start, and mark running ones as interrupted."""
        await self._go_on(await asyncio.to_thread(self.store.adopt))
        heart = repeated("sharing the state of jobs", self._beat, BEAT_S)
        self._heart = asyncio.create_task(heart, name="jobs of all processes")

    async def submit(
        self, owner: str, kind: str, request: str, retry: Retry | None = None
    ) -> JobStatus:
        """Add a job; if its result and its 3D data are stored, the job is finished at once.

        Raises
        ------
        OverLimitError
            If too many jobs of this owner wait.
        """
        key = await self._key_of(kind, request)
        known = await asyncio.to_thread(
            self.store.knows, key
        ) and await self._answers.can_be_viewed(KINDS[kind], request)
        state = JobState.DONE if known else JobState.WAITING
        if not known:
            self._compute.queue.check_room(owner, background=True)
        job = secrets.token_urlsafe(16)
        status = await asyncio.to_thread(
            self.store.add, owner, kind, request, key, state, job=job, retry=retry
        )
        if status.id != job:
            return await self.status(owner, status.id)
        if not known:
            self._start(status.id, owner, kind, request)
        return status

    async def _key_of(self, kind: str, request: str) -> str:
        """The key of a job's result, made by one thread: the first one reads the program's sources,
        and jobs that waited for it in threads would leave none to others."""
        async with self._reading:
            return await asyncio.to_thread(job_key, kind, request)

    async def again(self, owner: str, job: str) -> JobStatus:
        """Run the same job again."""
        kind, request = await asyncio.to_thread(self.store.request_of, owner, job)
        return await self.submit(owner, kind, request)

    async def status(self, owner: str, job: str) -> JobStatus:
        """A job with its progress."""
        status = await asyncio.to_thread(self.store.get, owner, job)
        run = self._runs.get(job)
        if run is not None and not status.state.is_final:
            status = status.model_copy(update={"progress": run.progress})
        return status

    async def cancel(self, owner: str, job: str) -> JobStatus:
        """Stop a job; one that has ended stays as it is."""
        await asyncio.to_thread(self.store.get, owner, job)
        run = self._runs.get(job)
        progress = None if run is None else run.progress
        await asyncio.to_thread(self.store.end, job, JobState.CANCELLED, progress=progress)
        if run is not None:
            run.cancelled = True
        return await self.status(owner, job)

    def owners(self) -> set[str]:
        """Owners of the jobs that wait or run here."""
        return {run.owner for run in self._runs.values()}

    async def cancel_all(self, owner: str) -> None:
        """Stop all jobs of an owner."""
        for job in [job for job, run in self._runs.items() if run.owner == owner]:
            with contextlib.suppress(NotFoundError):  # it is gone from the store
                await self.cancel(owner, job)

    def counts(self) -> dict[str, int]:
        """Numbers of waiting and running jobs of this process."""
        waiting = self._compute.queue.waiting(background=True)
        return {"waiting": waiting, "running": len(self._runs) - waiting}

    async def close(self) -> None:
        """Put running jobs back in the queue for the next start."""
        self._stopping = True
        tasks = [run.task for run in self._runs.values()]
        if self._heart is not None:
            tasks.append(self._heart)
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)

    async def _go_on(self, waiting: list[tuple[str, str]]) -> None:
        for job, owner in waiting:
            kind, request = await asyncio.to_thread(self.store.request_of, owner, job)
            self._start(job, owner, kind, request)

    async def _beat(self) -> None:
        """Exchange states with the other processes of this service."""
        try:
            shares = {job: run.progress for job, run in self._runs.items()}
            for job in await asyncio.to_thread(self.store.beat, shares):
                if job in self._runs:
                    self._runs[job].cancelled = True
            self._beats += 1
            if self._beats == BEATS_TO_LOOK_ROUND:
                self._beats = 0
                await self._go_on(await asyncio.to_thread(self.store.adopt_orphans))
        except ServiceError as error:
            log.warning("cannot share the state of the jobs of this process: %s", error)
            self._beats = 0  # after an outage, let the other processes report first
            if isinstance(error, DispossessedError):  # the jobs are another's now
                for run in self._runs.values():
                    run.cancelled = True

    def _start(self, job: str, owner: str, kind: str, request: str) -> None:
        task = asyncio.create_task(self._work(job, owner, kind, request), name=f"job {job}")
        self._runs[job] = _Run(task, owner)
        task.add_done_callback(lambda _: self._runs.pop(job, None))

    async def _work(self, job: str, owner: str, kind: str, request: str) -> None:
        run = self._runs[job]

        async def on_share(share: float) -> None:
            run.progress = min(share, 1.0)
            if not run.begun:
                run.begun = True
                await self._begin(job, run)

        async def abandoned() -> bool:
            return run.cancelled

        described = KINDS[kind]
        extra = {"job": job, "kind": kind}
        log.info("job waits", extra=extra)
        try:
            large = len(request) > SMALL_BYTES
            body = request.encode() if large else described.request.model_validate_json(request)
            answer = await self._begun(
                abandoned,
                described,
                body,
                owner=owner,
                background=True,
                timeout_s=self.timeout_s,
                on_share=on_share,
            )
            key = await self._key_of(kind, request)
            await self._keep(lambda: self.store.finish(job, kind, key, answer.body))
            log.info("job done", extra=extra)
        except asyncio.CancelledError:
            if self._stopping:
                await asyncio.to_thread(self.store.wait_again, job)
            raise
        except AbandonedError:
            log.info("job cancelled", extra=extra)
        except Exception as error:
            problem = problem_of(error)
            if not isinstance(error, ServiceError) and problem.status >= 500:
                log.exception("job failed unexpectedly", extra=extra)
            else:
                log.info("job failed: %s", problem.detail, extra=extra)
            await self._fail(job, problem)

    async def _begun(self, *args: Any, **turn: Any) -> Any:
        """Compute a job; one that no worker has started, or whose owner's computing time is spent,
        keeps waiting."""
        while True:
            try:
                return await self._answers.answer(*args, **turn)
            except (NotBegunError, CpuTimeSpentError) as error:
                log.warning("a job waits on: %s", error)
                await asyncio.sleep(AGAIN_S)

    async def _begin(self, job: str, run: _Run) -> None:
        try:
            waited = await asyncio.to_thread(self.store.begin, job)
        except StoreError as error:
            log.warning("the start of job %s could not be written down: %s", job, error)
        else:
            run.cancelled = run.cancelled or not waited  # cancelled through another process

    async def _fail(self, job: str, problem: Problem) -> None:
        try:
            await self._keep(lambda: self.store.end(job, JobState.FAILED, problem))
        except StoreError:
            log.exception("the end of job %s could not be written down", job)

    async def _keep(self, write: Callable[[], object]) -> None:
        """Write, and repeat while the database is away."""
        for pause in STORE_RETRY_S:
            try:
                await asyncio.to_thread(write)
            except StoreError as error:
                log.warning("a result waits for the database: %s", error)
                await asyncio.sleep(pause)
            else:
                return
        await asyncio.to_thread(write)
