"""Failures around the service: its disk, its database, its clients. Nothing is lost by it.

KNITCORE_OUTAGE_S sets how long the database is away, and KNITCORE_KILLS how often the service is
killed (``make test-hard``: 30 s and 50 times).
"""

import contextlib
import json
import os
import random
import socket
import subprocess
import time
from collections.abc import Iterator
from pathlib import Path

import httpx2 as httpx
import pytest
import viser
import websockets.sync.client

from tests.app.clients import LONG
from tests.app.databases import away, is_whole
from tests.app.painter import Painter, painting, until_painted
from tests.app.running import Service, knitcore, wait_until

pytestmark = pytest.mark.slow

OUTAGE_S = float(os.environ.get("KNITCORE_OUTAGE_S", "1"))
KILLS = int(os.environ.get("KNITCORE_KILLS", "1"))
PAINTERS = 4
JOBS = "/api/v1/jobs"
SHORT = LONG | {"chart": {"fabric": "garter", "columns": 20, "rows": 20}, "steps": 8}


@pytest.mark.timeout(600 + 60 * KILLS)
def test_no_acknowledged_edit_is_lost(tmp_path: Path) -> None:
    service = Service(tmp_path)
    rng = random.Random(2024)  # noqa: S311
    with service.running() as client:
        painters = [Painter.with_a_design(client, n) for n in range(PAINTERS)]
    strokes = 0
    for _ in range(KILLS):
        before = sum(p.acknowledged for p in painters)
        with service.running(), painting(service.url, painters):
            until_painted(painters, before + PAINTERS)
            listed = knitcore("token", "list", env=service.environment)
            assert listed.returncode == 0  # it opens and closes the same file
            time.sleep(rng.uniform(0.0, 0.5))
            service.kill()
        assert is_whole(tmp_path / "data" / "knitcore.sqlite3")
        with service.running() as client:
            for painter in painters:
                painter.check_over_http(client)
        strokes += sum(p.acknowledged for p in painters) - before
    assert strokes >= PAINTERS * KILLS
    print(f"{KILLS} kills, {strokes} strokes kept, none lost")  # noqa: T201 - for make test-hard


@pytest.fixture
def small_disk(tmp_path: Path) -> Iterator[Path]:
    folder = tmp_path / "disk"
    folder.mkdir()
    mount = ["mount", "-t", "tmpfs", "-o", "size=2m", "tmpfs", str(folder)]
    try:
        done = subprocess.run(mount, capture_output=True, check=False)
    except FileNotFoundError:
        pytest.skip("there is no mount here")
    if done.returncode:
        pytest.skip("no file system can be mounted here")
    yield folder
    subprocess.run(["umount", str(folder)], check=True)


def test_a_full_disk_refuses_clearly_and_loses_nothing(small_disk: Path, tmp_path: Path) -> None:
    service = Service(tmp_path, data_dir=str(small_disk))
    with service.running() as client:
        painter = Painter.with_a_design(client, 1)
        assert painter.paint(client).status_code == 200
        job = client.post(JOBS, json={"kind": "stretch", "request": SHORT}).json()["id"]
        wait_until(lambda: client.get(f"{JOBS}/{job}").json()["state"] == "done")
        with contextlib.suppress(OSError), (small_disk / "filler").open("wb", 0) as filler:
            while True:
                filler.write(bytes(4096))
        for _ in range(1000):  # what is left in the log's pages
            refused = painter.paint(client)
            if refused.status_code != 200:
                break
        problem = refused.json()
        assert (refused.status_code, problem["type"]) == (507, "/problems/full"), problem
        assert "nothing was changed" in problem["detail"]
        assert "Make room" in problem["remedy"]
        painter.check_over_http(client, unanswered=0)
        assert client.post(JOBS, json={"kind": "stretch", "request": LONG}).status_code == 507
        assert client.get(f"{JOBS}/{job}/result").status_code == 200
        assert client.get("/readyz").status_code == 503

        (small_disk / "filler").unlink()
        assert painter.paint(client).status_code == 200
        painter.check_over_http(client, unanswered=0)
        service.kill()
        assert is_whole(small_disk / "knitcore.sqlite3")


