"""Many independent computations: on this machine, or unchanged on a Dask cluster.

A batch is a function and named tasks for it. Results are stored as one JSON document for each task,
so a batch that was stopped, even by force, continues where it left off.
"""

import json
import logging
import multiprocessing
import os
import re
import tempfile
import threading
from collections import Counter, deque
from collections.abc import Callable, Iterator, Mapping
from concurrent.futures import FIRST_COMPLETED, Executor, Future, ProcessPoolExecutor, wait
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing.process import BaseProcess
from pathlib import Path
from typing import Any, TypeVar

from knitcore.base.errors import Cancelled, CancelledError, InputError

log = logging.getLogger("knitcore.base.batch")

Task = TypeVar("Task")
Document = dict[str, Any]

LOOK_EVERY_S = 0.5
CONNECT_S = 10
MAX_LOSSES = 3
"""Give a task up after its process died this often: the task may be the cause."""
_KEY = re.compile(r"[A-Za-z0-9][A-Za-z0-9._+-]{0,119}")


@dataclass(frozen=True)
class BatchProgress:
    """Progress of a batch.

    Attributes
    ----------
    done : tasks that have ended, those of an earlier run included.
    total : all tasks.
    failed : those of `done` without a result.
    key : the task that ended last; empty before the first.
    """

    done: int
    total: int
    failed: int
    key: str


@dataclass(frozen=True)
class BatchResult:
    """The outcome of a batch.

    Attributes
    ----------
    results : a JSON document for each task that succeeded, in the order of the tasks.
    failures : the error of each of the others.
    """

    results: dict[str, Document]
    failures: dict[str, str]


def run_batch(
    function: Callable[[Task], Document],
    tasks: Mapping[str, Task],
    *,
    scheduler: str | None = None,
    workers: int | None = None,
    keep: Path | None = None,
    progress: Callable[[BatchProgress], None] | None = None,
    cancelled: Cancelled | None = None,
) -> BatchResult:
    """Call a function for every task.

    Parameters
    ----------
    function : importable by name; takes one picklable task and returns a JSON value.
    tasks : by key, begun in this order. With `keep`, a key must name everything that decides the
        result, because a result found under it is used as it is.
    scheduler : address of a Dask cluster (``"tcp://host:port"``); processes here if left out.
    workers : processes here, all cores if left out; 1 works in this process.
    keep : folder of finished results. Tasks that failed are tried again by the next run.
    progress : called after every task.
    cancelled : called about twice a second, or between tasks if they run in this process.

    Raises
    ------
    CancelledError
        If it was asked to stop; finished results are in `keep`.
    InputError
        If a key cannot name a file, or the cluster does not answer.
    """
    _check(tasks, scheduler, workers)
    folder = _Folder(keep)
    results = {key: kept for key in tasks if (kept := folder.read(key)) is not None}
    failures: dict[str, str] = {}

    def tell(key: str) -> None:
        if progress is not None:
            done = len(results) + len(failures)
            progress(BatchProgress(done, len(tasks), len(failures), key))

    def stop_if_asked() -> None:
        if cancelled is not None and cancelled():
            raise CancelledError(f"stopped after {len(results)} of {len(tasks)} tasks")

    tell("")
    left = {key: task for key, task in tasks.items() if key not in results}
    stop_if_asked()
    for key, outcome in _outcomes(function, left, scheduler, workers, stop_if_asked):
        if isinstance(outcome, Exception):
            log.warning("task %s failed: %s", key, outcome)
            failures[key] = f"{type(outcome).__name__}: {outcome}"
        else:
            folder.write(key, outcome)
            results[key] = outcome
        tell(key)
    return BatchResult({key: results[key] for key in tasks if key in results}, failures)


def _check(tasks: Mapping[str, Any], scheduler: str | None, workers: int | None) -> None:
    for key in tasks:
        if not _KEY.fullmatch(key):
            remedy = "Use up to 120 letters, digits and the signs . _ + -."
            raise InputError("tasks", f"{key!r} cannot name a file.", remedy)
    if workers is not None and workers < 1:
        raise InputError(
            "workers", f"{workers} is not a number of worker processes.", "Give at least 1."
        )
    if scheduler is not None and not re.fullmatch(r"(tcp|tls)://[^\s/]+:\d+", scheduler):
        raise InputError(
            "scheduler", f"{scheduler!r} is not an address.", "Give one like tcp://127.0.0.1:8786."
        )


