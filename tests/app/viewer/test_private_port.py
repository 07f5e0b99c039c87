"""viser as it is changed here, and the version that this holds for."""

from __future__ import annotations

import asyncio
import threading
from pathlib import Path

import viser

from app.viewer.private_port import TESTED_VISER, NewsEvent, private_server

ROOT = Path(__file__).resolve().parents[3]


def test_viser_is_the_version_that_its_patches_were_tested_with() -> None:
    assert viser.__version__.startswith(f"{TESTED_VISER}.")
    major, minor = map(int, TESTED_VISER.split("."))
    allowed = f'"viser>={TESTED_VISER},<{major}.{minor + 1}"'
    assert allowed in (ROOT / "pyproject.toml").read_text(encoding="utf-8")
    assert f"viser {TESTED_VISER}" in (ROOT / "frontend" / "README.md").read_text(encoding="utf-8")


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
