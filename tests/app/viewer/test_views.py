"""Views make room for each other, and leave nothing behind."""

import contextlib
import gc
import os
import threading
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from pathlib import Path

import pytest
import viser

from app.service import memory
from app.service.limits.user_limits import OverLimitError, UserLimits
from app.viewer import views as views_module
from app.viewer.views import View, Views
from tests.app.clients import served, state_of, watching
from tests.app.rest import draw
from tests.app.running import threads_of_no_pool, wait_until

ROUNDS, VIEWS = 3, 3


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


def test_nobody_waits_while_a_view_is_made(monkeypatch: pytest.MonkeyPatch) -> None:
    made, begun, may_be_made = views_module.new_view, threading.Event(), threading.Event()

    def slowly_made() -> View:
        begun.set()
        may_be_made.wait(60)
        return made()

    monkeypatch.setattr(views_module, "new_view", slowly_made)
    with closing(Views(2, 60.0)) as views, ThreadPoolExecutor() as threads:
        opening = threads.submit(views.open, "ada/slow")
        assert begun.wait(60)
        assert views.get("ada/slow") is None
        views.watch("ada/slow", +1)
        assert views.close_idle() == 0
        closing_all = threads.submit(views.close)
        may_be_made.set()
        assert opening.result() is not None
        closing_all.result()
        assert len(views) == 0


def test_threads_handles_and_servers_return_to_the_start(tmp_path: Path) -> None:
    memory.give_back()
    others = _servers()  # of services that other tests use
    with served(data_dir=tmp_path) as client:
        assert client.get("/readyz").status_code == 200
        start = _held()
        for _ in range(ROUNDS):
            for number in range(VIEWS):
                draw(client, f"dropped-{number}", {"fabric": "rib", "columns": 6, "rows": 6})
                with watching(client, f"/view/dropped-{number}") as socket:
                    assert socket.receive_bytes()
            state_of(client).views.close()
            wait_until(lambda: all(now <= m for now, m in zip(_held(), start, strict=True)))
    memory.give_back()
    assert _servers() <= others


def test_a_view_prints_nothing_to_stdout(capsys: pytest.CaptureFixture[str]) -> None:
    with closing(Views(most=1, idle_s=1.0)) as views:
        views.open("a-quiet-one")
    assert capsys.readouterr().out == ""


def test_views_make_room_for_each_other() -> None:
    views = Views(most=2, idle_s=0.0)
    first = views.open("design-1")
    views.open("design-2")
    views.watch("design-1", +1)
    views.open("design-3")
    assert views.get("design-2") is None
    assert views.open("design-1") is first
    views.watch("design-1", -1)
    time.sleep(0.01)
    assert views.close_idle() == 2
    assert len(views) == 0


def test_a_view_is_as_coarse_as_its_browsers_need() -> None:
    with closing(Views(most=4, idle_s=60)) as views:
        first = views.open("ada/a")
        views.watch("ada/a", +1)
        assert not first.writer.coarse
        views.watch("ada/a", +1, coarse=True)
        assert first.writer.coarse
        assert views.open("ada/b").writer.coarse  # who has no GPU here has none there
        assert not views.open("bob/a").writer.coarse
        views.watch("ada/a", -1, coarse=True)
        assert not first.writer.coarse
        assert views.open("ada/c").writer.coarse  # the same browser comes back


def test_one_user_does_not_take_all_views(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(views_module, "USER_LIMITS", UserLimits(views=2))
    with closing(Views(most=3, idle_s=60)) as views:
        for name in ("ada/a", "ada/b"):
            views.open(name)
            views.watch(name, +1)
        with pytest.raises(OverLimitError, match="2 of 2"):
            views.open("ada/c")
        views.open("bob/a")
        views.watch("ada/a", -1)
        views.open("ada/c")  # the one nobody watches makes room
        assert views.get("ada/a") is None
        assert views.get("bob/a") is not None


def test_large_charts_in_views_make_room_for_each_other(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(views_module, "USER_LIMITS", UserLimits(view_stitches=100))
    with closing(Views(most=9, idle_s=60)) as views:
        views.open("ada/a", 60)
        views.open("bob/a", 60)
        views.open("ada/b", 60)
        assert views.get("ada/a") is None
        assert views.get("bob/a") is not None
        views.watch("ada/b", +1)
        with pytest.raises(OverLimitError, match="60 of 100"):
            views.open("ada/c", 60)
        assert views.open("ada/b", 90).stitches == 90  # the same view, with a larger chart
