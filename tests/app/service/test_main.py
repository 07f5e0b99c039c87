"""Things that operators rely on: logs, health, metrics, shutdown."""

import json
import logging
import threading
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from types import SimpleNamespace

import httpx2 as httpx
import pytest
from fastapi.testclient import TestClient
from itsdangerous import timed
from prometheus_client.parser import text_string_to_metric_families
from sqlalchemy import select

from app.service import VERSION, doctor, health
from app.service.designs.conditions import Retry, forget_old_keys
from app.service.jobs.document import JobState
from app.service.jobs.store import JobStore
from app.service.main import THREADS
from app.service.settings import Settings
from app.service.store import tables
from app.service.store.database import Database
from app.service.store.tables import results
from app.service.web.observing import JsonLines, TextLines, configure_logging
from app.service.web.sessions import Login, Sessions, Tokens
from tests.app.clients import LONG, bearing, closed_with, login, served, state_of
from tests.app.databases import sqlite
from tests.app.running import Service, wait_until


@pytest.fixture
def lines(caplog: pytest.LogCaptureFixture) -> Iterator[list[dict[str, object]]]:
    written: list[dict[str, object]] = []
    handler = logging.Handler()
    handler.emit = lambda record: written.append(json.loads(JsonLines().format(record)))  # type: ignore[method-assign]
    logger = logging.getLogger("knitcore.access")
    logger.addHandler(handler)
    with caplog.at_level(logging.INFO, "knitcore.access"):
        yield written
    logger.removeHandler(handler)


def test_every_request_is_a_json_line_with_its_id(
    client: TestClient, lines: list[dict[str, object]]
) -> None:
    answer = client.get("/api/v1/patterns", headers={"X-Request-ID": "from-the-proxy.1"})
    assert answer.headers["x-request-id"] == "from-the-proxy.1"
    (line,) = lines
    assert line["request_id"] == "from-the-proxy.1"
    assert (line["method"], line["path"], line["status"]) == ("GET", "/api/v1/patterns", 200)
    assert line["user"] == "local"
    assert float(str(line["ms"])) > 0
    made = client.get("/api/v1/patterns", headers={"X-Request-ID": "no good\tid"})
    assert len(made.headers["x-request-id"]) == 16


def test_no_secret_is_in_the_log(client: TestClient, lines: list[dict[str, object]]) -> None:
    secret = "s3cret" * 6
    client.get(f"/api/v1/shared/{secret}")
    client.get(f"/?token={secret}")
    client.get("/api/v1/patterns", headers={"Authorization": f"Bearer {secret}"})
    client.get("/a%0aforged%0d%1b[2J line")
    assert len(lines) == 4
    assert secret not in json.dumps(lines)
    assert str(lines[-1]["path"]).isprintable()


def test_lines_for_people_name_the_request() -> None:
    record = logging.LogRecord("knitcore", logging.INFO, "", 0, "job done", None, None)
    record.job = "j1"
    assert TextLines().format(record).endswith("knitcore job done job=j1")
    assert json.loads(JsonLines().format(record))["job"] == "j1"


def test_logging_goes_to_stderr(capsys: pytest.CaptureFixture[str]) -> None:
    root = logging.getLogger()
    before = root.handlers[:], root.level
    try:
        configure_logging("json")
        logging.getLogger("knitcore.test").info("hello")
        assert json.loads(capsys.readouterr().err)["message"] == "hello"
    finally:
        root.handlers[:], root.level = before


def test_metrics_count_by_route_and_not_by_address(client: TestClient) -> None:
    for number in range(3):
        client.get(f"/api/v1/designs/no-such-design-{number}")
    client.get("/nowhere/at/all")
    numbers = client.get("/metrics").text
    families = {f.name: f for f in text_string_to_metric_families(numbers)}
    counted = {
        s.labels["route"]: s.value
        for s in families["knitcore_requests"].samples
        if s.name.endswith("_total") and (s.labels["method"], s.labels["status"]) == ("GET", "404")
    }
    assert counted["/designs/{design}"] >= 3
    assert counted["other"] >= 1
    assert not any("no-such-design" in route for route in counted)
    for name in ("views_open", "jobs_waiting", "jobs_running", "computations_waiting"):
        assert families[f"knitcore_{name}"].samples[0].value >= 0
    assert "process_resident_memory_bytes" in families
    assert f'knitcore_info{{version="{VERSION}"}} 1.0' in numbers


def test_metrics_are_for_the_operator(tmp_path: Path) -> None:
    with served(require_login=True, token="operator" * 4, data_dir=tmp_path) as client:
        for header, status in ((login(client, "ada"), 403), (bearing("operator" * 4), 200)):
            assert client.get("/metrics", headers=header).status_code == status


def test_a_websocket_is_a_line_too_and_refused_users_have_no_name(
    tmp_path: Path, lines: list[dict[str, object]]
) -> None:
    with served(require_login=True, data_dir=tmp_path) as client:
        assert closed_with(client, "/view/a-view") == 1008
        client.get("/api/v1/designs")
    assert [(line["message"], line["status"], line["user"]) for line in lines] == [
        ("websocket", 1008, "-"),
        ("request", 401, "-"),
    ]


