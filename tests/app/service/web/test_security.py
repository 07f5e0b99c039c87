import asyncio
import logging
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import pytest
from fastapi.testclient import TestClient
from itsdangerous import URLSafeTimedSerializer

from app.service.main import THREADS, create_app
from app.service.settings import Settings
from app.service.web import security
from app.service.web.bodies import MAX_VALUES
from app.service.web.security import (
    LOGIN_FAILURES,
    PAGE_POLICY,
    AccessControl,
    with_own_cookie_only,
)
from app.service.web.sessions import Login, NotRememberedError, Tokens
from app.viewer import relay
from knitcore import InputError
from tests.app.clients import bearing, closed_with, login, served, state_of, tokens_of, watching
from tests.app.command_line import printed, refused, run
from tests.app.running import wait_until

TOKEN = "a-long-enough-token"
PATTERNS = "/api/v1/patterns"

guarded_service = partial(
    served, "http://knit.example", host="0.0.0.0", allowed_hosts=("knit.example",)
)


@pytest.fixture(scope="module")
def guarded() -> Iterator[TestClient]:
    with guarded_service(token=TOKEN) as client:
        yield client


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> Iterator[TestClient]:
    """A service where everybody has a token of their own."""
    with guarded_service(require_login=True, data_dir=tmp_path_factory.mktemp("lab")) as client:
        yield client


def test_requests_that_come_at_once_look_for_their_login_once() -> None:
    looks = list[bool]()

    def login(*, at_once: bool = False) -> str:
        if not looks and at_once:
            raise NotRememberedError("ada")
        looks.append(at_once)
        return "ada"

    async def come() -> list[str]:
        control = AccessControl(lambda *_: None, Settings(require_login=True))  # type: ignore[arg-type]
        return await asyncio.gather(*(control._known({}, login) for _ in range(9)))

    assert asyncio.run(come()) == 9 * ["ada"]
    assert looks.count(False) == 1


def test_beyond_loopback_a_token_is_demanded() -> None:
    with pytest.raises(InputError, match="KNITCORE_TOKEN"):
        create_app(Settings(host="0.0.0.0"))
    assert "KNITCORE_TOKEN" in refused("serve", "--host", "0.0.0.0")


def test_a_short_token_is_refused() -> None:
    for token in ("short", " " * 16):
        with pytest.raises(InputError, match="too short"):
            create_app(Settings(token=token))


def test_without_the_token_nothing_is_served(guarded: TestClient) -> None:
    for path in ("/", PATTERNS, "/static/index.html", "/docs", "/openapi.json", "/metrics"):
        response = guarded.get(path)
        assert response.status_code == 401
        assert response.headers["WWW-Authenticate"].startswith("Bearer")
        assert guarded.get(response.json()["type"]).status_code == 200
        assert "token" in response.json()["remedy"]
    for path in ("/healthz", "/readyz"):
        assert guarded.get(path).status_code == 200


def test_the_token_opens_as_header_and_as_link(guarded: TestClient) -> None:
    assert guarded.get("/api/v1/patterns", headers=bearing(TOKEN)).status_code == 200
    wrong = bearing("another-long-token")
    assert guarded.get("/api/v1/patterns", headers=wrong).status_code == 401

    link = guarded.get(f"/?token={TOKEN}", follow_redirects=False)
    assert link.status_code == 303
    assert TOKEN not in link.headers["location"]
    cookie = link.headers["set-cookie"]
    assert TOKEN not in cookie
    assert {"httponly", "samesite=strict"} <= {p.strip().lower() for p in cookie.split(";")}
    assert guarded.get("/api/v1/patterns").status_code == 200  # by the session
    guarded.cookies.clear()


def test_a_link_with_a_token_leads_nowhere_else(guarded: TestClient) -> None:
    link = guarded.get(f"http://knit.example//evil.example/?token={TOKEN}", follow_redirects=False)
    assert link.headers["location"] == "/evil.example/"
    guarded.cookies.clear()


@pytest.fixture(autouse=True)
def soon_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """Requests that come too often are refused after a moment."""
    monkeypatch.setattr(security, "REFUSED_AFTER_S", 0.02)


@pytest.mark.parametrize("cookie", ["nonsense", "W10.x.y", "", '"', None])
def test_a_forged_session_opens_nothing(guarded: TestClient, cookie: str | None) -> None:
    guessed = URLSafeTimedSerializer("guessed", salt="knitcore session").dumps(["environment", ""])
    headers = {"Cookie": f"knitcore_session={guessed if cookie is None else cookie}"}
    assert guarded.get("/api/v1/patterns", headers=headers).status_code == 401


