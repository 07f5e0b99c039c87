"""Who has a design open now, and word of its changes to them, as event streams."""

from __future__ import annotations

import asyncio
from collections.abc import AsyncIterator, Callable
from contextlib import AbstractContextManager

from app.listeners import Listeners

PERIOD_S = 0.5
HEARTBEATS = 10
"""Periods without news after which a line is sent, so that a client that vanished is noticed."""
COMING_OR_GOING = None


class Watched:
    """Designs that are open somewhere, and those who follow them."""

    def __init__(self) -> None:
        self._followers: Listeners[int | None] = Listeners()

    def changed(self, owner: str, design: str, revision: int) -> None:
        """A design has a new revision."""
        self._followers.tell(f"{owner}/{design}", revision)

    async def events(
        self,
        owner: str,
        design: str,
        counted: AbstractContextManager[None],
        stopping: Callable[[], bool],
    ) -> AsyncIterator[bytes]:
        """Server-sent events: how many others follow a design, and its new revisions.

        Parameters
        ----------
        owner, design : the design.
        counted : entered while the stream is open.
        stopping : whether the service ends.
        """
        name, quiet = f"{owner}/{design}", 0
        try:
            with counted, self._followers.listen(name) as queue:
                self._followers.tell(name, COMING_OR_GOING)
                while not stopping():
                    try:
                        revision = await asyncio.wait_for(queue.get(), PERIOD_S)
                    except TimeoutError:
                        quiet += 1
                        if quiet % HEARTBEATS == 0:
                            yield b": still there\n\n"
                        continue
                    if revision is COMING_OR_GOING:
                        yield _event("others", self._followers.count(name) - 1)
                    else:
                        yield _event("changed", revision)
        finally:
            self._followers.tell(name, COMING_OR_GOING)


def _event(name: str, data: int) -> bytes:
    return f"event: {name}\ndata: {data}\n\n".encode()
