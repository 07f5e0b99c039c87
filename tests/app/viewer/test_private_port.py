"""The queue of a view's messages."""

from __future__ import annotations

import asyncio
import threading

from app.viewer.private_port import NewsEvent, private_server


def test_who_falls_asleep_just_after_another_thread_set_the_event_is_woken() -> None:
    async def woken() -> bool:
        event = NewsEvent()
        waiter = asyncio.create_task(event.wait())
        await asyncio.sleep(0)  # it looked, saw nothing, and sleeps
        writer = threading.Thread(target=event.set)
        writer.start()
        writer.join()
        event.set()  # the loop's own turn
        return await asyncio.wait_for(waiter, 60)

    assert asyncio.run(woken())


def test_views_have_such_a_queue() -> None:
    server = private_server()
    try:
        queue = server._websock_server.get_message_buffer()
        assert isinstance(queue.message_event, NewsEvent)
    finally:
        server.stop()
