"""Threads in turn."""

import threading
from collections.abc import Callable
from contextvars import copy_context

import pytest

from app.service.identity import current_user
from app.service.limits.fair_threads import FairThreads


def _as(user: str, run: Callable[[], object]) -> object:
    def named() -> object:
        current_user.set(user)
        return run()

    return copy_context().run(named)


def test_nobody_waits_behind_all_that_another_asked_for() -> None:
    held, go_on, order = threading.Semaphore(0), threading.Event(), list[str]()

    def hold(name: str) -> str:
        held.release()
        go_on.wait(150)
        order.append(name)
        return name

    with FairThreads(3, most_each=2) as threads:
        ada = [_as("ada", lambda: threads.submit(hold, "ada")) for _ in range(9)]
        assert held.acquire(timeout=150)
        assert held.acquire(timeout=150)
        bob = _as("bob", lambda: threads.submit(str.upper, "bob"))
        assert bob.result(150) == "BOB"  # type: ignore[attr-defined]
        assert not held.acquire(timeout=0)
        go_on.set()
        assert {task.result(150) for task in ada} == {"ada"}  # type: ignore[attr-defined]
    assert len(order) == 9


def test_an_error_reaches_who_asked_and_a_cancelled_task_is_not_done() -> None:
    begun, go_on, done = threading.Event(), threading.Event(), list[int]()

    def hold() -> None:
        begun.set()
        go_on.wait(150)

    with FairThreads(1, most_each=1) as threads:
        threads.submit(hold)
        assert begun.wait(150)
        wrong, cancelled = threads.submit(int, "x"), threads.submit(done.append, 1)
        assert cancelled.cancel()
        go_on.set()
        with pytest.raises(ValueError, match="invalid literal"):
            wrong.result(150)
        assert threads.submit(int, "2").result(150) == 2
    assert done == []