def _outcomes(
    function: Callable[[Task], Document],
    tasks: Mapping[str, Task],
    scheduler: str | None,
    workers: int | None,
    look: Callable[[], None],
) -> Iterator[tuple[str, Document | Exception]]:
    """Every task with its outcome, as they end; `look` may raise between any two."""
    if scheduler is None and (workers == 1 or len(tasks) <= 1):
        for key, task in tasks.items():
            look()
            yield key, _attempt(function, task)
        return
    waiting = deque(tasks)
    losses: Counter[str] = Counter()
    while waiting:
        with _executor(scheduler, workers) as (executor, at_once):
            running: dict[Future[Document | Exception], str] = {}
            lost: list[str] = []
            while running or (waiting and not lost):
                while waiting and len(running) < at_once and not lost:
                    key = waiting.popleft()
                    running[executor.submit(_attempt, function, tasks[key])] = key
                ended, _ = wait(running, LOOK_EVERY_S, FIRST_COMPLETED)
                look()
                for future in ended:
                    key = running.pop(future)
                    error = future.exception()
                    if isinstance(error, BrokenProcessPool):
                        lost.append(key)
                    else:
                        yield key, error if isinstance(error, Exception) else future.result()
        for key in lost:  # one task ended the processes of all; each is tried again
            losses[key] += 1
            if losses[key] < MAX_LOSSES:
                waiting.appendleft(key)
            else:
                yield key, RuntimeError(f"its process was lost {MAX_LOSSES} times")


def _attempt(function: Callable[[Task], Document], task: Task) -> Document | Exception:
    """Failures are returned as outcomes, so that no traceback has to cross machines."""
    try:
        outcome = function(task)
        json.dumps(outcome, allow_nan=False)
    except Exception as error:
        return error
    return outcome


@contextmanager
def _executor(scheduler: str | None, workers: int | None) -> Iterator[tuple[Executor, int]]:
    """The executor, and the number of tasks that keeps all workers busy."""
    if scheduler is not None:
        with _cluster(scheduler) as cluster:
            yield cluster
        return
    count = workers or os.cpu_count() or 1
    executor = ProcessPoolExecutor(
        count, mp_context=multiprocessing.get_context("spawn"), initializer=end_with_parent
    )
    try:
        yield executor, 2 * count
    except BaseException:
        for process in list(executor._processes.values()):
            process.terminate()  # their results are not needed any more
        raise
    finally:
        executor.shutdown(cancel_futures=True)


def end_with_parent() -> None:
    """End this process when its parent is killed; it would otherwise wait for work for ever."""
    parent = multiprocessing.parent_process()
    if parent is not None:
        threading.Thread(target=_follow, args=(parent,), daemon=True).start()


def _follow(parent: BaseProcess) -> None:
    parent.join()
    os._exit(1)


@contextmanager
def _cluster(scheduler: str) -> Iterator[tuple[Executor, int]]:
    from distributed import Client

    try:
        client = Client(scheduler, timeout=CONNECT_S, set_as_default=False)
    except (OSError, TimeoutError, ValueError) as error:
        problem = f"no Dask scheduler answers at {scheduler} ({error})."
        remedy = "Start one with `dask scheduler`, or leave it out to work on this machine."
        raise InputError("scheduler", problem, remedy) from None
    with client:
        threads = sum(client.nthreads().values())
        executor = client.get_executor(retries=MAX_LOSSES - 1, pure=False)
        try:
            yield executor, max(8, 2 * threads)
        finally:
            executor.shutdown(wait=False)


class _Folder:
    """Finished results, one file each, written as a whole or not at all."""

    def __init__(self, path: Path | None) -> None:
        self._path = path
        if path is not None:
            try:
                path.mkdir(parents=True, exist_ok=True)
            except OSError as error:
                raise InputError("keep", f"{error}.", "Name a folder to write in.") from None

    def read(self, key: str) -> Document | None:
        if self._path is None:
            return None
        file = self._path / f"{key}.json"
        try:
            document: Document = json.loads(file.read_text(encoding="utf-8"))
        except FileNotFoundError:
            return None
        except ValueError:
            log.warning("%s is damaged and is computed again", file)
            return None
        return document

    def write(self, key: str, document: Document) -> None:
        if self._path is None:
            return
        handle, name = tempfile.mkstemp(dir=self._path, suffix=".part")
        try:
            with os.fdopen(handle, "w", encoding="utf-8") as stream:
                json.dump(document, stream, allow_nan=False)
            Path(name).replace(self._path / f"{key}.json")
        finally:
            Path(name).unlink(missing_ok=True)
