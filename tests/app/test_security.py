from __future__ import annotations

import pytest
from click.testing import CliRunner
from fastapi.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from app.cli.main import main
from app.main import create_app
from app.settings import Settings
from knitcore import InputError

TOKEN = "a-long-enough-token"


def _guarded() -> TestClient:
    settings = Settings(host="0.0.0.0", token=TOKEN, allowed_hosts=("knit.example",), workers=1)
    return TestClient(create_app(settings), base_url="http://knit.example")


def test_beyond_loopback_a_token_is_demanded() -> None:
    with pytest.raises(InputError, match="KNITCORE_TOKEN"):
        create_app(Settings(host="0.0.0.0"))
    result = CliRunner().invoke(main, ["serve", "--host", "0.0.0.0"])
    assert result.exit_code == 2
    assert "KNITCORE_TOKEN" in result.output


def test_a_short_token_is_refused() -> None:
    with pytest.raises(InputError, match="too short"):
        create_app(Settings(token="short"))


def test_without_the_token_nothing_is_served() -> None:
    client = _guarded()
    for path in ("/", "/api/v1/patterns", "/static/index.html", "/docs"):
        response = client.get(path)
        assert response.status_code == 403
        assert "token" in response.json()["remedy"]
    assert client.get("/healthz").status_code == 200


def test_the_token_opens_as_header_and_as_link() -> None:
    client = _guarded()
    bearer = {"Authorization": f"Bearer {TOKEN}"}
    assert client.get("/api/v1/patterns", headers=bearer).status_code == 200
    wrong = {"Authorization": "Bearer another-long-token"}
    assert client.get("/api/v1/patterns", headers=wrong).status_code == 403

    link = client.get(f"/?token={TOKEN}", follow_redirects=False)
    assert link.status_code == 303
    assert TOKEN not in link.headers["location"]
    assert "httponly" in link.headers["set-cookie"].lower()
    client.cookies.set("knitcore_token", TOKEN)
    assert client.get("/api/v1/patterns").status_code == 200


def test_unknown_hosts_are_refused(client: TestClient) -> None:
    assert client.get("/", headers={"Host": "evil.example"}).status_code == 400
    assert client.get("/", headers={"Host": "["}).status_code == 400
    assert client.get("/", headers={"Host": "localhost:8737"}).status_code == 200


def test_changes_from_another_site_are_refused(client: TestClient) -> None:
    body = {"text": "KP"}
    evil = client.post("/api/v1/charts/parse", json=body, headers={"Origin": "http://evil.example"})
    assert evil.status_code == 403
    own = client.post("/api/v1/charts/parse", json=body, headers={"Origin": "http://127.0.0.1"})
    assert own.status_code == 200


def test_websockets_from_another_site_are_refused(client: TestClient) -> None:
    with (
        pytest.raises(WebSocketDisconnect),
        client.websocket_connect(
            "ws://127.0.0.1/view/abcdefgh", headers={"Origin": "http://evil.example"}
        ),
    ):
        pass


def test_large_bodies_are_refused(client: TestClient) -> None:
    response = client.post("/api/v1/charts/parse", content=b"x" * 5_000_000)
    assert response.status_code == 413
    assert response.json()["field"] == "body"


def test_every_response_carries_the_headers(client: TestClient) -> None:
    for path in ("/", "/api/v1/patterns", "/nowhere"):
        headers = client.get(path).headers
        assert "frame-ancestors 'self'" in headers["content-security-policy"]
        assert headers["x-content-type-options"] == "nosniff"
    view = client.get("/view/abcdefgh/").headers["content-security-policy"]
    assert "connect-src 'self' data: blob:" in view  # ?websocket=ws://elsewhere is not obeyed
