"""Heavy work outside the event loop; abandoned computations are stopped."""

import asyncio
import logging
from collections.abc import Awaitable, Callable, Sequence
from concurrent.futures.process import BrokenProcessPool
from functools import partial
from typing import Any, TypeVar

from ..identity import current_user
from ..limits.fair_queue import FairQueue
from ..limits.user_limits import USER_LIMITS, CpuTimeLimit
from .workers import AbandonedError, NotBegunError, TimeLimitError, Worker, WorkerDiedError

log = logging.getLogger("knitcore.compute")
T = TypeVar("T")

POLL_S = 0.05
"""Period in which a computation that nobody waits for is noticed."""
GRACE_S = 3.0
"""Time in which a job must notice that it was cancelled before its process is stopped."""
START_S = 120.0
"""Time in which a job must start: a new process loads, a cluster looks for a worker."""


class Compute:
    """Runs heavy work in a few workers, users taking turns.

    Parameters
    ----------
    workers : where jobs are done. Four times as many may wait in the foreground.
    timeout_s : longest run of one job, unless it is given another.
    most_each : workers that one user may hold at once; None is all of them.

    Attributes
    ----------
    spent : computing time of users.
    """

    def __init__(
        self, workers: Sequence[Worker], timeout_s: float, most_each: int | None = None
    ) -> None:
        self._timeout_s = timeout_s
        self.cpu_time = CpuTimeLimit()
        self.workers = list(workers)
        self.queue = FairQueue(
            self.workers,
            most_background=max(1, len(workers) - 1),
            most_waiting=4 * len(workers),
            most_waiting_each=USER_LIMITS.jobs,
            most_each=most_each,
        )

    async def run(
        self,
        abandoned: Callable[[], Awaitable[bool]],
        job: Callable[..., T],
        *args: Any,
        owner: str | None = None,
        background: bool = False,
        timeout_s: float | None = None,
        on_share: Callable[[float], Awaitable[None]] | None = None,
    ) -> T:
        """Run a job; stop it when ``abandoned`` returns true.

        Parameters
        ----------
        owner : whose turn it takes; by default the user of the request.
        background : whether requests of pages come first.
        timeout_s : longest run, from its start.
        on_share : awaited with the share done, with 0 when the job starts.

        Raises
        ------
        AbandonedError, TimeLimitError, WorkerDiedError, MemoryLimitError
        NotBegunError
            If no worker was free, or none began, in time.
        UnavailableError
            If too many wait already, or the cluster cannot be reached.
        OverLimitError
            If the user's computing time is spent, or too many of the user's jobs wait.
        """
        limit = self._timeout_s if timeout_s is None else timeout_s
        owner = owner or current_user.get()
        self.cpu_time.check(owner)
        queued = self.queue.enter(owner, background=background)
        entered = asyncio.get_running_loop().time()
        try:
            while not (await asyncio.wait([queued.place], timeout=POLL_S))[0]:
                if await abandoned():
                    raise AbandonedError("The computation was abandoned.")
                if not background and asyncio.get_running_loop().time() > entered + self._timeout_s:
                    raise NotBegunError(f"No worker was free for {self._timeout_s:g} s.")
            worker = queued.place.result()
            self.cpu_time.check(owner)  # jobs of the same user may have run meanwhile
            begun = asyncio.get_running_loop().time()
            future = await _begun(worker, partial(job, *args))
            try:
                return await self._watch(worker, future, abandoned, limit, on_share)
            finally:
                lasted = asyncio.get_running_loop().time() - begun
                self.cpu_time.spend(owner, lasted if worker.cpu_s is None else worker.cpu_s)
        finally:
            self.queue.leave(queued)

    async def _watch(
        self,
        worker: Worker,
        future: asyncio.Future[T],
        abandoned: Callable[[], Awaitable[bool]],
        limit_s: float,
        on_share: Callable[[float], Awaitable[None]] | None,
    ) -> T:
        loop = asyncio.get_running_loop()
        begun, deadline, share = loop.time(), None, -1.0
        try:
            while not (await asyncio.wait([future], timeout=POLL_S))[0]:
                if await abandoned():
                    raise AbandonedError("The computation was abandoned.")
                if (now := worker.share) is None:
                    if loop.time() > begun + START_S:
                        raise NotBegunError(f"No worker began within {START_S:g} s.")
                    continue
                deadline = deadline or loop.time() + limit_s
                if loop.time() > deadline:
                    raise TimeLimitError(f"The computation took longer than {limit_s:g} s.")
                if on_share is not None and now != share:
                    share = now
                    await on_share(share)
        except (AbandonedError, TimeLimitError, NotBegunError):
            await _stop(worker, future)
            raise
        except BaseException:
            future.add_done_callback(_forget)
            worker.replace()  # the task itself was cancelled: do not wait for the process
            raise
        try:
            return future.result()
        except BrokenProcessPool as error:
            log.warning("a worker process died")
            idle = worker.share is None
            worker.replace()
            if idle:
                raise NotBegunError("The worker died before it began.") from error
            raise WorkerDiedError("The process of this computation died.") from error

    def close(self) -> None:
        """Close all workers."""
        for worker in self.workers:
            worker.close()


def _forget(future: asyncio.Future[Any]) -> None:
    """Retrieve the outcome of a job that was stopped on purpose."""
    if not future.cancelled():
        future.exception()


async def _begun(worker: Worker, job: Callable[..., T]) -> asyncio.Future[T]:
    """Begin a job; if this is cancelled meanwhile, the worker is rid of it before it is free."""
    beginning = asyncio.ensure_future(worker.submit(job))
    try:
        return await asyncio.shield(beginning)
    except asyncio.CancelledError:
        await asyncio.wait([beginning])
        if beginning.exception() is None:
            beginning.result().add_done_callback(_forget)
            worker.replace()
        raise


async def _stop(worker: Worker, future: asyncio.Future[Any]) -> None:
    future.add_done_callback(_forget)
    worker.cancel()
    done, _ = await asyncio.wait([future], timeout=GRACE_S)
    if not done:
        log.warning("a cancelled computation did not stop; its process is replaced")
        worker.replace()
        await asyncio.wait([future], timeout=GRACE_S)
