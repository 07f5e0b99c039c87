"""Progress of a long search, and stopping it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from knitcore.base.errors import Cancelled, CancelledError


@dataclass
class SearchProgress:
    """Progress that never decreases, and a request to stop."""

    progress: Callable[[float], None] | None
    cancelled: Cancelled | None
    done: float = 0.0

    def look(self, done: float) -> None:
        """Report progress, and stop if asked to."""
        self.stop_if_asked()
        self.done = max(self.done, min(done, 1.0))
        if self.progress is not None:
            self.progress(self.done)

    def stop_if_asked(self) -> None:
        """Stop if asked to."""
        if self.cancelled is not None and self.cancelled():
            raise CancelledError(f"stopped after {self.done:.0%}")
