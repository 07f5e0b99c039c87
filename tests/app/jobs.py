"""Jobs for the tests of the process pool; workers import them by name."""

from __future__ import annotations

import os
import time
from collections.abc import Callable
from pathlib import Path

from knitcore import InputError


def add(a: int, b: int, *, cancelled: Callable[[], bool]) -> int:
    return a + b


def refuse(*, cancelled: Callable[[], bool]) -> None:
    raise InputError("strain", "is too much.", "Use less.")


def until_cancelled(mark: str, *, cancelled: Callable[[], bool]) -> str:
    while not cancelled():
        time.sleep(0.01)
    Path(mark).write_text("stopped")
    return "stopped"


def stubborn(seconds: float, *, cancelled: Callable[[], bool]) -> None:
    time.sleep(seconds)


def die(*, cancelled: Callable[[], bool]) -> None:
    os._exit(3)


def process_id(*, cancelled: Callable[[], bool]) -> int:
    return os.getpid()
