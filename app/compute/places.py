"""What can be computed elsewhere, where it is done, and how it can end without a result."""

from __future__ import annotations

import asyncio
import inspect
from collections.abc import Callable
from typing import Any, ClassVar, Protocol, TypeVar

from app.http.problems import ServiceError, UnavailableError

T = TypeVar("T")
R_co = TypeVar("R_co", covariant=True)


class Job(Protocol[R_co]):
    """A picklable function that looks at ``cancelled`` now and then.

    If it has a parameter ``progress``, it may call that with (steps done, steps in all).
    """

    def __call__(self, *args: Any, cancelled: Callable[[], bool]) -> R_co:
        """Do the work."""
        ...


class Place(Protocol):
    """Where one job at a time is done: a process here, or a share of a cluster."""

    async def submit(self, job: Callable[..., T]) -> asyncio.Future[T]:
        """Begin a job, whose arguments but ``cancelled`` and ``progress`` are bound."""
        ...

    @property
    def share(self) -> float | None:
        """How much of the job is done, 0 to 1; None until it starts."""
        ...

    def cancel(self) -> None:
        """Ask the job to stop."""
        ...

    def replace(self) -> None:
        """Stop the job, whatever it does; the next one finds a place as new."""
        ...

    def close(self) -> None:
        """Let go of everything; nobody waits for what is done here any more."""
        ...


class AbandonedError(UnavailableError):
    """Nobody waits for the result any more."""


class TimeLimitError(UnavailableError):
    """The computation took longer than it may."""

    headers: ClassVar[dict[str, str]] = {}  # the same would take as long again


class NotBegunError(UnavailableError):
    """No worker took the computation on; it can be asked for again."""


class WorkerDiedError(UnavailableError):
    """The process of a computation ended without a result."""


class MemoryLimitError(ServiceError):
    """The computation needs more memory than it may use."""

    status, type, title = 422, "unsolved", "No result was reached"
    default_remedy = "Ask for less: a smaller chart or fewer steps."


def call(
    job: Callable[..., T],
    cancelled: Callable[[], bool],
    progress: Callable[[float, float], None],
    memory: str,
) -> T:
    """Do a job here; ``memory`` says in a problem how much it may use."""
    extra = {"progress": progress} if "progress" in inspect.signature(job).parameters else {}
    try:
        return job(cancelled=cancelled, **extra)
    except MemoryError:
        raise MemoryLimitError(f"The computation needs more than {memory}.") from None
