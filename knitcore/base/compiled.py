"""Functions that numba compiles when they are first called.

The machine code is kept, beside the sources or in the folder ``NUMBA_CACHE_DIR``, so that a machine
compiles each function once. Until then the first call of a study takes seconds. Soon after that
the logger of this module says so, as a detail (``DEBUG``), for programs that have somebody waiting;
the record's attribute ``compiling`` is the module of the function that was called.
"""

from __future__ import annotations

import gc
import logging
import time
from collections.abc import Callable
from functools import cache, cached_property, update_wrapper
from typing import Any, TypeVar, cast

log = logging.getLogger(__name__)

COMPILING = "Compiling kernels for this processor (once, about 10 s) …"
TELL_AFTER_S = 0.3

Function = TypeVar("Function", bound=Callable[..., Any])


def compiled(function: Function) -> Function:
    """The function, compiled by numba when it is first called; it runs without the interpreter's
    lock.

    A division by zero gives infinity, as in numpy, no error. Neither a check for it nor an entry
    for C is compiled: both would cost time and are not used.
    """
    options = {"cache": True, "nogil": True, "error_model": "numpy", "no_cfunc_wrapper": True}
    return _made_later(function, lambda numba: numba.njit(function, **options))


def intrinsic(generate: Callable[..., Any]) -> Callable[..., Any]:
    """A function for compiled ones to call, whose machine code ``generate`` writes."""
    return _made_later(generate, lambda numba: numba.extending.intrinsic(generate))


class _Later:
    """A function that numba makes when it is first called: numba takes 0.3 s and 60 MB to load."""

    def __init__(self, function: Callable[..., Any], make: Callable[[Any], Any]) -> None:
        update_wrapper(self, function)
        self._make = make

    def __call__(self, *args: Any) -> Any:
        return self._made(*args)

    @cached_property
    def _made(self) -> Any:
        return self._make(_numba())

    @property
    def _numba_type_(self) -> Any:
        """The type that numba reads where compiled code calls this."""
        context = _numba().core.registry.cpu_target.typing_context
        made = self._made
        context.refresh()  # it learns of an intrinsic that was just made
        return context.resolve_value_type(made)


def _made_later(function: Function, make: Callable[[Any], Any]) -> Function:
    return cast("Function", _Later(function, make))


@cache
def _numba() -> Any:
    """Numba, which tells the watch what it compiles."""
    import numba
    from numba.core import event

    class Watch(_Watch, event.Listener):
        pass

    event.register("numba:compile", Watch())  # type: ignore[no-untyped-call]
    return numba


class _Watch:
    """Listener to numba's compiler: it says once that compiling takes time.

    It also pauses garbage collection, which would search numba's objects again and again and take
    a sixth of the time.
    """

    def __init__(self) -> None:
        self._depth = 0  # functions compile those that they call
        self._module = ""  # of the first function
        self._begun = self._spent_s = 0.0
        self._collects = self._announced = False

    def on_start(self, event: Any) -> None:
        """Note that a function is about to be compiled; numba compiles in one thread at a time."""
        if self._depth == 0:
            self._module = event.data["dispatcher"].py_func.__module__
            self._begun = time.perf_counter()
            self._collects = gc.isenabled()
            gc.disable()
        self._depth += 1
        self._tell()

    def on_end(self, event: Any) -> None:
        """Note that a function has been compiled, or could not be."""
        self._tell()
        self._depth -= 1
        if self._depth == 0:
            self._spent_s += time.perf_counter() - self._begun
            if self._collects:
                gc.enable()

    def _tell(self) -> None:
        spent_s = self._spent_s + time.perf_counter() - self._begun
        if spent_s > TELL_AFTER_S and not self._announced:
            self._announced = True
            log.debug(COMPILING, extra={"compiling": self._module})
