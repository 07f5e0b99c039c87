"""Nothing large that a client sends is decoded by the event loop."""

import json
import logging
import threading
from concurrent.futures import ThreadPoolExecutor
from inspect import iscoroutinefunction
from pathlib import Path
from typing import Any

import pytest
from fastapi.routing import APIRoute
from fastapi.testclient import TestClient

from app.requests.base import RequestModel
from app.requests.charts import MAX_FIELD
from app.service import health
from app.service.api import routers
from app.service.identity import LOCAL_USER, current_user
from app.service.limits.user_limits import USER_LIMITS
from app.service.main import THREADS, THREADS_EACH
from app.service.store.database import Database
from app.service.web.bodies import (
    MAX_DECODED_BYTES,
    MAX_NAMES,
    MAX_VALUES,
    SMALL_BYTES,
    BoundedRoute,
)
from app.service.web.security import GONE
from tests.app.clients import limited, login, served, state_of
from tests.app.running import wait_until

PADDING = " " * SMALL_BYTES
WISH = {"chart": "KP\nPK", "material": "acrylic"}


def _padded(body: Any) -> bytes:
    """JSON that is too large to be decoded at once."""
    return json.dumps(body).encode() + PADDING.encode()


def _post(client: TestClient, path: str, content: bytes) -> Any:
    headers = {"Content-Type": "application/json"}
    return client.post(f"/api/v1/{path}", content=content, headers=headers)


def test_every_address_with_a_body_keeps_the_rule() -> None:
    routes = [route for router in routers() for route in router.routes]
    bodies = [route for route in routes if isinstance(route, APIRoute) and route.body_field]
    assert len(bodies) > 30
    assert [route.path for route in bodies if not isinstance(route, BoundedRoute)] == []


def test_every_address_that_takes_a_thread_takes_it_in_turn(client: TestClient) -> None:
    pages = client.app.routes  # type: ignore[attr-defined]
    routes = [*pages, *(r for router in (*routers(), health.router) for r in router.routes)]
    threaded = [
        r for r in routes if isinstance(r, APIRoute) and not iscoroutinefunction(r.endpoint)
    ]
    assert len(threaded) > 20
    assert [route.path for route in threaded if not isinstance(route, BoundedRoute)] == []


def test_one_user_leaves_threads_to_others_and_to_probes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    page, held, go_on = Database.page, list[str](), threading.Event()

    def slowly(*given: Any, **more: Any) -> Any:
        if current_user.get() == "ada":
            held.append("ada")
            go_on.wait(150)
        return page(*given, **more)

    monkeypatch.setattr(Database, "page", slowly)
    many = 2 * THREADS
    with served(require_login=True, data_dir=tmp_path) as client, ThreadPoolExecutor(many) as pool:
        ada, bob = login(client, "ada"), login(client, "bob")
        answers = [pool.submit(client.get, "/api/v1/designs", headers=ada) for _ in range(many)]
        wait_until(lambda: state_of(client).concurrency.held("connections", "ada") == many)
        assert client.get("/api/v1/designs", headers=bob).status_code == 200
        assert client.get("/readyz").status_code == 200
        assert len(held) == THREADS_EACH
        go_on.set()
        assert {answer.result().status_code for answer in answers} == {200}


def test_a_worker_decodes_a_large_request(client: TestClient, computed: list[Any]) -> None:
    small = client.post("/api/v1/predict", json=WISH)
    content = _padded(WISH)
    large = _post(client, "predict", content)
    (job,) = computed
    assert content in job
    assert not [argument for argument in job if isinstance(argument, RequestModel)]
    assert (large.status_code, large.json()) == (200, small.json())


@pytest.mark.parametrize(
    "body",
    [
        {"chart": "KP"},
        WISH | {"chart": {"fabric": "rib", "rows": 0, "columns": 2}},
        WISH | {"nope": 1},
        WISH | {"material": "nope"},
    ],
)
def test_faults_of_a_large_request_are_told_like_those_of_a_small_one(
    client: TestClient, body: Any
) -> None:
    small = client.post("/api/v1/predict", json=body).json()
    large = _post(client, "predict", _padded(body)).json()
    assert large["status"] == 422
    for part in ("detail", "field", "remedy", "errors"):
        assert large[part] == small[part]


@pytest.mark.parametrize("padding", ["", PADDING])
def test_what_is_no_request_is_told_by_the_service_and_by_a_worker(
    client: TestClient, padding: str
) -> None:
    for content, part, says in (
        ("[]", "remedy", "Send a JSON object"),
        ("{", "detail", "not valid JSON"),
    ):
        problem = _post(client, "predict", f"{content}{padding}".encode()).json()
        assert (problem["status"], problem["field"]) == (422, "body")
        assert says in problem[part]


