"""Limits of one user, in one table; limits of the whole service are in the settings."""

from __future__ import annotations

import contextlib
import math
import time
from collections import Counter, OrderedDict
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field

from pydantic import BaseModel

from ..identity import LOCAL_USER
from ..memory import machine_bytes
from ..problems import ServiceError

MAX_KNOWN = 50_000


class RateLimit:
    """A bucket of requests for each user, filled again at a steady rate.

    Parameters
    ----------
    per_s : requests a second in the long run.
    burst : requests at once.
    """

    def __init__(self, per_s: float, burst: float) -> None:
        self.per_s = per_s
        self.burst = burst
        self._buckets: OrderedDict[str, tuple[float, float]] = OrderedDict()

    def take(self, who: str, at: float | None = None) -> tuple[int, float]:
        """Take one: how many are left, and the seconds to wait (0 if there was one)."""
        at = time.monotonic() if at is None else at
        level = self.left(who, at)
        wait = 0.0 if level >= 1 else (1 - level) / self.per_s
        left = level if wait else level - 1
        self._set(who, left, at)
        return int(left), wait

    def spend(self, who: str, amount: float, at: float | None = None) -> None:
        """Take an amount that is known only afterwards; the level may fall below zero."""
        at = time.monotonic() if at is None else at
        self._set(who, self.left(who, at) - amount, at)

    def left(self, who: str, at: float | None = None) -> float:
        """Number that is left; takes none."""
        at = time.monotonic() if at is None else at
        level, since = self._buckets.get(who, (float(self.burst), at))
        return min(self.burst, level + (at - since) * self.per_s)

    def _set(self, who: str, level: float, at: float) -> None:
        self._buckets[who] = (level, at)
        self._buckets.move_to_end(who)
        if len(self._buckets) > MAX_KNOWN:
            self._buckets.popitem(last=False)


DAY_S = 86_400.0
MIN_S = 60.0
"""Computing time that must have come back before a user may compute again."""


@dataclass(frozen=True)
class UserLimits:
    """Limits of one user.

    Attributes
    ----------
    connections : requests and websockets that are open at once, where a login is asked for.
    cpu_s : CPU seconds of computations in a day, where users have logins of their own; what was
        used comes back evenly.
    memory_bytes : memory of computations at work together, each counted with the limit of its
        worker; by default that of the machine.
    views : 3D views kept open; the longest unwatched one makes room for the next.
    view_stitches : of their charts together, a rectangle counted as 20; each view takes 10 MB, a
        million stitches 20 MB more.
    watchers : browsers that show views.
    streams : event streams followed, of jobs and of views.
    pictures : pictures of views that are being taken.
    results : stored results that are being sent.
    jobs : jobs that wait in the background.
    designs : designs kept, deleted ones included.
    versions : versions kept of one design.
    links : open links to one design.
    materials : yarns of one's own.
    kept_bytes : designs and their versions together.
    job_bytes : requests of jobs, together; those that ended the longest ago make room.
    body_bytes : bodies of requests that are open, together.
    unsent_bytes : large answers and messages of views that their clients have not read yet,
        together; results of jobs are read from the database as they are sent, and do not count.
    """

    connections: int = 128
    cpu_s: float = 12 * 3_600.0
    memory_bytes: int = field(default_factory=machine_bytes)
    views: int = 16
    view_stitches: int = 4_000_000
    watchers: int = 32
    streams: int = 32
    pictures: int = 2
    results: int = 16
    jobs: int = 100
    designs: int = 5_000
    versions: int = 500
    links: int = 100
    materials: int = 40
    kept_bytes: int = 1_000_000_000
    job_bytes: int = 200_000_000
    body_bytes: int = 128_000_000
    unsent_bytes: int = 64_000_000


USER_LIMITS = UserLimits()


class Use(BaseModel):
    """How much of a limit a user holds, and the most that the limit allows."""

    used: float
    most: float


class OverLimitError(ServiceError):
    """A limit of the user is reached."""

    status, type, title = 429, "too-many", "You have reached a limit of one user"
    default_remedy = "Close one you do not need."

    @classmethod
    def of(cls, what: str, held: int, most: int) -> OverLimitError:
        """All of them are held."""
        return cls(f"You have {held} of {most} {what}.", field=what)


class CpuTimeSpentError(OverLimitError):
    """The user's computing time of the day is spent."""

    title = "Your computing time is used up"

    def __init__(self, most_s: float, wait_s: float) -> None:
        wait = math.ceil(wait_s)
        super().__init__(
            f"Your computations have used the {most_s / 3600:g} h of computing time of a day.",
            field="cpu_s",
            remedy=f"Try again in {math.ceil(wait / 60)} min, or start a job, which will wait.",
        )
        self.headers = {"Retry-After": str(wait)}


class CpuTimeLimit:
    """CPU seconds that users' computations have used, given back evenly over a day.

    The user of this machine, who has no login, is not counted.
    """

    def __init__(self, limits: UserLimits = USER_LIMITS) -> None:
        self._most_s = limits.cpu_s
        self._left = RateLimit(limits.cpu_s / DAY_S, limits.cpu_s)

    def used_s(self, owner: str) -> float:
        """CPU seconds that count against a user's limit now."""
        return self._most_s - self._left.left(owner)

    def check(self, owner: str) -> None:
        """Refuse a computation of a user whose time is spent.

        Raises
        ------
        CpuTimeSpentError
        """
        left = self._left.left(owner)
        if left <= 0:
            raise CpuTimeSpentError(self._most_s, (MIN_S - left) / self._left.per_s)

    def spend(self, owner: str, seconds: float) -> None:
        """Count a computation, which may have taken more than was left."""
        if owner != LOCAL_USER:
            self._left.spend(owner, seconds)


class ConcurrencyLimit:
    """Counts what users hold while requests last."""

    def __init__(self, limits: UserLimits = USER_LIMITS) -> None:
        self._limits = limits
        self._held: Counter[tuple[str, str]] = Counter()

    def held(self, what: str, owner: str) -> int:
        """Number that a user holds."""
        return self._held[what, owner]

    def check(self, what: str, owner: str) -> None:
        """Refuse one more.

        Raises
        ------
        OverLimitError
        """
        held, most = self._held[what, owner], getattr(self._limits, what)
        if held >= most:
            raise OverLimitError.of(what, held, most)

    @contextlib.contextmanager
    def hold(self, what: str, owner: str) -> Iterator[None]:
        """Count one while the block runs.

        Raises
        ------
        OverLimitError
        """
        with self.growing(what, owner) as count:
            count(1)
            yield

    @contextlib.contextmanager
    def growing(self, what: str, owner: str) -> Iterator[Callable[[int], None]]:
        """Yields a function that counts more of what is held until the block ends.

        It raises OverLimitError beyond the limit.
        """
        mine, most = 0, getattr(self._limits, what)

        def count(more: int) -> None:
            nonlocal mine
            if self._held[what, owner] + more > most:
                raise OverLimitError.of(what, self._held[what, owner], most)
            mine += more
            self._held[what, owner] += more

        try:
            yield count
        finally:
            self._held[what, owner] -= mine
            if not self._held[what, owner]:
                del self._held[what, owner]
