"""Jobs for the tests of the workers, which import them by name."""

import os
import signal
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any
from unittest.mock import patch

from pydantic import BaseModel

from app.context import Context
from app.operations.perform import perform
from app.operations.registry import Operation
from app.requests.base import read
from knitcore import InputError
from knitcore.base import reading_time
from knitcore.base.reading_time import in_reading_time
from knitcore.formats.read import chart_files
from knitcore.formats.read.chart_files import PieceInFile


async def never() -> bool:
    """Return that nobody has given a job up."""
    return False


def add(a: int, b: int, *, cancelled: Callable[[], bool]) -> int:
    return a + b


def priority(*, cancelled: object) -> tuple[int, int]:
    """Scheduling policy and niceness of the worker."""
    return os.sched_getscheduler(0), os.nice(0)


def refuse(*, cancelled: Callable[[], bool]) -> None:
    raise InputError("strain", "is too much.", "Use less.")


def until_cancelled(mark: str, *, cancelled: Callable[[], bool]) -> str:
    while not cancelled():
        time.sleep(0.01)
    Path(mark).write_text("stopped")
    return "stopped"


def until_told(mark: str, name: str, *, cancelled: Callable[[], bool]) -> str:
    """Ends when there is a file ``mark``."""
    while not Path(mark).exists() and not cancelled():
        time.sleep(0.01)
    return name


def climb(folder: str, steps: int, *, cancelled: object, progress: Callable[..., None]) -> int:
    """Reports each step until there is a file named after it."""
    for step in range(steps + 1):
        while not Path(folder, str(step)).exists():
            progress(step, steps)
            time.sleep(0.01)
    return steps


def stubborn(seconds: float, *, cancelled: Callable[[], bool]) -> None:
    time.sleep(seconds)


@in_reading_time
def spin(file: Path) -> PieceInFile:
    """A reader that never ends."""
    while True:
        pass


def read_endlessly(*, cancelled: Callable[[], bool]) -> None:
    with patch.object(reading_time, "READING_S", 0.1):
        spin(Path("endless.ks"))


def spin_over_knitspeak() -> None:
    """From now on, reading a file of KnitSpeak never ends by itself, and is ended soon."""
    reading_time.READING_S = 1.0
    chart_files._READERS[".ks"] = spin


def die(*, cancelled: Callable[[], bool]) -> None:
    os._exit(3)


def eat(size: int, *, cancelled: Callable[[], bool]) -> int:
    return len(bytearray(size))


def process_id(*, cancelled: Callable[[], bool]) -> int:
    return os.getpid()


def temporary_folder(*, cancelled: Callable[[], bool]) -> str:
    with tempfile.TemporaryFile():
        return tempfile.gettempdir()


class Task(BaseModel):
    """Request of the jobs of these tests."""

    what: str = "answer"
    mark: str = "/nonexistent"


class Answer(BaseModel):
    """Answer of the jobs of these tests."""

    value: int


def work(task: Task, context: Context) -> Answer:
    """An operation that does what it is told."""
    context.progress(1, 4)
    if task.what == "die":
        os.kill(os.getpid(), signal.SIGKILL)
    if task.what == "fail":
        raise ValueError("a mistake of ours")
    while task.what == "wait" and not Path(task.mark).exists():
        if context.cancelled():
            break
        time.sleep(0.01)
    return Answer(value=42)


WORK = Operation(work, tag="tests", summary="Work", job=True)


def die_once(mark: str, *, cancelled: Callable[[], bool], progress: Callable[..., None]) -> int:
    """Is killed in mid-job the first time; the second time it ends."""
    progress(1, 2)
    if not Path(mark).exists():
        Path(mark).touch()
        os.kill(os.getpid(), signal.SIGKILL)
    return os.getpid()


def killed_in_the_middle(kind: str, run: Any, *job: Any, progress: Any, **options: Any) -> Any:
    """Call ``perform``, but kill the process while it works on an operation of a kind.

    It dies when the operation first looks whether it was cancelled; one that is too short to look
    dies before it can answer.
    """
    from app.service.jobs.kinds import KINDS  # takes a second, and workers import this module

    if run is not KINDS[kind].run:
        return perform(run, *job, progress=progress, **options)

    def kill(*_: Any) -> bool:
        os.kill(os.getpid(), signal.SIGKILL)
        return False

    model, request, supplies = job
    decoded = read(model, request) if isinstance(request, bytes) else request
    run(decoded, supplies.context(cancelled=kill))
    return kill()
