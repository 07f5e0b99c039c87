"""Followers of open designs, who hear of changes by event streams."""

import asyncio
from collections.abc import AsyncGenerator, Callable

from ..listeners import Listeners

PERIOD_S = 0.5
QUIET_S = 5.0
"""A follower that vanished is noticed within this time."""
COMING_OR_GOING = 0
"""Value in place of a revision: somebody began or stopped following."""


class Watched:
    """Designs that are open somewhere, and those who follow them."""

    def __init__(self) -> None:
        self._followers: Listeners[int] = Listeners()

    def changed(self, owner: str, design: str, revision: int) -> None:
        """A design has a new revision."""
        self._followers.tell(f"{owner}/{design}", revision)

    async def events(
        self, owner: str, design: str, stopping: Callable[[], bool]
    ) -> AsyncGenerator[str | None]:
        """Server-sent events: how many others follow a design, and its new revisions; None where
        a period passed without news.

        Parameters
        ----------
        owner, design : the design.
        stopping : whether the service ends.
        """
        name = f"{owner}/{design}"
        try:
            with self._followers.listen(name) as queue:
                self._followers.tell(name, COMING_OR_GOING)
                while not stopping():
                    try:
                        revision = await asyncio.wait_for(queue.get(), PERIOD_S)
                    except TimeoutError:
                        yield None
                    else:
                        others = self._followers.count(name) - 1
                        news = (
                            f"changed\ndata: {revision}" if revision else f"others\ndata: {others}"
                        )
                        yield f"event: {news}\n\n"
        finally:
            self._followers.tell(name, COMING_OR_GOING)
