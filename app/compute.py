"""Heavy work in processes: the event loop stays free, and what nobody waits for is stopped.

Every worker is a process of its own: one that dies, hangs or eats its memory costs one job.
"""

from __future__ import annotations

import asyncio
import inspect
import logging
import multiprocessing
import os
import resource
import threading
from collections.abc import Awaitable, Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from enum import IntEnum
from typing import Any, Protocol, TypeVar

from app.identity import current_user
from app.problems import ServiceError, UnavailableError
from app.turns import Turns

log = logging.getLogger("knitcore.compute")
T = TypeVar("T")
R_co = TypeVar("R_co", covariant=True)

POLL_S = 0.25
GRACE_S = 3.0
"""How long a job may take to notice that it was cancelled before its process is stopped."""
MEMORY_BYTES = 4_000_000_000
WAITING_EACH = 100


class Job(Protocol[R_co]):
    """A picklable function that looks at ``cancelled`` now and then.

    If it has a parameter ``progress``, it may call that with (steps done, steps in all).
    """

    def __call__(self, *args: Any, cancelled: Callable[[], bool]) -> R_co:
        """Do the work."""
        ...


class AbandonedError(UnavailableError):
    """Nobody waits for the result any more."""


class TimeLimitError(UnavailableError):
    """The computation took longer than it may."""


class WorkerDiedError(UnavailableError):
    """The process of a computation ended without a result."""


class MemoryLimitError(ServiceError):
    """The computation needs more memory than it may use."""

    status, type, title = 422, "unsolved", "No result was reached"
    default_remedy = "Ask for less: a smaller chart or fewer steps."


class Cell(IntEnum):
    """Places in the memory that a worker shares with the service."""

    CANCELLED = 0
    STARTED = 1
    DONE = 2
    OF = 3


class Worker:
    """One process, replaced when it is lost."""

    def __init__(self, context: Any, memory_bytes: int) -> None:
        self._context = context
        self._memory_bytes = memory_bytes
        self.cells = context.Array("d", len(Cell), lock=False)
        self._executor = self._new()

    def submit(self, job: Callable[..., T], args: tuple[Any, ...]) -> asyncio.Future[T]:
        """Begin a job."""
        self.cells[:] = [0.0] * len(Cell)
        try:
            return asyncio.wrap_future(self._executor.submit(_run, job, args))
        except BrokenProcessPool:  # it died while it had nothing to do
            self.replace()
            return asyncio.wrap_future(self._executor.submit(_run, job, args))

    def replace(self) -> None:
        """Stop the process, whatever it does, and have a new one for the next job."""
        lost, self._executor = self._executor, self._new()
        _kill(lost)

    def close(self) -> None:
        """End the process; nobody waits for what it does any more."""
        _kill(self._executor)

    def _new(self) -> ProcessPoolExecutor:
        return ProcessPoolExecutor(
            1,
            mp_context=self._context,
            initializer=_adopt,
            initargs=(self.cells, self._memory_bytes),
        )


