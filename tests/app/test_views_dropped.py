"""Views that were opened, looked at and dropped leave nothing behind."""

from __future__ import annotations

import contextlib
import gc
import os
import time
from pathlib import Path

import pytest
import viser
from fastapi import FastAPI
from fastapi.testclient import TestClient

from app.service import memory
from app.service.main import create_app
from app.service.settings import Settings
from app.viewer.views import Views
from tests.app.threads import threads_of_no_pool

ROUNDS, VIEWS = 3, 3
CHART = {"fabric": "rib", "columns": 6, "rows": 6}


def _held() -> tuple[int, int]:
    """Threads that belong to no pool, and handles of servers."""
    handles = 0
    for handle in os.listdir("/proc/self/fd"):
        with contextlib.suppress(FileNotFoundError):  # that of the list itself
            kind = os.readlink(f"/proc/self/fd/{handle}")
            handles += kind.startswith(("socket:", "anon_inode:[eventpoll]"))
    return len(threads_of_no_pool()), handles


def _servers() -> int:
    return sum(type(thing) is viser.ViserServer for thing in gc.get_objects())


def _look(client: TestClient) -> None:
    """Open some views, look at each, and go away."""
    for number in range(VIEWS):
        body = {"chart": CHART, "material": "acrylic"}
        assert client.put(f"/api/v1/views/dropped-{number}", json=body).status_code == 200
        protocol = [f"viser-v{viser.__version__}"]
        address = f"ws://127.0.0.1/view/dropped-{number}"
        with client.websocket_connect(address, subprotocols=protocol) as socket:
            assert socket.receive_bytes()


def _dropped(app: FastAPI, most: tuple[int, int]) -> None:
    """Close all views, and wait until no more is held than ``most``."""
    app.state.views.close()
    deadline = time.monotonic() + 60
    while any(now > m for now, m in zip(_held(), most, strict=True)):
        assert time.monotonic() < deadline, _held()
        time.sleep(0.01)


def test_threads_handles_and_servers_return_to_the_start(tmp_path: Path) -> None:
    memory.give_back()
    others = _servers()  # of services that other tests use
    app = create_app(Settings(workers=1, data_dir=tmp_path))
    with TestClient(app, base_url="http://127.0.0.1") as client:
        assert client.get("/readyz").status_code == 200
        start = _held()
        for _ in range(ROUNDS):
            _look(client)
            _dropped(app, start)
    memory.give_back()
    assert _servers() <= others


def test_a_view_prints_nothing_to_stdout(capsys: pytest.CaptureFixture[str]) -> None:
    views = Views(most=1, idle_s=1.0)
    views.open("a-quiet-one")
    views.close()
    assert capsys.readouterr().out == ""
