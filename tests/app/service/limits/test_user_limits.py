"""Limits of what one user may hold and keep."""

import asyncio
from collections.abc import Callable
from dataclasses import fields
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from app.service.compute.compute import Compute
from app.service.identity import LOCAL_USER
from app.service.limits.user_limits import (
    USER_LIMITS,
    ConcurrencyLimit,
    CpuTimeLimit,
    CpuTimeSpentError,
    OverLimitError,
    RateLimit,
    UserLimits,
)
from tests.app.clients import closed_with, limited, login, served, state_of, watching
from tests.app.jobs import never
from tests.app.rest import draw
from tests.app.running import wait_until


def test_what_users_hold_is_counted_and_released() -> None:
    uses = ConcurrencyLimit(UserLimits(streams=2))
    with uses.hold("streams", "ada"), uses.hold("streams", "ada"):
        with pytest.raises(OverLimitError, match="2 of 2 streams"):
            uses.check("streams", "ada")
        uses.check("streams", "bob")
        uses.check("watchers", "ada")
    assert uses.held("streams", "ada") == 0


def test_a_bucket_fills_again() -> None:
    limit = RateLimit(per_s=2.0, burst=3)
    assert [limit.take("ada", at=0.0) for _ in range(4)] == [(2, 0), (1, 0), (0, 0), (0, 0.5)]
    assert limit.take("bob", at=0.0) == (2, 0)
    assert limit.take("ada", at=0.5) == (0, 0)
    assert limit.left("ada", at=100.0) == 3


class _Finished:
    """A worker whose jobs are done at once, and took some CPU seconds."""

    share, cpu_s = 0.0, 0.2

    async def submit(self, job: Callable[..., int]) -> asyncio.Future[int]:
        done = asyncio.get_running_loop().create_future()
        done.set_result(1)
        return done


def test_computing_time_is_spent_and_restored() -> None:
    compute = Compute([_Finished()], timeout_s=30.0)  # type: ignore[list-item]
    compute.cpu_time = CpuTimeLimit(UserLimits(cpu_s=0.1))

    def run(owner: str) -> int:
        return asyncio.run(compute.run(never, print, owner=owner))

    assert run("ada") == 1
    assert compute.cpu_time.used_s("ada") == pytest.approx(0.2, abs=1e-3)
    with pytest.raises(CpuTimeSpentError, match="computing time of a day") as refused:
        run("ada")
    assert int(refused.value.headers["Retry-After"]) > 60
    assert run("bob") == 1
    assert [run(LOCAL_USER) for _ in range(2)] == [1, 1]
    assert compute.cpu_time.used_s(LOCAL_USER) == 0


def test_computations_of_a_user_share_the_memory_of_the_machine(tmp_path: Path) -> None:
    """A worker may take half of the machine's memory, so two run at once."""
    with served(require_login=True, workers=3, data_dir=tmp_path) as client:
        settings = state_of(client).settings
        queue = state_of(client).compute.queue
        most = USER_LIMITS.memory_bytes // settings.worker_memory_bytes
        assert queue.most_each == max(1, most)


def test_a_user_has_so_many_connections(tmp_path: Path) -> None:
    with served(require_login=True, data_dir=tmp_path) as client:
        client.headers.update(login(client, "ada"))
        draw(client, "a-view", "K")
        use = client.get("/api/v1/session").json()["use"]
        assert set(use) == {limit.name for limit in fields(UserLimits)}
        for name in ("connections", "views", "view_stitches"):
            assert use[name] == {"used": 1, "most": getattr(USER_LIMITS, name)}
        with limited(client, connections=2, streams=2) as limit:
            with limit.hold("connections", "ada"), limit.hold("connections", "ada"):
                refused = client.get("/api/v1/session")
                assert (refused.status_code, refused.json()["field"]) == (429, "connections")
                assert "2 of 2" in refused.json()["detail"]
                other = login(client, "bob")
                assert client.get("/api/v1/session", headers=other).status_code == 200
            assert limit.held("connections", "ada") == 0


def test_streams_pictures_and_watchers_are_bounded(client: TestClient) -> None:
    draw(client, "a-view")
    with limited(client, watchers=1, streams=0, pictures=0) as limit:
        for path in ("events", "picture"):
            answer = client.get(f"/api/v1/views/a-view/{path}")
            assert (answer.status_code, answer.json()["type"]) == (429, "/problems/too-many")
            assert answer.json()["remedy"]
        with watching(client, "/view/a-view"):
            assert closed_with(client, "/view/a-view") == 1013
        wait_until(lambda: not limit.held("watchers", LOCAL_USER))
        with limited(client, unsent_bytes=100):
            assert closed_with(client, "/view/a-view") == 1013
        assert not any(limit.held(what, LOCAL_USER) for what in ("watchers", "streams", "pictures"))