def test_another_token_in_the_settings_ends_sessions(tmp_path: Path) -> None:
    with guarded_service(token=TOKEN, data_dir=tmp_path) as client:
        client.get(f"/?token={TOKEN}")
        cookies = dict(client.cookies)
        assert client.get("/api/v1/patterns").status_code == 200
    with guarded_service(token="another-long-enough-one", data_dir=tmp_path) as client:
        client.cookies.update(cookies)
        assert client.get("/api/v1/patterns").status_code == 401


def test_wrong_tokens_are_slowed_down_and_lock_out_no_user() -> None:
    with guarded_service(token=TOKEN) as client:
        answers = [client.get("/api/v1/patterns", headers=bearing(f"guess-{n}")) for n in range(25)]
        codes = [answer.status_code for answer in answers]
        assert codes == [401] * LOGIN_FAILURES + [429] * (25 - LOGIN_FAILURES)
        assert answers[-1].headers["retry-after"] == "10"
        assert client.get("/api/v1/patterns", headers=bearing(TOKEN)).status_code == 200
        assert client.get("/api/v1/patterns").status_code == 401  # who has no token is told so


def test_wrong_tokens_of_a_neighbour_close_no_session() -> None:
    with guarded_service(token=TOKEN) as client:
        client.get(f"/?token={TOKEN}")
        cookies = dict(client.cookies)
        client.cookies.clear()
        for n in range(25):
            last = client.get("/api/v1/patterns", headers=bearing(f"guess-{n}"))
        assert last.status_code == 429
        client.cookies.update(cookies)
        assert client.get("/api/v1/patterns").status_code == 200
        wrong = client.get("/api/v1/patterns", headers=bearing("guess"))
        assert wrong.status_code == 429  # who brings a token is not let in by a session


@pytest.mark.parametrize("remembered_s", [0.0, 1000.0])
def test_wrong_tokens_are_looked_up_one_by_one_and_hold_up_no_user(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, remembered_s: float
) -> None:
    monkeypatch.setattr("app.service.web.sessions.REMEMBERED_S", remembered_s)
    find, by_token, go_on = Tokens.find, Login.by_token, threading.Event()
    came, looked_up = list[str](), list[str]()

    def found_slowly(tokens: Tokens, **which: str) -> tuple[str, str]:
        user = find(tokens, **which)
        if not user[1]:
            looked_up.append(which["hashed"])
            go_on.wait(150)
        return user

    def noted(login: Login, token: str, *, at_once: bool = False) -> tuple[str, str]:
        came.append(token)
        return by_token(login, token, at_once=at_once)

    many = 2 * THREADS
    with guarded_service(require_login=True, data_dir=tmp_path) as lab:
        ada = login(lab, "ada")
        assert lab.get(PATTERNS, headers=ada).status_code == 200
        monkeypatch.setattr(Tokens, "find", found_slowly)
        monkeypatch.setattr(Login, "by_token", noted)
        with ThreadPoolExecutor(many) as strangers:
            tries = [
                strangers.submit(lab.get, PATTERNS, headers=bearing(f"{n}")) for n in range(many)
            ]
            wait_until(lambda: len(set(came)) == many and looked_up)
            assert lab.get(PATTERNS, headers=ada).status_code == 200
            assert len(looked_up) == 1
            go_on.set()
            assert {attempt.result().status_code for attempt in tries} == {401}