@pytest.mark.postgres
@pytest.mark.timeout(600 + 2 * OUTAGE_S)
def test_a_database_outage_loses_nothing(postgres_url: str, tmp_path: Path) -> None:
    service = Service(tmp_path, database_url=postgres_url)
    with service.running() as client:
        painter = Painter.with_a_design(client, 1)
        assert painter.paint(client).status_code == 200
        job = client.post(JOBS, json={"kind": "stretch", "request": SHORT}).json()["id"]
        wait_until(lambda: client.get(f"{JOBS}/{job}").json()["state"] != "waiting")
        with away(postgres_url):
            back = time.monotonic() + OUTAGE_S
            while time.monotonic() < back:
                refused = painter.paint(client)
                assert refused.status_code == 503
                assert "nothing was changed" in refused.json()["detail"]
                assert refused.headers["retry-after"]
                assert client.get("/healthz").status_code == 200
                assert client.get("/readyz").status_code == 503
                time.sleep(0.2)
        assert painter.paint(client).status_code == 200
        painter.check_over_http(client, unanswered=0)
        wait_until(lambda: client.get("/readyz").status_code == 200)
        second = knitcore("serve", "--port", "0", env=service.environment)
        assert (second.returncode, "KNITCORE_PROCESS_NAME" in second.stderr) == (2, True)
        wait_until(lambda: client.get(f"{JOBS}/{job}").json()["state"] == "done")
        assert len(client.get(f"{JOBS}/{job}/result").json()["strain"]) == SHORT["steps"]


def test_clients_that_vanish_leave_nothing_behind(tmp_path: Path) -> None:
    service = Service(tmp_path, viewer_idle_s="0.5")
    with service.running() as client:
        address = httpx.URL(service.url)
        assert address.port is not None
        first = client.post("/api/v1/stretch", json=SHORT | {"steps": 2})
        assert first.status_code == 200  # the worker has begun, and keeps its pipes
        handles = _sockets_and_pipes(service.pid)

        # one who waits for a computation of minutes: its only worker is free for the next one
        with socket.create_connection((address.host, address.port)) as gone:
            gone.sendall(_request("POST", "/api/v1/stretch", LONG))
            wait_until(lambda: _number(client, "knitcore_computations_running") == 1)
        assert client.post("/api/v1/stretch", json=SHORT).status_code == 200

        # one who follows a job: it goes on without them
        job = client.post(JOBS, json={"kind": "stretch", "request": LONG}).json()["id"]
        with socket.create_connection((address.host, address.port)) as gone:
            gone.sendall(_request("GET", f"{JOBS}/{job}/events"))
            assert b"200 OK" in gone.recv(4096)
        assert client.get(f"{JOBS}/{job}").json()["state"] in ("waiting", "running")
        assert client.delete(f"{JOBS}/{job}").json()["state"] == "cancelled"

        # one who looks at a view, without a word of goodbye
        body = {"chart": SHORT["chart"], "material": "acrylic"}
        assert client.put("/api/v1/views/vanishing", json=body).status_code == 200
        view = websockets.sync.client.connect(
            f"{service.url.replace('http', 'ws')}/view/vanishing",
            subprotocols=[websockets.Subprotocol(f"viser-v{viser.__version__}")],
            open_timeout=60,
        )
        assert view.recv()
        view.socket.shutdown(socket.SHUT_RDWR)
        wait_until(lambda: _number(client, "knitcore_views_open") == 0)
        wait_until(lambda: _sockets_and_pipes(service.pid) <= handles)


def _sockets_and_pipes(pid: int) -> int:
    """Handles of a process, without files, of which a busy pool of the database has more."""
    count = 0
    for handle in Path(f"/proc/{pid}/fd").iterdir():
        with contextlib.suppress(FileNotFoundError):  # closed since
            count += str(handle.readlink()).startswith(("socket:", "pipe:"))
    return count


def _number(client: httpx.Client, name: str) -> float:
    lines = client.get("/metrics").text.splitlines()
    return next(float(line.split()[1]) for line in lines if line.startswith(f"{name} "))


def _request(method: str, path: str, body: object = None) -> bytes:
    content = b"" if body is None else json.dumps(body).encode()
    head = (
        f"{method} {path} HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
        f"Content-Length: {len(content)}\r\n\r\n"
    )
    return head.encode() + content
