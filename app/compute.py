"""Heavy work in processes: the event loop stays free, and what nobody waits for is stopped."""

from __future__ import annotations

import asyncio
import logging
import multiprocessing
import os
import threading
from collections.abc import Awaitable, Callable
from concurrent.futures import ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from typing import Any, Protocol, TypeVar

from app.problems import UnavailableError

log = logging.getLogger("knitcore.app")
T = TypeVar("T")
R_co = TypeVar("R_co", covariant=True)

POLL_S = 0.25
GRACE_S = 3.0
"""How long a job may take to notice that it was cancelled before its process is stopped."""


class Job(Protocol[R_co]):
    """A picklable function that looks at ``cancelled`` now and then."""

    def __call__(self, *args: Any, cancelled: Callable[[], bool]) -> R_co:
        """Do the work."""
        ...


class Compute:
    """A pool of worker processes.

    Parameters
    ----------
    workers : number of processes; as many jobs again may wait, times four, before new ones are
        refused.
    timeout_s : longest run of one job.
    """

    def __init__(self, workers: int, timeout_s: float) -> None:
        self._workers = workers
        self._timeout_s = timeout_s
        self._context = multiprocessing.get_context("spawn")
        self._slots = list(range(workers * 5))
        self._flags = self._context.Array("b", len(self._slots), lock=False)
        self._pool = self._new_pool()

    def warm_up(self, job: Job[Any], *args: Any) -> None:
        """Start the processes and let them load what the first user would wait for."""
        for _ in range(self._workers):
            self._pool.submit(_run, None, job, args)

    async def run(
        self,
        abandoned: Callable[[], Awaitable[bool]],
        job: Callable[..., T],
        *args: Any,
    ) -> T:
        """Run a job; stop it when ``abandoned`` says that nobody waits any more.

        Raises
        ------
        UnavailableError
            If too many jobs wait, the job takes too long, or its process dies.
        """
        if not self._slots:
            raise UnavailableError("Too many computations are waiting.")
        slot = self._slots.pop()
        self._flags[slot] = 0
        pool = self._pool
        try:
            future = asyncio.wrap_future(pool.submit(_run, slot, job, args))
            deadline = asyncio.get_running_loop().time() + self._timeout_s
            while True:
                done, _ = await asyncio.wait([future], timeout=POLL_S)
                if done:
                    return future.result()
                late = asyncio.get_running_loop().time() > deadline
                if late or await abandoned():
                    await self._stop(slot, future, pool)
                    raise UnavailableError(
                        f"The computation took longer than {self._timeout_s:g} s."
                        if late
                        else "The computation was abandoned."
                    )
        except BrokenProcessPool as error:
            self._renew(pool)
            raise UnavailableError("The process of this computation died.") from error
        finally:
            self._slots.append(slot)

    def close(self) -> None:
        """Cancel everything and end the processes."""
        for slot in range(len(self._flags)):
            self._flags[slot] = 1
        self._pool.shutdown(wait=False, cancel_futures=True)

    async def _stop(
        self, slot: int, future: asyncio.Future[Any], pool: ProcessPoolExecutor
    ) -> None:
        self._flags[slot] = 1
        done, _ = await asyncio.wait([future], timeout=GRACE_S)
        if done:
            future.exception()  # retrieved: it was cancelled on purpose
            return
        log.warning("a cancelled computation did not stop; its processes are replaced")
        self._renew(pool, kill=True)

    def _renew(self, broken: ProcessPoolExecutor, *, kill: bool = False) -> None:
        if self._pool is not broken:
            return  # somebody else has replaced it already
        self._pool = self._new_pool()
        if kill:
            for process in list((broken._processes or {}).values()):
                process.terminate()
        broken.shutdown(wait=False, cancel_futures=True)

    def _new_pool(self) -> ProcessPoolExecutor:
        return ProcessPoolExecutor(
            self._workers, mp_context=self._context, initializer=_adopt, initargs=(self._flags,)
        )


_flags: Any = None


def _adopt(flags: Any) -> None:
    """In a worker: remember where the cancellation flags are."""
    global _flags  # noqa: PLW0603 - the pool's initializer has no other place
    _flags = flags
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    """A killed service cannot tell its workers to stop; they would wait for work for ever."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def _run(slot: int | None, job: Callable[..., T], args: tuple[Any, ...]) -> T:
    def cancelled() -> bool:
        return slot is not None and bool(_flags[slot])

    return job(*args, cancelled=cancelled)
