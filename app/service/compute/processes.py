"""Workers on this machine, a process each: one that dies, hangs or grows loses only its own job.

Workers are forked from a process that has loaded what they need
(:mod:`app.service.compute.loaded`), so one that is lost is replaced in milliseconds and all share
the memory of their modules.
"""

import asyncio
import contextlib
import multiprocessing
import os
import resource
import shutil
import tempfile
import threading
import time
from collections.abc import Callable
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from enum import IntEnum
from functools import cache
from multiprocessing import forkserver
from pathlib import Path
from typing import Any, TypeVar
from weakref import WeakSet

from knitcore.base.batch import end_with_parent

from .workers import call

T = TypeVar("T")

CONTEXT = multiprocessing.get_context("forkserver")
MEMORY_BYTES = 4_000_000_000
NICENESS = int(os.environ.get("KNITCORE_WORKER_NICENESS", "10"))
"""Nice value; leaves about a tenth of a busy core. Tests choose another, as they wait for workers
beside others that keep all cores busy."""


SCRATCH = "knitcore-worker-"
"""Prefix of folders for workers' temporary files, before the number of the service's process."""


def _nothing() -> None:
    """Do nothing: the default initializer of workers."""


class Slot(IntEnum):
    """Cells of the memory that a worker shares with the service."""

    CANCELLED = 0
    STARTED = 1
    DONE = 2
    OF = 3
    CPU_S = 4


class ProcessWorker:
    """One process, replaced when it is lost.

    Parameters
    ----------
    memory_bytes : most memory of the process.
    idle : whether it uses only idle time, on systems that support this (Linux).
    begin : called in the process at its start, picklable.
    """

    def __init__(
        self, memory_bytes: int, *, idle: bool = False, begin: Callable[[], object] = _nothing
    ) -> None:
        self._memory_bytes = memory_bytes
        self._idle = idle
        self._begin = begin
        self._scratch = Path(tempfile.mkdtemp(prefix=f"{SCRATCH}{os.getpid()}-"))
        self._slots = CONTEXT.Array("d", len(Slot), lock=False)
        self._executor = self._new()
        self._ending: WeakSet[threading.Thread] = WeakSet()

    async def submit(self, job: Callable[..., T]) -> asyncio.Future[T]:
        """Begin a job."""
        self._slots[:] = [0.0] * len(Slot)
        await asyncio.shield(asyncio.wrap_future(load()))
        return asyncio.wrap_future(await asyncio.to_thread(self._submit, job))

    def _submit(self, job: Callable[..., T]) -> Future[T]:
        try:
            return self._executor.submit(_run, job)
        except BrokenProcessPool:  # it died while it had nothing to do
            self.replace()
            return self._executor.submit(_run, job)

    @property
    def share(self) -> float | None:
        """Share of the job that is done, 0 to 1; None until it starts."""
        if not self._slots[Slot.STARTED]:
            return None
        return float(self._slots[Slot.DONE] / max(self._slots[Slot.OF], 1.0))

    @property
    def cpu_s(self) -> float | None:
        """CPU seconds that the job took; None if it was stopped by force."""
        return float(self._slots[Slot.CPU_S]) or None

    def cancel(self) -> None:
        """Ask the job to stop."""
        self._slots[Slot.CANCELLED] = 1.0

    def replace(self) -> None:
        """Kill the process; the next job gets a new one."""
        self._kill()
        self._executor = self._new()
        shutil.rmtree(self._scratch, ignore_errors=True)  # uploads that it was reading

    def close(self) -> None:
        """End the process, and wait for the threads that clear up after it and those before it.

        Python's exit wakes such threads, and fails where one closes its pipe at that moment.
        """
        self._kill()
        for thread in list(self._ending):
            thread.join()
        shutil.rmtree(self._scratch, ignore_errors=True)

    def _kill(self) -> None:
        executor = self._executor
        with executor._shutdown_lock:  # not while it starts a process
            started = executor._processes
            thread: Any = executor._executor_manager_thread
        executor.shutdown(wait=False, cancel_futures=True)
        if thread is not None:  # it has started a process
            self._ending.add(thread)
            for process in list(started.values()):
                process.kill()

    def _new(self) -> ProcessPoolExecutor:
        return ProcessPoolExecutor(
            1,
            mp_context=CONTEXT,
            initializer=_adopt,
            initargs=(self._slots, self._memory_bytes, self._idle, str(self._scratch), self._begin),
        )


def processes(
    count: int,
    memory_bytes: int = MEMORY_BYTES,
    *,
    idle: bool = False,
    begin: Callable[[], object] = _nothing,
) -> list[ProcessWorker]:
    """Several workers, each with a memory limit."""
    _sweep()
    return [ProcessWorker(memory_bytes, idle=idle, begin=begin) for _ in range(count)]


@cache
def load() -> Future[None]:
    """Start the process that workers are forked from; done once it has loaded what they need."""
    done: Future[None] = Future()
    forkserver.set_forkserver_preload([f"{__package__}.loaded"])

    def wait() -> None:
        try:
            CONTEXT.Process(target=_nothing, daemon=True).start()  # returns once it is forked
        finally:
            done.set_result(None)

    threading.Thread(target=wait, daemon=True, name="modules of workers").start()
    return done


def _sweep() -> None:
    """Remove temporary files of services that were killed."""
    for folder in Path(tempfile.gettempdir()).glob(f"{SCRATCH}*-*"):
        owner = folder.name.removeprefix(SCRATCH).partition("-")[0]
        if not Path(f"/proc/{owner}").exists():
            shutil.rmtree(folder, ignore_errors=True)


_slots: Any = None
_memory_bytes = 0


def _adopt(
    slots: Any, memory_bytes: int, idle: bool, scratch: str, begin: Callable[[], object]
) -> None:
    """Keep the shared memory and set the limits; runs in a worker."""
    global _slots, _memory_bytes
    _slots, _memory_bytes = slots, memory_bytes
    tempfile.tempdir = scratch
    begin()
    end_with_parent()
    _stand_back(idle)
    resource.setrlimit(resource.RLIMIT_DATA, (memory_bytes, memory_bytes))


def _stand_back(idle: bool) -> None:
    """Pages come before computations.

    A process that is only nice keeps a core until its time slice ends, some milliseconds, while a
    stroke waits; an idle one yields it at once.
    """
    if idle and hasattr(os, "SCHED_IDLE"):
        with contextlib.suppress(PermissionError):  # a sandbox may forbid it
            os.sched_setscheduler(0, os.SCHED_IDLE, os.sched_param(0))
            return
    be_nice()


def be_nice() -> None:
    """Lower this process's priority, unless it is as low already."""
    os.setpriority(os.PRIO_PROCESS, 0, max(NICENESS, os.nice(0)))


def _run(job: Callable[..., T]) -> T:
    # a cleaner of the machine may remove it, too
    Path(tempfile.gettempdir()).mkdir(mode=0o700, exist_ok=True)
    slots = _slots
    slots[Slot.STARTED] = 1.0

    def cancelled() -> bool:
        return bool(slots[Slot.CANCELLED])

    def progress(done: float, of: float) -> None:
        slots[Slot.OF] = of
        slots[Slot.DONE] = done

    begun = time.process_time()
    try:
        return call(job, cancelled, progress, f"the {_memory_bytes / 1e9:g} GB it may use")
    finally:
        slots[Slot.CPU_S] = time.process_time() - begun
