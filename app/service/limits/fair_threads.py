"""Threads that many users get one after the other."""

import threading
from collections import Counter
from collections.abc import Callable
from concurrent.futures import Future, ThreadPoolExecutor
from functools import partial
from typing import Any, TypeVar

from ..identity import current_user
from .turns import Turns

T = TypeVar("T")
Task = tuple[Future[Any], Callable[[], Any]]


class FairThreads(ThreadPoolExecutor):
    """A pool for ``asyncio.to_thread`` whose threads are given to users in turn.

    In the line of an ordinary pool everybody waits behind all that one user has asked for.

    Parameters
    ----------
    threads : how many there are.
    most_each : how many of them one user may hold at once.
    """

    def __init__(self, threads: int, most_each: int) -> None:
        super().__init__(threads, "service")
        self._most_each = most_each
        self._tasks = Turns[Task]()
        self._held: Counter[str] = Counter()
        self._turns = threading.Lock()

    def submit(self, function: Callable[..., T], /, *args: Any, **more: Any) -> Future[T]:
        """Let the present user stand in line."""
        future = Future[T]()
        with self._turns:
            self._tasks.add(current_user.get(), (future, partial(function, *args, **more)))
        super().submit(self._work)
        return future

    def _work(self) -> None:
        """Do what is in turn, as long as there is something: threads that came while all users in
        line held as many as they may have left."""
        while (task := self._next()) is not None:
            owner, (future, function) = task
            try:
                if future.set_running_or_notify_cancel():
                    future.set_result(function())
            except BaseException as error:  # it belongs to who waits for it
                future.set_exception(error)
            with self._turns:
                self._held -= Counter([owner])
            del task, future, function  # a thread that waits keeps no results

    def _next(self) -> tuple[str, Task] | None:
        with self._turns:
            task = self._tasks.next(lambda owner: self._held[owner] < self._most_each)
            if task is not None:
                self._held[task[0]] += 1
            return task
