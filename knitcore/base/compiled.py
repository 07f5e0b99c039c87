"""Functions that numba compiles when they are first called.

The machine code is kept, beside the sources or in the folder ``NUMBA_CACHE_DIR``, so that a machine
compiles each function once. Until then the first call of a study takes seconds. Soon after that
the logger of this module says so, as a detail (``DEBUG``), for programs that have somebody waiting;
the record's attribute ``compiling`` is the module of the function that was called.
"""

import gc
import logging
import time
from collections.abc import Callable
from typing import Any, TypeVar

import numba
from numba.core import event

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
    made: Function = numba.njit(  # type: ignore[call-overload] # an option is not in its types
        function, cache=True, nogil=True, error_model="numpy", no_cfunc_wrapper=True
    )
    return made


class _Watch(event.Listener):
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


event.register("numba:compile", _Watch())  # type: ignore[no-untyped-call]
