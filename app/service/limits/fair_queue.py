"""A queue for a few places, which many users get one after the other."""

import asyncio
import contextlib
from collections import Counter, OrderedDict, deque
from collections.abc import AsyncIterator, Callable
from dataclasses import dataclass
from typing import Generic, TypeVar

from ..problems import UnavailableError
from .user_limits import OverLimitError

Place = TypeVar("Place")
MAX_WAITING = 100
Lane = OrderedDict[str, deque["QueuedRequest[Place]"]]


@dataclass(eq=False)
class QueuedRequest(Generic[Place]):
    """A request that waits for a place."""

    owner: str
    background: bool
    place: asyncio.Future[Place]


class FairQueue(Generic[Place]):
    """Gives places to users in turn; requests that a browser waits for come first.

    Parameters
    ----------
    places : the places to give.
    most_background : how many places background work may hold at once, so that one is left for
        requests of pages.
    most_waiting : how many may wait in the foreground; a user with none waiting there may always
        add one, so that one user cannot fill the queue.
    most_waiting_each : how many one user may have waiting in the background.
    most_each : how many places one user may hold at once; None is all of them.
    """

    def __init__(
        self,
        places: list[Place],
        *,
        most_background: int,
        most_waiting: int,
        most_waiting_each: int,
        most_each: int | None = None,
    ) -> None:
        self._free = list(places)
        self._count = len(places)
        self._most_background = most_background
        self._most_waiting = most_waiting
        self._most_waiting_each = most_waiting_each
        self.most_each = most_each or len(places)
        self._held: Counter[str] = Counter()
        self._background = 0
        self._lanes: dict[bool, Lane[Place]] = {False: OrderedDict(), True: OrderedDict()}

    def enter(self, owner: str, *, background: bool) -> QueuedRequest[Place]:
        """Join the queue.

        Raises
        ------
        UnavailableError, OverLimitError
            If the queue is full.
        """
        self.check_room(owner, background=background)
        lane = self._lanes[background]
        queued = QueuedRequest(owner, background, asyncio.get_running_loop().create_future())
        lane.setdefault(owner, deque()).append(queued)
        self._hand_out()
        return queued

    def check_room(self, owner: str, *, background: bool) -> None:
        """Refuse a request that may not join the queue.

        Raises
        ------
        UnavailableError
            If the queue is full.
        OverLimitError
            If too many of this user wait in the background.
        """
        if background and self.waiting_of(owner) >= self._most_waiting_each:
            raise OverLimitError.of("jobs", self.waiting_of(owner), self._most_waiting_each)
        full = self.waiting(background=False) >= self._most_waiting
        if not background and full and owner in self._lanes[False]:
            raise UnavailableError("Too many computations are waiting.")

    def leave(self, queued: QueuedRequest[Place]) -> None:
        """Give the place back, or leave the queue without one."""
        if queued.place.done():
            self._free.append(queued.place.result())
            self._background -= queued.background
            self._held -= Counter([queued.owner])
        else:
            queued.place.cancel()
            lane = self._lanes[queued.background]
            lane[queued.owner].remove(queued)
            if not lane[queued.owner]:
                del lane[queued.owner]
        self._hand_out()

    @property
    def taken(self) -> int:
        """Number of places in use."""
        return self._count - len(self._free)

    def held(self, owner: str) -> int:
        """Number of places that a user holds."""
        return self._held[owner]

    def waiting(self, *, background: bool) -> int:
        """Number of requests that wait."""
        return sum(len(requests) for requests in self._lanes[background].values())

    def waiting_of(self, owner: str) -> int:
        """Number of background jobs of a user that wait."""
        return len(self._lanes[True].get(owner, ()))

    def _hand_out(self) -> None:
        while self._free and (queued := self._next()) is not None:
            self._held[queued.owner] += 1
            self._background += queued.background
            queued.place.set_result(self._free.pop())

    def _next(self) -> QueuedRequest[Place] | None:
        """Take the next in turn out of the queue; None if none of them may have a place now."""
        for background, lane in self._lanes.items():
            if background and self._background >= self._most_background:
                continue
            for owner, requests in lane.items():
                if self._held[owner] < self.most_each:
                    queued = requests.popleft()
                    if requests:
                        lane.move_to_end(owner)
                    else:
                        del lane[owner]
                    return queued
        return None


class FairLock:
    """A lock that one caller holds at a time, or a few; users take turns.

    It keeps the threads of the service that compute to one: Python runs one at a time, so that two
    would be no faster, and the event loop would wait for both.

    Parameters
    ----------
    places, most_each, most_waiting : of its :class:`FairQueue`.
    """

    def __init__(
        self, places: int = 1, *, most_each: int | None = None, most_waiting: int = MAX_WAITING
    ) -> None:
        self._queue = FairQueue(
            [None] * places,
            most_background=places,
            most_waiting=most_waiting,
            most_waiting_each=0,
            most_each=most_each,
        )

    @contextlib.asynccontextmanager
    async def turn(
        self, owner: str, *, rest: Callable[[], float] = lambda: 0.0
    ) -> AsyncIterator[None]:
        """Wait for a turn, and hold it while the block runs.

        Parameters
        ----------
        rest : seconds for which nobody has a turn after the block.

        Raises
        ------
        UnavailableError
            If too many wait.
        """
        queued = self._queue.enter(owner, background=False)
        try:
            await asyncio.wait([queued.place])
            yield
        finally:
            if rest_s := rest():
                asyncio.get_running_loop().call_later(rest_s, self._queue.leave, queued)
            else:
                self._queue.leave(queued)
