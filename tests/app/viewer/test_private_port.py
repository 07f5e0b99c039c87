"""viser as it is changed here, and the version that this holds for."""

import asyncio
import threading
from contextlib import closing
from functools import partial
from pathlib import Path

import httpx2 as httpx
import pytest
import viser
from websockets.exceptions import InvalidStatus
from websockets.sync.client import connect
from websockets.typing import Subprotocol

from app.viewer.private_port import RELAY_HEADERS, TESTED_VISER, NewsEvent, private_server
from app.viewer.views import Views

ROOT = Path(__file__).resolve().parents[3]


def test_its_page_was_tested_with_the_same_viser() -> None:
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
    with closing(Views(most=1, idle_s=60)) as views:
        queue = views.open("a-design").server._websock_server.get_message_buffer()
        assert isinstance(queue.message_event, NewsEvent)


def test_the_raw_port_of_a_view_is_closed_to_others() -> None:
    """Try it as another page or user of this machine would."""
    with closing(Views(most=1, idle_s=60)) as views:
        port = views.open("a-design").port
        assert httpx.get(f"http://127.0.0.1:{port}/", timeout=60).status_code == 403
        subprotocols = [Subprotocol(f"viser-v{viser.__version__}")]
        opened = partial(
            connect, f"ws://127.0.0.1:{port}", subprotocols=subprotocols, open_timeout=60
        )
        for headers in ({}, {"X-Knitcore-Relay": "a guess"}, {"Origin": "http://evil.example"}):
            with pytest.raises(InvalidStatus) as denied, opened(additional_headers=headers):
                pass
            assert denied.value.response.status_code == 403
        with opened(additional_headers=RELAY_HEADERS) as socket:
            assert socket.recv(timeout=60)


def test_no_view_is_opened_if_the_port_cannot_be_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    import viser.infra._infra as infra
    import websockets

    monkeypatch.setitem(vars(infra), "websockets", websockets)
    with pytest.raises(RuntimeError, match="could not be closed"):
        private_server()