class Compute:
    """Worker processes and whose turn it is.

    Parameters
    ----------
    workers : number of processes. Four times as many computations may wait in the foreground.
    timeout_s : longest run of one job, unless it is given another.
    memory_bytes : most memory of one process.
    """

    def __init__(self, workers: int, timeout_s: float, memory_bytes: int = MEMORY_BYTES) -> None:
        context = multiprocessing.get_context("spawn")
        self._timeout_s = timeout_s
        self.workers = [Worker(context, memory_bytes) for _ in range(workers)]
        self.turns = Turns(
            self.workers,
            most_background=max(1, workers - 1),
            most_waiting=4 * workers,
            most_waiting_each=WAITING_EACH,
        )

    def warm_up(self, job: Job[Any], *args: Any) -> None:
        """Start the processes and let them load what the first user would wait for."""
        for worker in self.workers:
            worker._executor.submit(_run, job, args)

    async def run(
        self,
        abandoned: Callable[[], Awaitable[bool]],
        job: Callable[..., T],
        *args: Any,
        owner: str | None = None,
        background: bool = False,
        timeout_s: float | None = None,
        told: Callable[[float], Awaitable[None]] | None = None,
    ) -> T:
        """Run a job; stop it when ``abandoned`` says that nobody waits any more.

        Parameters
        ----------
        owner : in whose turn; by default whoever asks.
        background : whether it may wait behind those who look at a page.
        timeout_s : longest run, from its start.
        told : awaited with the share done, with 0 when the job starts.

        Raises
        ------
        AbandonedError, TimeLimitError, WorkerDiedError, MemoryLimitError
        UnavailableError
            If too many wait already.
        """
        limit = self._timeout_s if timeout_s is None else timeout_s
        ticket = self.turns.enter(owner or current_user.get(), background=background)
        try:
            while not (await asyncio.wait([ticket.place], timeout=POLL_S))[0]:
                if await abandoned():
                    raise AbandonedError("The computation was abandoned.")
            worker = ticket.place.result()
            return await self._watch(worker, worker.submit(job, args), abandoned, limit, told)
        finally:
            self.turns.leave(ticket)

    async def _watch(
        self,
        worker: Worker,
        future: asyncio.Future[T],
        abandoned: Callable[[], Awaitable[bool]],
        limit_s: float,
        told: Callable[[float], Awaitable[None]] | None,
    ) -> T:
        loop = asyncio.get_running_loop()
        deadline, share = None, -1.0
        try:
            while not (await asyncio.wait([future], timeout=POLL_S))[0]:
                if await abandoned():
                    raise AbandonedError("The computation was abandoned.")
                if not worker.cells[Cell.STARTED]:
                    continue
                deadline = deadline or loop.time() + limit_s
                if loop.time() > deadline:
                    raise TimeLimitError(f"The computation took longer than {limit_s:g} s.")
                now = worker.cells[Cell.DONE] / max(worker.cells[Cell.OF], 1.0)
                if told is not None and now != share:
                    share = now
                    await told(share)
        except (AbandonedError, TimeLimitError):
            await _stop(worker, future)
            raise
        except BaseException:
            future.add_done_callback(_forget)
            worker.replace()  # nobody is left who could wait for the process to notice
            raise
        try:
            return future.result()
        except BrokenProcessPool as error:
            log.warning("a worker process died")
            worker.replace()
            raise WorkerDiedError("The process of this computation died.") from error

    def close(self) -> None:
        """End the processes."""
        for worker in self.workers:
            worker.close()


def _kill(executor: ProcessPoolExecutor) -> None:
    for process in list((executor._processes or {}).values()):
        process.kill()
    executor.shutdown(wait=False, cancel_futures=True)


def _forget(future: asyncio.Future[Any]) -> None:
    """Retrieve what came of a job that was stopped on purpose."""
    if not future.cancelled():
        future.exception()


async def _stop(worker: Worker, future: asyncio.Future[Any]) -> None:
    worker.cells[Cell.CANCELLED] = 1.0
    done, _ = await asyncio.wait([future], timeout=GRACE_S)
    if not done:
        log.warning("a cancelled computation did not stop; its process is replaced")
        worker.replace()
        await asyncio.wait([future])
    _forget(future)


_cells: Any = None
_memory_bytes = 0


def _adopt(cells: Any, memory_bytes: int) -> None:
    """In a worker: remember the shared memory, and take no more of anything than allowed."""
    global _cells, _memory_bytes
    _cells, _memory_bytes = cells, memory_bytes
    threading.Thread(target=_end_with_parent, daemon=True).start()
    os.nice(5)  # pages come before computations
    resource.setrlimit(resource.RLIMIT_DATA, (memory_bytes, memory_bytes))


def _end_with_parent() -> None:
    """A killed service cannot tell its workers to stop; they would wait for work for ever."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def _run(job: Callable[..., T], args: tuple[Any, ...]) -> T:
    cells = _cells
    cells[Cell.STARTED] = 1.0

    def cancelled() -> bool:
        return bool(cells[Cell.CANCELLED])

    def progress(done: float, of: float) -> None:
        cells[Cell.OF] = of
        cells[Cell.DONE] = done

    extra = {"progress": progress} if "progress" in inspect.signature(job).parameters else {}
    try:
        return job(*args, cancelled=cancelled, **extra)
    except MemoryError:
        raise MemoryLimitError(
            f"The computation needs more than the {_memory_bytes / 1e9:g} GB it may use."
        ) from None
