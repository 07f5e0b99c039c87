"""Errors that the package raises on purpose.

KnitcoreError
├── InputError (also ValueError)   something the caller gave cannot be used; names field and remedy
├── ConvergenceError               a solver stopped short; says where and why
├── UnravelledError                a relaxation lost the topology of the stitch
└── CancelledError                 the caller asked to stop
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

Cancelled = Callable[[], bool]
"""Function that a long computation calls at times; True stops it with :class:`CancelledError`."""

Progress = Callable[[int, int], None]
"""Function that a long computation calls with (steps done, steps in all)."""


class KnitcoreError(Exception):
    """Base of every error that this package raises on purpose."""


class InputError(KnitcoreError, ValueError):
    """An input that cannot be used.

    Parameters
    ----------
    field : the name of the offending input, as the caller knows it (``"chart"``, ``"strain"``).
    problem : one sentence that says what is wrong.
    remedy : one sentence that says what would be accepted.
    most : the largest number that would be accepted, in the unit of the field, where that is known.

    Attributes
    ----------
    others : further faults of the same request, where the caller looked for them.
    """

    others: tuple[InputError, ...] = ()

    def __init__(self, field: str, problem: str, remedy: str, *, most: float | None = None) -> None:
        super().__init__(f"{field}: {problem} {remedy}")
        self.field = field
        self.problem = problem
        self.remedy = remedy
        self.most = most

    def __reduce__(self) -> tuple[type[InputError], tuple[str, str, str], dict[str, object]]:
        # so that it can be pickled between processes
        kept: dict[str, object] = {"most": self.most, "others": self.others}
        return type(self), (self.field, self.problem, self.remedy), kept


class ConvergenceError(KnitcoreError):
    """A solver stopped before it reached its tolerance."""


class UnravelledError(KnitcoreError):
    """Yarn passed through yarn, or a loop slipped off: the result is not a fabric any more."""


class CancelledError(KnitcoreError):
    """The caller stopped the computation."""


def check_cancelled(cancelled: Cancelled | None) -> None:
    """Raise :class:`CancelledError` if the caller wants to stop."""
    if cancelled is not None and cancelled():
        raise CancelledError("The caller stopped the computation.")


@dataclass
class SearchProgress:
    """Progress that never decreases, and a request to stop."""

    progress: Callable[[float], None] | None
    cancelled: Cancelled | None
    done: float = 0.0

    def look(self, done: float) -> None:
        """Report progress; raise :class:`CancelledError` if the caller wants to stop."""
        self.stop_if_asked()
        self.done = max(self.done, min(done, 1.0))
        if self.progress is not None:
            self.progress(self.done)

    def stop_if_asked(self) -> None:
        """Raise :class:`CancelledError` if the caller wants to stop."""
        if self.cancelled is not None and self.cancelled():
            raise CancelledError(f"stopped after {self.done:.0%}")
