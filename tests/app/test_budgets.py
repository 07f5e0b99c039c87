"""What one user may hold and keep."""

from __future__ import annotations

import contextlib
from collections.abc import Iterator
from pathlib import Path

import pytest
import viser
from fastapi.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from app.budgets import Budgets, InUse, OverBudgetError
from app.designs import sharing as sharing_module
from app.designs import store as store_module
from app.designs.conditions import ConflictError
from app.designs.document import DesignDocument, ShareMode
from app.designs.sharing import Sharing
from app.designs.store import DesignStore
from app.store.database import Database
from app.viewer import views as views_module
from app.viewer.views import Views

RIB = DesignDocument(name="Cuff", material="acrylic", chart="\n".join(["KP" * 50] * 100))
SIZE = 100 * 101 - 1 + len(RIB.model_dump_json(include={"outline", "regions", "repeats", "shelf"}))


def test_what_is_held_is_counted_for_each_user_and_let_go() -> None:
    uses = InUse(Budgets(streams=2))
    with uses.hold("streams", "ada"), uses.hold("streams", "ada"):
        with pytest.raises(OverBudgetError, match="2 of 2 streams"):
            uses.check("streams", "ada")
        uses.check("streams", "bob")
        uses.check("watchers", "ada")
    uses.check("streams", "ada")
    assert not uses._held


def test_bytes_kept_are_counted_with_versions(
    database: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    store = DesignStore(database)
    monkeypatch.setattr(store_module, "BUDGETS", Budgets(kept_bytes=3 * SIZE))
    first = store.create("ada", RIB)
    store.keep_version("ada", first.id, "one")
    second = store.duplicate("ada", first.id)
    larger = RIB.model_copy(update={"note": "n"})
    for refused in (
        lambda: store.create("ada", RIB),
        lambda: store.keep_version("ada", first.id, "two"),
        lambda: store.replace("ada", second.id, larger, "*"),
    ):
        with pytest.raises(ConflictError, match="of 0 MB"):
            refused()
    small = RIB.model_copy(update={"chart": "KP"})
    assert store.replace("ada", second.id, small, "*").columns == 2  # smaller is always taken
    assert store.replace("ada", second.id, larger.model_copy(update={"chart": "K"}), "*")
    assert store.create("bob", RIB)


def test_links_to_a_design_are_bounded(database: Database, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sharing_module, "BUDGETS", Budgets(links=2))
    design = DesignStore(database).create("ada", RIB).id
    links = Sharing(database)
    first = links.give("ada", design, ShareMode.READ)
    links.give("ada", design, ShareMode.COPY)
    with pytest.raises(ConflictError, match="2 open links"):
        links.give("ada", design, ShareMode.READ)
    links.revoke("ada", design, first.id)
    assert links.give("ada", design, ShareMode.READ).token


def test_one_user_does_not_take_all_views(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(views_module, "BUDGETS", Budgets(views=2))
    views = Views(most=3, idle_s=60)
    try:
        for name in ("ada/a", "ada/b"):
            views.open(name)
            views.watch(name, +1)
        with pytest.raises(OverBudgetError, match="2 of 2"):
            views.open("ada/c")
        views.open("bob/a")
        views.watch("ada/a", -1)
        views.open("ada/c")  # the one nobody watches makes room
        assert views.get("ada/a") is None
        assert views.get("bob/a") is not None
    finally:
        views.close()


@pytest.fixture
def narrow(client: TestClient) -> Iterator[TestClient]:
    state = client.app.state  # type: ignore[attr-defined]
    before, uses = state.in_use, InUse(Budgets(watchers=1, streams=0, pictures=0))
    state.in_use = uses
    body = {"chart": "KP", "material": "cotton"}
    assert client.put("/api/v1/views/a-view", json=body).status_code == 200
    yield client
    state.in_use = before
    assert not uses._held


def test_streams_pictures_and_watchers_are_bounded(narrow: TestClient, tmp_path: Path) -> None:
    for path in ("events", "picture"):
        answer = narrow.get(f"/api/v1/views/a-view/{path}")
        assert (answer.status_code, answer.json()["type"]) == (429, "too many")
        assert answer.json()["remedy"]

    def watch() -> contextlib.AbstractContextManager[object]:
        address = "ws://127.0.0.1/view/a-view"
        return narrow.websocket_connect(address, subprotocols=[f"viser-v{viser.__version__}"])

    with watch():
        with pytest.raises(WebSocketDisconnect) as refused, watch():
            pass
        assert refused.value.code == 1013
