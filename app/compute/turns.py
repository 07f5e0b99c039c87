"""Turns: a few places, given to many users one after the other."""

from __future__ import annotations

import asyncio
from collections import OrderedDict, deque
from dataclasses import dataclass
from typing import Generic, TypeVar

from app.http.problems import UnavailableError

Place = TypeVar("Place")
Lane = OrderedDict[str, deque["Ticket[Place]"]]


@dataclass(eq=False)
class Ticket(Generic[Place]):
    """A request that waits for a place."""

    owner: str
    background: bool
    place: asyncio.Future[Place]


class Turns(Generic[Place]):
    """Gives places to users in turn; requests that a browser waits for come first.

    Parameters
    ----------
    places : the places to give.
    most_background : how many places background work may hold at once, so that one is left for
        requests of pages.
    most_waiting : how many may wait in the foreground; a user with none waiting there may always
        add one, so that one user cannot fill the queue.
    most_waiting_each : how many one user may have waiting in the background.
    """

    def __init__(
        self,
        places: list[Place],
        *,
        most_background: int,
        most_waiting: int,
        most_waiting_each: int,
    ) -> None:
        self._free = list(places)
        self._count = len(places)
        self._most_background = most_background
        self._most_waiting = most_waiting
        self._most_waiting_each = most_waiting_each
        self._background = 0
        self._lanes: dict[bool, Lane[Place]] = {False: OrderedDict(), True: OrderedDict()}

    def enter(self, owner: str, *, background: bool) -> Ticket[Place]:
        """Join the queue.

        Raises
        ------
        UnavailableError
            If the queue is full.
        """
        self.check_room(owner, background=background)
        lane = self._lanes[background]
        ticket = Ticket(owner, background, asyncio.get_running_loop().create_future())
        lane.setdefault(owner, deque()).append(ticket)
        self._hand_out()
        return ticket

    def check_room(self, owner: str, *, background: bool) -> None:
        """Refuse a request that may not join the queue.

        Raises
        ------
        UnavailableError
            If the queue is full.
        """
        mine = len(self._lanes[background].get(owner, ()))
        full = mine > 0 and self.waiting(background=False) >= self._most_waiting
        if mine >= self._most_waiting_each if background else full:
            raise UnavailableError("Too many computations are waiting.")

    def leave(self, ticket: Ticket[Place]) -> None:
        """Give the place back, or leave the queue without one."""
        if ticket.place.done():
            self._free.append(ticket.place.result())
            self._background -= ticket.background
        else:
            ticket.place.cancel()
            lane = self._lanes[ticket.background]
            lane[ticket.owner].remove(ticket)
            if not lane[ticket.owner]:
                del lane[ticket.owner]
        self._hand_out()

    @property
    def taken(self) -> int:
        """Number of places in use."""
        return self._count - len(self._free)

    def waiting(self, *, background: bool) -> int:
        """Number of requests that wait."""
        return sum(len(tickets) for tickets in self._lanes[background].values())

    def _hand_out(self) -> None:
        while self._free:
            if self._lanes[False]:
                lane = self._lanes[False]
            elif self._lanes[True] and self._background < self._most_background:
                lane = self._lanes[True]
                self._background += 1
            else:
                return
            owner, tickets = next(iter(lane.items()))
            ticket = tickets.popleft()
            if tickets:
                lane.move_to_end(owner)
            else:
                del lane[owner]
            ticket.place.set_result(self._free.pop())
