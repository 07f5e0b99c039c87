"""Limits on requests per second."""

from __future__ import annotations

import time
from collections import OrderedDict

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
        """How many are left, without taking one."""
        at = time.monotonic() if at is None else at
        level, since = self._buckets.get(who, (float(self.burst), at))
        return min(self.burst, level + (at - since) * self.per_s)

    def _set(self, who: str, level: float, at: float) -> None:
        self._buckets[who] = (level, at)
        self._buckets.move_to_end(who)
        if len(self._buckets) > MAX_KNOWN:
            self._buckets.popitem(last=False)
