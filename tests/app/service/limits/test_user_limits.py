"""Limits of what one user may hold and keep."""

import asyncio
from collections.abc import Callable
from contextlib import closing
from dataclasses import fields
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from app.service.compute.compute import Compute
from app.service.designs import sharing as sharing_module
from app.service.designs import store as store_module
from app.service.designs.document import DesignDocument, ShareMode
from app.service.designs.sharing import Sharing
from app.service.designs.store import DesignStore
from app.service.identity import LOCAL_USER
from app.service.jobs import store as job_store_module
from app.service.jobs.document import JobState
from app.service.jobs.store import JobStore
from app.service.limits.user_limits import (
    USER_LIMITS,
    ConcurrencyLimit,
    CpuTimeLimit,
    CpuTimeSpentError,
    OverLimitError,
    RateLimit,
    UserLimits,
)
from app.service.store.database import Database
from app.viewer import views as views_module
from app.viewer.views import Views
from tests.app.clients import closed_with, limited, login, served, state_of, watching
from tests.app.jobs import never
from tests.app.rest import draw

RIB = DesignDocument(name="Cuff", material="acrylic", chart="\n".join(["KP" * 50] * 100))
SIZE = 100 * 101 - 1 + len(RIB.model_dump_json(include={"outline", "regions", "repeats", "shelf"}))


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
    """With the default limit of a worker, half of the machine's memory, that is two at once."""
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


def test_requests_of_jobs_have_a_size_together(
    database: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = JobStore(database, "here")
    monkeypatch.setattr(job_store_module, "USER_LIMITS", UserLimits(job_bytes=100))

    def add(owner: str) -> str:
        return store.add(owner, "relax", "x" * 40, "key", JobState.WAITING).id

    first, second = add("ada"), add("ada")
    with pytest.raises(OverLimitError) as refused:
        add("ada")
    assert refused.value.field == "job_bytes"
    assert add("bob")
    store.end(first, JobState.CANCELLED)
    third = add("ada")  # in place of the one that has ended
    assert store.kept_bytes("ada") == 80
    assert {job.id for job in store.page("ada", limit=9, cursor=None).jobs} == {second, third}


def test_bytes_kept_are_counted_with_versions(
    database: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = DesignStore(database)
    monkeypatch.setattr(store_module, "USER_LIMITS", UserLimits(kept_bytes=3 * SIZE))
    first = store.create("ada", RIB)
    store.keep_version("ada", first.id, "one")
    assert (store.most_versions("ada"), store.most_versions("bob")) == (1, 0)
    second = store.duplicate("ada", first.id)
    larger = RIB.model_copy(update={"note": "n"})
    for refused in (
        lambda: store.create("ada", RIB),
        lambda: store.keep_version("ada", first.id, "two"),
        lambda: store.replace("ada", second.id, larger, "*"),
    ):
        with pytest.raises(OverLimitError, match="of 0 MB"):
            refused()
    small = RIB.model_copy(update={"chart": "KP"})
    assert store.replace("ada", second.id, small, "*").columns == 2  # smaller is always taken
    assert store.replace("ada", second.id, larger.model_copy(update={"chart": "K"}), "*")
    assert store.create("bob", RIB)


def test_links_to_a_design_are_bounded(database: Database, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sharing_module, "USER_LIMITS", UserLimits(links=2))
    design = DesignStore(database).create("ada", RIB).id
    links = Sharing(database)
    first = links.give("ada", design, ShareMode.READ)
    links.give("ada", design, ShareMode.COPY)
    with pytest.raises(OverLimitError, match="2 open links"):
        links.give("ada", design, ShareMode.READ)
    assert links.most_given("ada") == 2
    links.revoke("ada", design, first.id)
    assert (links.most_given("ada"), links.most_given("bob")) == (1, 0)
    assert links.give("ada", design, ShareMode.READ).token


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


def test_streams_pictures_and_watchers_are_bounded(client: TestClient) -> None:
    draw(client, "a-view")
    with limited(client, watchers=1, streams=0, pictures=0) as limit:
        for path in ("events", "picture"):
            answer = client.get(f"/api/v1/views/a-view/{path}")
            assert (answer.status_code, answer.json()["type"]) == (429, "/problems/too-many")
            assert answer.json()["remedy"]
        with watching(client, "/view/a-view"):
            assert closed_with(client, "/view/a-view") == 1013
        assert not any(limit.held(what, LOCAL_USER) for what in ("watchers", "streams", "pictures"))
