"""Who is signed in: seen, listed, ended, and never replaced without a click."""

import re
import time
from collections.abc import Iterator
from pathlib import Path

import pytest
from fastapi.testclient import TestClient

from app.service import main as main_module
from app.service.store.database import Database
from app.service.web import security, sessions
from app.service.web.sessions import MAX_SESSIONS, NewToken, Sessions
from tests.app.clients import LONG, bearing, drain, served, state_of, tokens_of, watching
from tests.app.conftest import MOSTLY_SQLITE
from tests.app.rest import draw
from tests.app.running import wait_until

SESSION = "/api/v1/session"


@pytest.fixture(params=MOSTLY_SQLITE)
def database(request: pytest.FixtureRequest) -> Database:
    """An empty database with its tables."""
    database: Database = request.getfixturevalue(f"{request.param}_database")
    return database


@pytest.fixture
def lab(
    tmp_path: Path, database: Database, monkeypatch: pytest.MonkeyPatch
) -> Iterator[TestClient]:
    """A service with logins that looks every instant whether they still hold."""
    for module in (security, sessions, main_module):
        monkeypatch.setattr(module, "REMEMBERED_S", 0.05)
    with served(database=database, require_login=True, data_dir=tmp_path) as client:
        yield client


def test_a_signed_in_user_is_seen_and_signs_out(
    lab: TestClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    lab.get(f"/?token={tokens_of(lab).create('ada').token}")
    seen = lab.get(SESSION).json()
    assert seen["user"] == "ada"
    assert [session["is_this"] for session in seen["sessions"]] == [True]
    cookies = dict(lab.cookies)
    end = Sessions.end

    def ended_and_looked_at(*given: str) -> bool:
        ended = end(*given)  # type: ignore[arg-type]
        time.sleep(3 * security.REMEMBERED_S)  # the guard looks before the answer is sent
        return ended

    monkeypatch.setattr(Sessions, "end", ended_and_looked_at)
    assert lab.delete(SESSION).status_code == 204
    assert lab.get(SESSION).status_code == 401
    lab.cookies.update(cookies)  # a copy of the cookie opens nothing either
    assert lab.get(SESSION).status_code == 401


def test_sessions_are_ended_one_by_one_and_by_their_user_only(lab: TestClient) -> None:
    ada, bob = tokens_of(lab).create("ada"), tokens_of(lab).create("bob")
    for _ in range(2):
        lab.get(f"/?token={ada.token}")
        lab.cookies.clear()
    first, second = (
        s["id"] for s in lab.get(SESSION, headers=bearing(ada.token)).json()["sessions"]
    )
    address = f"/api/v1/sessions/{first}"
    assert lab.delete(address, headers=bearing(bob.token)).status_code == 404
    assert lab.delete(address, headers=bearing(ada.token)).status_code == 204
    left = lab.get(SESSION, headers=bearing(ada.token)).json()["sessions"]
    assert [session["id"] for session in left] == [second]


@pytest.mark.parametrize("led_by", ["cross-site", "same-site"])
def test_a_link_from_another_site_needs_a_click_to_sign_in(lab: TestClient, led_by: str) -> None:
    mallory = tokens_of(lab).create("mallory")
    headers = {"Sec-Fetch-Site": led_by}
    page = lab.get(f"/?token={mallory.token}", headers=headers)
    assert page.status_code == 200
    assert "Sign in as mallory?" in page.text
    assert "set-cookie" not in page.headers
    assert "form-action 'self'" in page.headers["content-security-policy"]
    assert page.headers["referrer-policy"] == "same-origin"


def test_a_session_is_replaced_by_a_click_only(lab: TestClient) -> None:
    alice, mallory = tokens_of(lab).create("alice"), tokens_of(lab).create("mallory")
    lab.get(f"/?token={alice.token}")
    page = lab.get(f"/?token={mallory.token}")
    assert "instead of <strong>alice</strong>" in page.text
    assert lab.get(SESSION).json()["user"] == "alice"
    fields = dict(re.findall(r'name="(\w+)" value="([^"]*)"', page.text))
    other_site = {"Origin": "https://evil.example"}
    assert lab.post("/sign-in", data=fields, headers=other_site).status_code == 403
    assert lab.get(SESSION).json()["user"] == "alice"
    clicked = lab.post("/sign-in", data=fields, follow_redirects=False)
    assert (clicked.status_code, clicked.headers["location"]) == (303, "/")
    assert lab.get(SESSION).json()["user"] == "mallory"
    again = lab.get(f"/?token={mallory.token}", follow_redirects=False)
    assert again.status_code == 303  # one's own link asks nothing


def test_a_person_without_a_session_is_asked_for_a_token(lab: TestClient) -> None:
    page = lab.get("/", headers={"Accept": "text/html,*/*;q=0.8"})
    assert page.status_code == 401
    assert "form-action 'self'" in page.headers["content-security-policy"]
    assert re.search(r'<input type="password" name="token"', page.text)
    wrong = lab.post("/sign-in", data={"token": "x" * 43})
    assert (wrong.status_code, "This token is unknown" in wrong.text) == (401, True)
    assert lab.post("/sign-in", content=b"x" * 9_000).status_code == 401
    token = tokens_of(lab).create("ada").token
    right = lab.post("/sign-in", data={"token": token}, follow_redirects=False)
    assert (right.status_code, right.headers["location"]) == (303, "/")
    assert lab.get(SESSION).json()["user"] == "ada"


def _with_a_view(lab: TestClient) -> NewToken:
    """Ada's token, with which the client then asks, and has opened a view."""
    ada = tokens_of(lab).create("ada")
    lab.headers.update(bearing(ada.token))
    draw(lab, "a-view")
    return ada


def test_a_revoked_token_ends_views_and_jobs(lab: TestClient) -> None:
    ada = _with_a_view(lab)
    job = lab.post("/api/v1/jobs", json={"kind": "stretch", "request": LONG}).json()["id"]
    with watching(lab, "/view/a-view") as socket:
        tokens_of(lab).revoke(ada.id)
        assert drain(socket) == 1008
    runner = state_of(lab).jobs
    wait_until(lambda: runner.store.get("ada", job).state == "cancelled")
    assert lab.get(SESSION).status_code == 401


def test_a_revoked_token_ends_an_event_stream(lab: TestClient) -> None:
    ada = _with_a_view(lab)
    with lab.stream("GET", "/api/v1/views/a-view/events") as stream:
        tokens_of(lab).revoke(ada.id)
        assert "retry" in "".join(stream.iter_text())  # and then it ended


def test_the_oldest_of_too_many_sessions_end(lab: TestClient) -> None:
    ada, bob = tokens_of(lab).create("ada"), tokens_of(lab).create("bob")
    sessions = Sessions(state_of(lab).database)
    other = sessions.begin(bob.id, "bob")
    begun = [sessions.begin(ada.id, "ada") for _ in range(MAX_SESSIONS + 3)]
    assert [session.id for session in sessions.of("ada", "")][::-1] == begun[3:]
    assert sessions.find(begun[0]) == ("", "")
    assert sessions.find(other) == (bob.id, "bob")
