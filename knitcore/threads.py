"""One thread for small matrices.

A second BLAS thread only waits at the sizes of our blocks, and waiting threads burn the cores that
other work needs: measured, up to 200 times the time.
"""

from __future__ import annotations

from contextlib import AbstractContextManager
from functools import cache
from typing import Any

from threadpoolctl import ThreadpoolController


def one_blas_thread() -> AbstractContextManager[Any]:
    """A context in which BLAS uses one thread; the caller's setting is back afterwards."""
    limited: AbstractContextManager[Any] = _controller().limit(limits=1, user_api="blas")
    return limited


@cache
def _controller() -> ThreadpoolController:
    """Looking for the loaded libraries takes longer than a small solve, so it is done once."""
    return ThreadpoolController()
