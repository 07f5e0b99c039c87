"""A pass lets the sandboxed frame of a view in, and nobody else."""

from pathlib import Path

import pytest
from fastapi.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from app.service.identity import current_user
from app.service.web import sessions
from app.service.web.passes import ViewPasses
from tests.app.clients import bearing, tokens_of, watching
from tests.app.service.web.test_security import guarded_service

BODY = {"chart": "KP", "material": "acrylic"}
FRAME = {"Origin": "null"}
"""What browsers say of a sandboxed frame, of any site."""


def _watch(client: TestClient, path: str) -> None:
    with watching(client, path, **FRAME) as socket:
        assert socket.receive_bytes()


def _refused(client: TestClient, path: str) -> None:
    with pytest.raises(WebSocketDisconnect) as closed:
        _watch(client, path)
    assert closed.value.code == 1008


def test_a_frame_watches_with_the_pass_of_its_view_only(client: TestClient) -> None:
    url = client.put("/api/v1/views/with-pass", json=BODY).json()["url"]
    path, code = url.split("/#")
    assert path == "/view/with-pass"
    _watch(client, f"{path}?pass={code}")
    for wrong in ("", f"?pass={code[:-1]}", "?pass=", f"?pass={'0' * 64}"):
        _refused(client, path + wrong)
    _refused(client, f"/view/another?pass={code}")
    body = {"chart": "KP"}
    asked = client.post(f"/api/v1/charts/parse?pass={code}", json=body, headers=FRAME)
    assert asked.status_code == 403


def test_a_pass_ends_with_the_token_it_was_asked_with(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sessions, "REMEMBERED_S", 0.0)
    with guarded_service(require_login=True, data_dir=tmp_path) as lab:
        made = tokens_of(lab).create("ada")
        url = lab.put("/api/v1/views/of-ada", json=BODY, headers=bearing(made.token)).json()["url"]
        path = url.replace("/#", "?pass=")
        _watch(lab, path)
        tokens_of(lab).revoke(made.id)
        _refused(lab, path)


def test_passes_are_the_same_for_one_user_and_forgotten_in_turn() -> None:
    passes = ViewPasses(most=2)
    first = passes.give("/view/a", None)
    assert passes.give("/view/a", None) == first != passes.give("/view/b", None)
    scope = {"type": "websocket", "path": "/view/a", "query_string": f"pass={first}".encode()}
    opener = passes.holder(scope)
    assert opener is not None
    assert opener.user == current_user.get()
    assert passes.holder(scope | {"type": "http"}) is None
    for name in "cd":
        passes.give(f"/view/{name}", None)
    assert passes.holder(scope) is None
