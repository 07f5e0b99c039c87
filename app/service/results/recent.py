"""Results that the page may ask for again, in memory, by the content of their request."""

from __future__ import annotations

from collections import OrderedDict
from typing import Any

MAX_BYTES = 32_000_000


class RecentResults:
    """The latest results, up to a size in all; the least recently used are dropped first."""

    def __init__(self, most_bytes: int = MAX_BYTES) -> None:
        self._most_bytes = most_bytes
        self._bytes = 0
        self._items: OrderedDict[str, tuple[Any, int]] = OrderedDict()

    def get(self, key: str) -> Any | None:
        """The result with this key, or None if it was never made or is gone."""
        entry = self._items.get(key)
        if entry is None:
            return None
        self._items.move_to_end(key)
        return entry[0]

    def put(self, key: str, result: Any, size_bytes: int) -> None:
        """Keep a result of about this size."""
        self.drop(key)
        self._items[key] = (result, size_bytes)
        self._bytes += size_bytes
        while self._bytes > self._most_bytes and len(self._items) > 1:
            self.drop(next(iter(self._items)))

    def drop(self, key: str) -> None:
        """Forget a result, if it is there."""
        _, size = self._items.pop(key, (None, 0))
        self._bytes -= size