def test_wrong_tokens_make_no_user_forgotten(
    lab: TestClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.service.web.sessions.MAX_REMEMBERED", 2)
    monkeypatch.setattr("app.service.web.sessions.REMEMBERED_S", 1000.0)
    users: Login = state_of(lab).login
    ada = tokens_of(lab).create("ada")
    assert users.by_token(ada.token) == (ada.id, "ada")
    assert {users.by_token(f"wrong {n}") for n in range(5)} == {("", "")}
    assert users.by_token(ada.token, at_once=True) == (ada.id, "ada")


def test_users_see_only_their_own(lab: TestClient) -> None:
    ada, bob = (login(lab, name) for name in ("ada", "bob"))
    design = {"name": "secret", "material": "acrylic", "chart": "KP"}
    made = lab.post("/api/v1/designs", json=design, headers=ada).json()["id"]
    assert lab.get(f"/api/v1/designs/{made}", headers=ada).status_code == 200
    for method, path in (
        ("GET", ""),
        ("DELETE", ""),
        ("POST", "/duplicate"),
        ("POST", "/recover"),
        ("GET", "/versions"),
        ("GET", "/shares"),
    ):
        answer = lab.request(method, f"/api/v1/designs/{made}{path}", headers=bob)
        assert answer.status_code == 404
    assert lab.get("/api/v1/designs", headers=bob).json()["designs"] == []

    wish = {"chart": "KP\nPK", "material": "acrylic", "direction": "wale", "strain": 0.1}
    body = {"kind": "stretch", "request": wish | {"steps": 1}}
    job = lab.post("/api/v1/jobs", json=body, headers=ada).json()["id"]
    for path in ("", "/events", "/result"):
        assert lab.get(f"/api/v1/jobs/{job}{path}", headers=bob).status_code == 404

    share = lab.post(f"/api/v1/designs/{made}/shares", json={}, headers=ada).json()["token"]
    assert lab.get(f"/api/v1/shared/{share}", headers=bob).json()["document"]["name"] == "secret"
    assert lab.get(f"/api/v1/shared/{share}").status_code == 401


def test_views_are_private_too(lab: TestClient, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(relay, "OPENING_S", 0.1)
    ada, bob = (login(lab, name) for name in ("ada", "bob"))
    body = {"chart": "KP", "material": "acrylic"}
    assert lab.put("/api/v1/views/one-name", json=body, headers=ada).status_code == 200
    assert closed_with(lab, "/view/one-name", **bob) == 1013
    assert closed_with(lab, "/view/one-name") == 1008
    with watching(lab, "/view/one-name", **ada) as socket:
        assert socket.receive_bytes()


def test_tokens_are_revoked_expire_and_are_kept_as_hashes(
    lab: TestClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("app.service.web.sessions.REMEMBERED_S", 0.0)
    tokens = tokens_of(lab)
    made, short = tokens.create("eve", "laptop"), tokens.create("eve", days=1e-9)
    assert lab.get("/api/v1/patterns", headers=bearing(made.token)).status_code == 200
    assert lab.get("/api/v1/patterns", headers=bearing(short.token)).status_code == 401
    lab.get(f"/?token={made.token}")
    assert lab.get("/api/v1/patterns").status_code == 200
    tokens.revoke(made.id)
    assert lab.get("/api/v1/patterns", headers=bearing(made.token)).status_code == 401
    assert lab.get("/api/v1/patterns").status_code == 401  # the session ends with its token
    lab.cookies.clear()
    with state_of(lab).database.read() as connection:
        kept = str(connection.exec_driver_sql("SELECT * FROM access_tokens").all())
    assert "laptop" in kept
    assert made.token not in kept


def test_the_token_command(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("KNITCORE_DATA_DIR", str(tmp_path))
    token = run("token", "create", "ada", "--label", "lab")
    assert len(token["token"]) > 40
    listed = printed("token", "list").stdout
    assert token["id"] in listed
    assert token["token"] not in listed
    printed("token", "revoke", token["id"])
    for arguments in (["revoke", token["id"]], ["create", "local"], ["create", "a b"]):
        assert refused("token", *arguments)


def test_a_client_over_its_rate_learns_when_to_retry(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(
        "app.service.limits.user_limits.time", SimpleNamespace(monotonic=lambda: 100.0)
    )
    with guarded_service(require_login=True, data_dir=tmp_path, requests_per_s=0.5) as client:
        ada, bob = (login(client, name) for name in ("ada", "bob"))
        first = client.get("/api/v1/patterns", headers=ada).headers
        assert (first["ratelimit-limit"], first["ratelimit-remaining"]) == ("2", "1")
        client.get("/api/v1/patterns", headers=ada)
        begun = time.monotonic()
        late = client.get("/api/v1/patterns", headers=ada)
        assert time.monotonic() - begun >= security.REFUSED_AFTER_S
        assert (late.status_code, late.json()["type"]) == (429, "/problems/too-many")
        assert late.headers["retry-after"] == "2"
        assert client.get("/api/v1/patterns", headers=bob).status_code == 200


@pytest.mark.parametrize(
    ("hosts", "status"),
    [(("127.0.0.1", "evil.example"), 400), (("evil.example",), 400), (("[",), 400),
     (("localhost:8737",), 200)],
)  # fmt: skip
def test_unknown_hosts_and_two_of_them_are_refused(
    client: TestClient, hosts: tuple[str, ...], status: int
) -> None:
    assert client.get("/", headers=[("Host", host) for host in hosts]).status_code == status


@pytest.mark.parametrize("origin", ["http://evil.example", "null", "", "http://[", "http://[::1"])
def test_changes_from_another_site_are_refused(client: TestClient, origin: str) -> None:
    for site, status in ((origin, 403), ("http://127.0.0.1", 200)):
        headers = {"Origin": site}
        answer = client.post("/api/v1/charts/parse", json={"text": "KP"}, headers=headers)
        assert answer.status_code == status


def test_websockets_from_another_site_are_refused(client: TestClient) -> None:
    assert closed_with(client, "/view/abcdefgh", Origin="http://evil.example") == 1008


@pytest.mark.parametrize("is_sized", [True, False])
def test_large_bodies_are_refused_even_if_they_hide_their_size(
    client: TestClient, is_sized: bool
) -> None:
    part = b"x" * 1_000_000
    content = 33 * part if is_sized else iter([part] * 33)
    response = client.post("/api/v1/charts/parse", content=content)
    assert (response.status_code, response.json()["field"]) == (413, "body")


def test_bodies_of_more_values_than_can_be_read_at_once_are_refused(client: TestClient) -> None:
    runs = [
        {"id": f"r{n}", "name": "r", "colour": "#112233", "runs": [[0, 0, 1]] * 50_000}
        for n in range(2)
    ]
    body = {"name": "a", "material": "acrylic", "chart": "K", "regions": runs}
    response = client.post("/api/v1/designs", json=body)
    assert (response.status_code, response.json()["type"]) == (413, "/problems/refused")
    assert str(MAX_VALUES) in response.json()["detail"]


def test_every_response_carries_the_headers(client: TestClient) -> None:
    for path in ("/", "/api/v1/patterns", "/nowhere"):
        headers = client.get(path).headers
        assert "frame-ancestors 'self'" in headers["content-security-policy"]
        assert headers["x-content-type-options"] == "nosniff"
    view = client.get("/view/abcdefgh/").headers["content-security-policy"]
    assert "connect-src 'self' data: blob:" in view  # ?websocket=ws://elsewhere is not obeyed
    assert "allow-same-origin" not in next(p for p in view.split("; ") if p.startswith("sandbox"))


def test_no_text_becomes_a_script_in_a_view(client: TestClient) -> None:
    """viser can tell its page to run a text as a script; the policy refuses that."""
    policy = client.get("/view/a-design-of-mine/").headers["content-security-policy"]
    scripts = next(part for part in policy.split("; ") if part.startswith("script-src"))
    assert "'unsafe-eval'" not in scripts.split()


def test_an_unexpected_error_carries_the_headers_and_no_secret_to_the_log(
    caplog: pytest.LogCaptureFixture,
) -> None:
    app = create_app(Settings(workers=1))

    @app.get("/api/v1/shared/{token}/broken")
    def broken(token: str) -> None:
        raise ZeroDivisionError

    with TestClient(app, base_url="http://127.0.0.1", raise_server_exceptions=False) as client:
        answer = client.get("/api/v1/shared/a-secret-link/broken", headers={"X-Request-ID": "r-7"})
    assert (answer.status_code, answer.json()["type"]) == (500, "/problems/internal")
    assert answer.headers["X-Request-ID"] == "r-7"
    assert answer.headers["Content-Security-Policy"] == PAGE_POLICY
    ours = [record for record in caplog.records if record.name.startswith("knitcore")]
    logged = "\n".join(map(logging.Formatter().format, ours))  # without the test client's
    assert "ZeroDivisionError" in logged
    assert "a-secret-link" not in logged


def test_only_the_own_cookie_is_read() -> None:
    """Python's reader takes time that grows with the square of a quoted cookie's length."""
    own, other = b"knitcore_session=abc", b'theme="\\\\\\\\"'
    kept = with_own_cookie_only([(b"host", b"h"), (b"cookie", other + b"; " + own)])
    assert kept == [(b"host", b"h"), (b"cookie", own)]
    for unread in (other, b'knitcore_session="\\\\"'):
        assert with_own_cookie_only([(b"cookie", unread)]) == []