def test_a_worker_decodes_a_large_job(client: TestClient, computed: list[Any]) -> None:
    file = {"name": "a.csv", "content": ""}
    wish = {"kind": "compression", "request": {"file": file}}
    content = _padded(wish)
    made = _post(client, "jobs", content)
    assert made.status_code == 202
    assert content in computed[0]
    assert client.get(made.headers["location"]).json()["kind"] == "compression"
    wrong = _post(client, "jobs", _padded(wish | {"request": {}}))
    assert (wrong.status_code, wrong.json()["field"]) == (422, "request.file")


def test_a_large_design_is_decoded_in_its_turn(client: TestClient, computed: list[Any]) -> None:
    body = {"name": "a", "material": "acrylic", "chart": "\n".join(["KP" * 200] * 200)}
    made = _post(client, "designs", _padded(body))
    assert (made.status_code, computed) == (201, [])
    assert client.delete(f"/api/v1/designs/{made.json()['id']}").status_code == 204


def test_no_design_is_larger_than_the_service_decodes(client: TestClient) -> None:
    content = b" " * (MAX_DECODED_BYTES + 1)

    def parts() -> Any:
        yield content

    headers = {"Content-Type": "application/json"}
    for sent in (content, parts()):
        refused = client.post("/api/v1/designs", content=sent, headers=headers)
        assert (refused.status_code, refused.json()["field"]) == (413, "body")


def test_a_field_of_as_many_values_as_a_view_takes_is_read(client: TestClient) -> None:
    field = {"values": [0.5] * MAX_FIELD, "low": 0.0, "high": 1.0}
    body = {**WISH, "colour": "field", "field": field}
    refused = client.put("/api/v1/views/a-field-too-large", json=body)
    assert refused.status_code == 422
    assert refused.json()["field"] == "field"  # of another size than KP/PK


def test_lists_in_lists_are_counted_as_values(client: TestClient) -> None:
    """They have few commas, and decoding millions of them takes seconds."""
    deep = 100
    nest = b"[" * deep + b"]" * deep
    body = b"[" + b",".join([nest] * (MAX_VALUES // deep)) + b"]"
    refused = _post(client, "designs", body)
    assert (refused.status_code, refused.json()["type"]) == (413, "/problems/refused")


def test_more_names_than_the_service_reads_are_refused(client: TestClient) -> None:
    body = json.dumps({str(number): 1 for number in range(MAX_NAMES + 1)}).encode()
    answer = _post(client, "designs", body)
    assert (answer.status_code, answer.json()["field"]) == (413, "body")
    assert str(MAX_NAMES) in answer.json()["detail"]


def test_open_bodies_of_one_user_are_bounded(client: TestClient) -> None:
    with limited(client, body_bytes=SMALL_BYTES) as limit:
        refused = _post(client, "predict", _padded(WISH))
        assert (refused.status_code, refused.json()["field"]) == (429, "body_bytes")
        assert limit.held("body_bytes", LOCAL_USER) == 0
        assert client.post("/api/v1/predict", json=WISH).status_code == 200
    assert USER_LIMITS.body_bytes >= 2 * state_of(client).settings.max_body_bytes


def test_a_client_that_goes_in_the_middle_of_a_body_is_no_error_of_the_service(
    client: TestClient, caplog: pytest.LogCaptureFixture
) -> None:
    coming = iter([{"type": "http.request", "body": b"{", "more_body": True}])

    async def receive() -> Any:
        return next(coming, {"type": "http.disconnect"})

    async def send(message: Any) -> None:
        sent.append(message)

    sent: list[Any] = []
    headers = [(b"host", b"127.0.0.1"), (b"content-length", b"900")]
    scope = {"type": "http", "method": "POST", "path": "/api/v1/predict", "headers": headers}
    scope |= {"query_string": b"", "scheme": "http", "http_version": "1.1"}
    assert client.portal is not None
    with caplog.at_level(logging.INFO):
        client.portal.call(client.app, scope, receive, send)
    assert (sent[0]["status"], sent[1]["body"]) == (GONE, b"")
    assert [record.levelname for record in caplog.records] == ["INFO"]


@pytest.mark.parametrize("padding", ["", PADDING])
@pytest.mark.parametrize("path", ["predict", "jobs", "designs"])
def test_a_name_that_comes_twice_is_refused(client: TestClient, path: str, padding: str) -> None:
    content = f'{{"chart": "K", "material": "cotton", "material": "acrylic"}}{padding}'
    answer = _post(client, path, content.encode())
    assert answer.status_code in {400, 422}
    assert "'material' comes twice" in answer.json()["detail"] or path == "jobs"
