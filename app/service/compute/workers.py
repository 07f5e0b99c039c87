"""Jobs, the workers that run them, and the errors that end them without a result."""

import asyncio
import inspect
from collections.abc import Callable, Mapping
from typing import Protocol, TypeVar

from ..problems import UnavailableError, UnsolvedError

T = TypeVar("T")


class Worker(Protocol):
    """Runs one job at a time: a process here, or a share of a cluster."""

    async def submit(self, job: Callable[..., T]) -> asyncio.Future[T]:
        """Begin a job: a picklable function that checks ``cancelled`` regularly.

        If it has a parameter ``progress``, it may call that with (steps done, steps in all). All
        other arguments are bound.
        """
        ...

    @property
    def share(self) -> float | None:
        """Share of the job that is done, 0 to 1; None until it starts."""
        ...

    @property
    def cpu_s(self) -> float | None:
        """CPU seconds that the job took; None where that is not known."""
        ...

    def cancel(self) -> None:
        """Ask the job to stop."""
        ...

    def replace(self) -> None:
        """Stop the job by force and be ready for the next one."""
        ...

    def close(self) -> None:
        """Close the worker and drop its job."""
        ...


class AbandonedError(UnavailableError):
    """The result is no longer waited for; this error appears only in the log."""

    status = 499


class TimeLimitError(UnavailableError):
    """The computation exceeded its time limit."""

    headers: Mapping[str, str] = {}  # the same request would take as long again


class NotBegunError(UnavailableError):
    """Error: no worker began the computation; it can be requested again."""


class WorkerDiedError(UnavailableError):
    """The process of a computation ended without a result."""


class MemoryLimitError(UnsolvedError):
    """The computation exceeded its memory limit."""

    default_remedy = "Ask for less: a smaller chart or fewer steps."


def call(
    job: Callable[..., T],
    cancelled: Callable[[], bool],
    progress: Callable[[float, float], None],
    memory: str,
) -> T:
    """Run a job in this process; ``memory`` names the limit in an error message."""
    extra = {"progress": progress} if "progress" in inspect.signature(job).parameters else {}
    try:
        return job(cancelled=cancelled, **extra)
    except MemoryError:
        raise MemoryLimitError(f"The computation needs more than {memory}.") from None
