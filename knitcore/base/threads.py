"""One thread for small matrices.

At the sizes of these blocks a second BLAS thread only waits, and waiting threads occupy cores that
other work needs: computations were up to 200 times slower.
"""

import os
import threading
from collections.abc import Callable
from contextlib import AbstractContextManager
from functools import cache, wraps
from typing import Any, ParamSpec, TypeVar

from threadpoolctl import ThreadpoolController

Result = TypeVar("Result")
Given = ParamSpec("Given")


def side_by_side(first: Callable[[], Result], second: Callable[[], Result]) -> list[Result]:
    """Results of two functions that work in two threads where there are two cores.

    Only useful for compiled code that releases the interpreter's lock. Exceptions of the functions
    are raised here, the first one's before the second one's.
    """
    if (os.cpu_count() or 1) < 2:
        return [first(), second()]
    results: list[Result] = []
    errors: list[BaseException] = []

    def work() -> None:
        try:
            results.append(second())
        except BaseException as error:
            errors.append(error)

    thread = threading.Thread(target=work)
    thread.start()
    try:
        results_of_first = first()
    finally:
        thread.join()
    if errors:
        raise errors[0]
    return [results_of_first, *results]


def on_halves(work: Callable[[Any], Result], of: Any, least: int) -> list[Result]:
    """Result of a function on a sequence; on either half, in two threads, from ``least`` items."""
    if len(of) < least:
        return [work(of)]
    half = len(of) // 2
    return side_by_side(lambda: work(of[:half]), lambda: work(of[half:]))


def one_blas_thread() -> AbstractContextManager[Any]:
    """A context in which BLAS uses one thread; the caller's setting is restored afterwards."""
    limited: AbstractContextManager[Any] = _controller().limit(limits=1, user_api="blas")
    return limited


def in_one_blas_thread(work: Callable[Given, Result]) -> Callable[Given, Result]:
    """A function during whose calls BLAS uses one thread."""

    @wraps(work)
    def limited(*args: Given.args, **named: Given.kwargs) -> Result:
        with one_blas_thread():
            return work(*args, **named)

    return limited


@cache
def _controller() -> ThreadpoolController:
    """The controller of the loaded libraries; finding them takes longer than a small solve."""
    return ThreadpoolController()
