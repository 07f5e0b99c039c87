"""The time that a reader of a file may take.

Readers refuse files that are too large, but a small one can keep its reader busy as well: a photo
of noise, or a workbook that unpacks to a thousand times its size. So a reader is stopped where it
is once it has used :data:`READING_S` of CPU time, which is the same on a machine that does much
else. A second thread raises an exception in it; a call of compiled code ends first.
"""

import ctypes
import queue
import threading
import time
from collections.abc import Callable
from functools import partial, wraps
from pathlib import Path
from typing import Any, ParamSpec, TypeVar

from knitcore.base.errors import InputError

READING_S = 10.0
AGAIN_S = 1.0
"""CPU time after which a reader that caught the exception gets it again."""
LOOK_S = 0.01
"""Least time between two looks at the clock."""

Given = ParamSpec("Given")
Result = TypeVar("Result")
_here = threading.local()


class ReadingTimeError(InputError):
    """A reader has used up its time."""


class _OutOfTime(BaseException):
    """Ends a reader; no handler of errors takes it for one of the file's."""


def in_reading_time(read: Callable[Given, Result]) -> Callable[Given, Result]:
    """A reader that refuses what takes it too long, with :class:`ReadingTimeError`.

    Its first argument is a path, or something else with a name. Readers that it calls share its
    time.
    """

    @wraps(read)
    def limited(*args: Given.args, **named: Given.kwargs) -> Result:
        if getattr(_here, "is_reading", False):
            return read(*args, **named)
        watch = _Watch()
        try:
            _here.is_reading = True
            try:
                return read(*args, **named)
            finally:
                watch.end()
        except _OutOfTime:
            watch.end()
            file: Any = next(iter((*args, *named.values())))
            problem = f"takes more than {READING_S:g} s to read."
            remedy = "Give a smaller or simpler file, with nothing in it but what is to be read."
            raise ReadingTimeError(
                Path(getattr(file, "name", file)).name, problem, remedy
            ) from None
        finally:
            _here.is_reading = False

    return limited


class _Watch:
    """Raises :class:`_OutOfTime` in the thread that makes it, until it is ended."""

    def __init__(self) -> None:
        self._reader = ctypes.c_ulong(threading.get_ident())
        self._used_s = _clock()
        self._end_s = self._used_s() + READING_S
        self._ended: queue.SimpleQueue[None] = queue.SimpleQueue()
        self._thread = threading.Thread(target=self._watch, daemon=True, name="reading time")
        self._thread.start()

    def end(self) -> None:
        """Stop, and take back an exception that the reader has not met yet.

        One may come meanwhile: then this is called again.
        """
        self._ended.put(None)  # at once, unlike an event, whose lock an exception could leave held
        self._thread.join()
        _raise(self._reader, None)

    def _watch(self) -> None:
        while True:
            try:
                self._ended.get(timeout=max(self._end_s - self._used_s(), LOOK_S))
                return
            except queue.Empty:
                if (used := self._used_s()) >= self._end_s:
                    _raise(self._reader, ctypes.py_object(_OutOfTime))
                    self._end_s = used + AGAIN_S


def _clock() -> Callable[[], float]:
    """CPU time of this thread, for another one; that of the process where there is no such clock.

    A worker of a cluster may read in one thread while others compute.
    """
    if hasattr(time, "pthread_getcpuclockid"):
        return partial(time.clock_gettime, time.pthread_getcpuclockid(threading.get_ident()))
    return time.process_time


def _raise(thread: ctypes.c_ulong, error: Any) -> None:
    ctypes.pythonapi.PyThreadState_SetAsyncExc(thread, error)
