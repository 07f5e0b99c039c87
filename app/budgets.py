"""Limits of one user, in one table; limits of the whole service are in the settings."""

from __future__ import annotations

import contextlib
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass

from app.http.problems import ServiceError


@dataclass(frozen=True)
class Budgets:
    """Limits of one user.

    Attributes
    ----------
    views : 3D views kept open; the longest unwatched one makes room for the next.
    watchers : browsers that show views.
    streams : event streams followed, of jobs and of views.
    pictures : pictures of views that are being taken.
    jobs : jobs that wait in the background.
    designs : designs kept, deleted ones included.
    versions : versions kept of one design.
    links : open links to one design.
    kept_bytes : designs and their versions together.
    """

    views: int = 16
    watchers: int = 32
    streams: int = 32
    pictures: int = 2
    jobs: int = 100
    designs: int = 5_000
    versions: int = 500
    links: int = 100
    kept_bytes: int = 1_000_000_000


BUDGETS = Budgets()


class OverBudgetError(ServiceError):
    """A limit of the user is reached."""

    status, type, title = 429, "too many", "You have as many as one user may"
    default_remedy = "Close one you do not need."


class InUse:
    """Counts what users hold while requests last."""

    def __init__(self, budgets: Budgets = BUDGETS) -> None:
        self._budgets = budgets
        self._held: Counter[tuple[str, str]] = Counter()

    def check(self, what: str, owner: str) -> None:
        """Refuse one more.

        Raises
        ------
        OverBudgetError
        """
        most = getattr(self._budgets, what)
        if self._held[what, owner] >= most:
            raise OverBudgetError(f"You have {most} of {most} {what}.", field=what)

    @contextlib.contextmanager
    def hold(self, what: str, owner: str) -> Iterator[None]:
        """Count one while the block runs.

        Raises
        ------
        OverBudgetError
        """
        self.check(what, owner)
        self._held[what, owner] += 1
        try:
            yield
        finally:
            self._held[what, owner] -= 1
            if not self._held[what, owner]:
                del self._held[what, owner]