def test_readyz_makes_the_checks_of_the_doctor(client: TestClient) -> None:
    ready = client.get("/readyz").json()
    assert ready["status"] == "ok"
    with state_of(client).database.reserved("main"):
        checks = doctor.examine(Settings()).checks
    assert ready["checks"] | {"service": True} == {check.name: check.ok for check in checks}


def test_a_lost_database_is_reported_and_found_again(tmp_path: Path) -> None:
    design = {"name": "a", "material": "acrylic", "chart": "KP"}
    file, away = tmp_path / "knitcore.sqlite3", tmp_path / "away"
    with served(data_dir=tmp_path) as client:

        def unavailable(words: str) -> None:
            for answer in (client.get("/readyz"), client.post("/api/v1/designs", json=design)):
                assert answer.status_code == 503
                assert words in answer.json()["detail"]
                assert answer.json()["remedy"]

        file.rename(away)
        unavailable("is gone")
        assert client.get("/healthz").status_code == 200
        assert client.get("/api/v1/patterns").status_code == 200
        assert not file.exists()  # no empty database in the place of the lost one
        file.touch()
        unavailable("was replaced")
        assert file.stat().st_size == 0
        file.unlink()
        away.rename(file)
        assert client.get("/readyz").status_code == 200
        assert client.post("/api/v1/designs", json=design).status_code == 201


def test_the_clock_of_a_host_ends_nothing_early(
    database: Database, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The database's clock writes every time that is compared with it."""
    store, tokens, sessions = JobStore(database, "main"), Tokens(database), Sessions(database)
    retry = Retry.of("ada", "a key", "a request")
    monkeypatch.setattr(tables, "time", SimpleNamespace(time=lambda: 0.0))
    with monkeypatch.context() as ahead:
        ahead.setattr(timed, "time", SimpleNamespace(time=lambda: 9e9))
        token = tokens.create("ada", days=1)
        cookie = Login(tokens, sessions, None).begin(token.id, "ada")
    job = store.add("ada", "work", "{}", "k", JobState.WAITING, retry=retry)
    assert JobStore(database, "another").adopt_orphans() == []
    assert store.finish(job.id, "work", "k", b"body")
    store.tidy(100)
    forget_old_keys(database)
    sessions.tidy()
    assert Login(tokens, sessions, None).by_session(cookie)[1] == "ada"
    assert tokens.find(identifier=token.id) == (token.id, "ada")
    assert store.get("ada", job.id).state is JobState.DONE
    again = store.add("ada", "work", "{}", "k", JobState.WAITING, retry=retry)
    assert again.id == job.id
    with database.read() as connection:
        assert abs(connection.execute(select(results.c.used_at)).scalar_one() - time.time()) < 3600


@pytest.mark.parametrize("busy", ["threads of requests", "the writer", "a login"])
def test_readiness_waits_for_what_requests_wait_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, busy: str
) -> None:
    """`/healthz` needs none of it."""
    monkeypatch.setattr(health, "PATIENCE_S", 0.3)
    go_on = threading.Event()

    def wait(*_: object, **__: object) -> None:
        go_on.wait(150)

    with served(data_dir=tmp_path) as client, ThreadPoolExecutor(THREADS) as others:
        state = state_of(client)
        if busy == "threads of requests":
            monkeypatch.setattr(type(state.database), "page", wait)
            held = [others.submit(client.get, "/api/v1/designs") for _ in range(THREADS)]
            wait_until(lambda: client.get("/readyz").status_code == 503)
        elif busy == "the writer":
            held = [others.submit(state.database.write, wait)]
        else:
            monkeypatch.setattr(health.Tokens, "find", wait)
            held = []
        answer = client.get("/readyz")
        assert (answer.status_code, "thread" in answer.json()["detail"]) == (503, True)
        assert client.get("/healthz").status_code == 200
        go_on.set()
        for each in held:
            each.exception()
        monkeypatch.undo()
        assert client.get("/readyz").status_code == 200


@pytest.mark.slow
def test_a_stop_keeps_jobs_and_ends_streams(tmp_path: Path) -> None:
    service = Service(tmp_path, log_format="json")
    client = service.start()
    job = client.post("/api/v1/jobs", json={"kind": "stretch", "request": LONG}).json()["id"]
    heard: list[str] = []

    def listen() -> None:
        try:
            with client.stream("GET", f"/api/v1/jobs/{job}/events") as stream:
                heard.extend(line for line in stream.iter_lines() if line.startswith("data"))
        except httpx.TransportError:
            heard.append("the stream ended")

    with ThreadPoolExecutor(2) as pool:
        listening = pool.submit(listen)
        stretching = pool.submit(client.post, "/api/v1/stretch", json=LONG)
        waits = "knitcore_computations_waiting 1.0"
        wait_until(lambda: heard and waits in client.get("/metrics").text)
        assert service.stop() == 0
        listening.result(60)
        answer = stretching.result(60)
    client.close()
    assert (answer.status_code, answer.json()["detail"]) == (503, "The service is stopping.")
    with sqlite(tmp_path / "data" / "knitcore.sqlite3") as connection:
        assert connection.execute("SELECT state FROM jobs").fetchall() == [("waiting",)]
    log = [json.loads(line) for line in service.log.read_text().splitlines()]
    assert {"request", "job waits"} <= {line["message"] for line in log}
    assert not [line for line in log if line["level"] == "error"]
