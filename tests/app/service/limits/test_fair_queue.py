"""Fair queue."""

import asyncio

import pytest
from hypothesis import given
from hypothesis import strategies as st

from app.service.limits.fair_queue import FairLock, FairQueue, QueuedRequest
from app.service.limits.user_limits import OverLimitError
from app.service.problems import UnavailableError


def _queue(places: int = 1, background: int = 1, **most: int) -> FairQueue[int]:
    limits = {"most_waiting": 100, "most_waiting_each": 100} | most
    return FairQueue(list(range(places)), most_background=background, **limits)


async def _order(queue: FairQueue[int], line: list[tuple[str, bool]]) -> list[str]:
    """Who gets the only place when everybody in line gives it back at once."""
    holder = queue.enter("holder", background=False)
    tickets = [queue.enter(owner, background=b) for owner, b in line]
    order = []
    queue.leave(holder)
    waiting = list(tickets)
    while waiting:
        (served,) = [t for t in waiting if t.place.done()]
        order.append(served.owner)
        waiting.remove(served)
        queue.leave(served)
    return order


def test_users_take_queue() -> None:
    line = [("ada", True)] * 4 + [("bob", True)] * 2 + [("eve", True)]
    order = asyncio.run(_order(_queue(), line))
    assert order == ["ada", "bob", "eve", "ada", "bob", "ada", "ada"]


def test_requests_of_pages_come_first() -> None:
    line = [("ada", True), ("ada", True), ("bob", False)]
    assert asyncio.run(_order(_queue(), line)) == ["bob", "ada", "ada"]


@given(st.lists(st.tuples(st.sampled_from("abcd"), st.booleans()), max_size=30))
def test_everybody_is_served_once_and_in_turn(line: list[tuple[str, bool]]) -> None:
    order = asyncio.run(_order(_queue(), line))
    assert sorted(order) == sorted(owner for owner, _ in line)
    background = order[sum(not b for _, b in line) :]
    left = {o: sum(1 for owner, b in line if b and owner == o) for o in "abcd"}
    served = dict.fromkeys("abcd", 0)
    for owner in background:
        served[owner] += 1
        for other, count in served.items():
            assert served[owner] <= count + 1 or count == left[other]


async def test_background_work_leaves_a_place_free() -> None:
    queue = _queue(places=3, background=2)
    background = [queue.enter("ada", background=True) for _ in range(4)]
    assert [t.place.done() for t in background] == [True, True, False, False]
    page = queue.enter("bob", background=False)
    assert page.place.done()
    queue.leave(background[0])
    assert [t.place.done() for t in background] == [True, True, True, False]


async def test_leaving_the_queue_does_not_delay_others() -> None:
    queue = _queue()
    holder: QueuedRequest[int] = queue.enter("ada", background=False)
    leaver = queue.enter("bob", background=False)
    stayer = queue.enter("eve", background=False)
    queue.leave(leaver)
    queue.leave(holder)
    assert [leaver.place.cancelled(), stayer.place.done()] == [True, True]


async def test_the_queue_is_bounded() -> None:
    queue = _queue(most_waiting=1, most_waiting_each=1)
    for background in (False, True):
        queue.enter("ada", background=background)
    queue.enter("ada", background=False)
    with pytest.raises(UnavailableError, match="Too many"):
        queue.enter("ada", background=False)
    with pytest.raises(OverLimitError, match="1 of 1 jobs"):
        queue.enter("ada", background=True)
    queue.enter("bob", background=True)


async def test_one_user_cannot_fill_the_queue() -> None:
    queue = _queue(most_waiting=3)
    for _ in range(4):  # one has the place, three wait
        queue.enter("ada", background=False)
    with pytest.raises(UnavailableError):
        queue.enter("ada", background=False)
    queue.enter("bob", background=False)
    with pytest.raises(UnavailableError):
        queue.enter("bob", background=False)


async def test_a_user_holds_only_so_many_places() -> None:
    queue = _queue(places=3, background=2, most_each=2)
    ada = [queue.enter("ada", background=False) for _ in range(3)]
    assert [ticket.place.done() for ticket in ada] == [True, True, False]
    bob = queue.enter("bob", background=True)
    assert bob.place.done()  # although ada waits at a page
    queue.leave(ada[0])
    assert ada[2].place.done()


async def test_a_fair_lock_lets_one_through_at_a_time_and_its_turns_are_given_back() -> None:
    lock, order, inside, most = FairLock(), [], 0, 0

    async def come(owner: str) -> None:
        nonlocal inside, most
        async with lock.turn(owner):
            inside += 1
            most = max(most, inside)
            order.append(owner)
            await asyncio.sleep(0)
            inside -= 1

    line = [asyncio.create_task(come(owner)) for owner in "aaaaab"]
    await asyncio.sleep(0)
    line[3].cancel()  # one that waits; its turn goes to the next
    await asyncio.gather(*line, return_exceptions=True)
    assert most == 1
    assert (len(order), order.index("b")) == (5, 2)


async def test_a_lock_that_rests_lets_others_work_first() -> None:
    lock, events = FairLock(), []

    async def come(name: str) -> None:
        async with lock.turn("a", rest=lambda: 0.01):
            events.append(name)

    loop = asyncio.get_running_loop()
    first, second = asyncio.create_task(come("first")), asyncio.create_task(come("second"))
    await first
    loop.call_soon(events.append, "another's work")
    await second
    assert events == ["first", "another's work", "second"]
