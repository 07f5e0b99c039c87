"""Fifty painters, and tests, shapes, exports and views that come and go, for a long time: nothing
is lost, and the service needs no more than before. Every part is restarted in the middle.

``make test-hard`` runs it: KNITCORE_SOAK_S sets how long (30 minutes). From 10 minutes on, memory
and handles are compared.
"""

from __future__ import annotations

import contextlib
import os
import signal
import threading
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from statistics import median

import httpx2 as httpx
import pytest
import websockets.sync.client
from websockets import Subprotocol

from app.service.web.sessions import Tokens
from tests.app.clients import LONG, VIEW_PROTOCOLS
from tests.app.databases import away, is_whole, opened
from tests.app.painter import Painter
from tests.app.running import Service, wait_until

SOAK_S = float(os.environ.get("KNITCORE_SOAK_S", "0"))
pytestmark = [pytest.mark.slow, pytest.mark.skipif(not SOAK_S, reason="`make test-hard` runs it")]
LONG_ENOUGH_S = 600.0
MORE_HANDLES = 10
"""Handles at the end beyond those before: a view more, and connections to the database up to their
most. What loses one for each job, view or request loses hundreds."""
PAINTERS = 50
STROKE_S = 1.0
"""Pause between two strokes of one painter."""
MORE = 1.02
"""Memory at the end over that before, for it to be flat."""
CHART = {"fabric": "garter", "columns": 20, "rows": 20}
MORE_OF_WORKERS = 1.25
"""Memory of workers at the end over that before; it comes and goes with their jobs."""
Work = Callable[[httpx.Client], object]


def _job(kind: str, request: dict[str, object]) -> Work:
    """Something that is computed in the background, and its result."""

    def work(client: httpx.Client) -> object:
        job = client.post("/api/v1/jobs", json={"kind": kind, "request": request})
        job.raise_for_status()
        address = job.headers["Location"]
        while client.get(address).raise_for_status().json()["state"] in ("waiting", "running"):
            time.sleep(0.3)
        return client.get(f"{address}/result").raise_for_status().content

    return work


def _export(client: httpx.Client) -> object:
    body = {"to": "pattern", "chart": "KPKP\nPKPK", "material": "acrylic"}
    return client.post("/api/v1/export", json=body).raise_for_status().content


def _view(client: httpx.Client) -> object:
    """A view that is opened, drawn and left."""
    name = f"soak-{time.monotonic_ns()}"
    drawn = client.put(f"/api/v1/views/{name}", json={"chart": CHART, "material": "acrylic"})
    address = str(client.base_url.copy_with(scheme="ws", path=f"/view/{name}"))
    headers = {"Authorization": client.headers["Authorization"]}
    with websockets.sync.client.connect(
        address,
        subprotocols=[Subprotocol(VIEW_PROTOCOLS[0])],
        additional_headers=headers,
        open_timeout=60,
    ) as view:
        view.recv()
    return drawn.raise_for_status()


WORK: dict[str, Work] = {
    "stretch": _job("stretch", LONG | {"chart": CHART, "steps": 6}),
    "shape": _job("curl", {"chart": CHART, "material": "acrylic"}),
    "export": _export,
    "view": _view,
}


class Crowd:
    """Everybody who uses some services, until they are told to stop.

    Attributes
    ----------
    done : how often each kind of work came to its end.
    faults : answers that should not have come.
    """

    def __init__(self, services: list[Service], tokens: dict[str, str]) -> None:
        self.services = services
        self.done = dict.fromkeys(WORK, 0)
        self.faults: list[str] = []
        self.painters: list[tuple[Painter, Service]] = []
        self._tokens = tokens
        self._stop = threading.Event()
        for number, name in enumerate(list(tokens)[:PAINTERS]):
            service = services[number % len(services)]
            with self.client(service, name) as client:
                self.painters.append((Painter.with_a_design(client, number), service))

    def client(self, service: Service, name: str) -> httpx.Client:
        """A client of a service as it is reached now."""
        headers = {"Authorization": f"Bearer {self._tokens[name]}"}
        return httpx.Client(base_url=service.url, timeout=120.0, headers=headers)

    @contextlib.contextmanager
    def at_work(self) -> Iterator[None]:
        """All of them work while the block runs."""
        threads = [threading.Thread(target=self._paint, args=each) for each in self.painters]
        threads += [
            threading.Thread(
                target=self._repeat, args=(kind, self.services[n % len(self.services)])
            )
            for n, kind in enumerate(WORK)
        ]
        for thread in threads:
            thread.start()
        try:
            yield
        finally:
            self._stop.set()
            for thread in threads:
                thread.join()

    def strokes(self) -> int:
        """Number of strokes that were acknowledged."""
        return sum(painter.acknowledged - 1 for painter, _ in self.painters)

    def _paint(self, painter: Painter, service: Service) -> None:
        while not self._stop.is_set():
            with (
                contextlib.suppress(httpx.TransportError),
                httpx.Client(
                    base_url=service.url, timeout=120.0, headers=painter.headers
                ) as client,
            ):
                wait_until(lambda: client.get("/readyz").is_success)
                try:
                    painter.check_over_http(client)  # a stroke that failed may be kept
                    while not self._stop.wait(STROKE_S):
                        painter.paint(client).raise_for_status()
                except httpx.HTTPStatusError as error:
                    if error.response.status_code not in (429, 503):
                        self.faults.append(error.response.text)
                        return
            self._stop.wait(0.5)

    def _repeat(self, kind: str, service: Service) -> None:
        while not self._stop.wait(0.5):
            with (
                contextlib.suppress(
                    httpx.TransportError, websockets.exceptions.WebSocketException, OSError
                ),
                self.client(service, kind) as client,
            ):
                try:
                    WORK[kind](client)
                except httpx.HTTPStatusError as error:
                    # a job of a service that was restarted is interrupted; others wait their turn
                    if error.response.status_code not in (404, 409, 429, 503):
                        self.faults.append(error.response.text)
                    continue
                self.done[kind] += 1


def _children(pid: int) -> Iterator[int]:
    """Yield the processes that a process has started."""
    for thread in Path(f"/proc/{pid}/task").glob("*/children"):
        with contextlib.suppress(OSError):  # it has ended
            yield from map(int, thread.read_text(encoding="ascii").split())


def _workers(pid: int) -> list[int]:
    """The workers of a service, which the process that loads their modules has started."""
    return [worker for loader in _children(pid) for worker in _children(loader)]


def _workers_mb(pid: int) -> float:
    """Memory of the workers of a service."""
    total = 0.0
    for process in [*_children(pid), *_workers(pid)]:
        with contextlib.suppress(OSError):
            total += _resident_mb(process)
    return total


def _resident_mb(pid: int) -> float:
    pages = int(Path(f"/proc/{pid}/statm").read_text(encoding="ascii").split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 1e6


def _needs(services: list[Service], seconds: float) -> list[tuple[float, float, int]]:
    """Memory in MB and that of its workers, the medians of some time, and the fewest file handles:
    each view that is open has six."""
    seen: list[list[tuple[float, float, int]]] = [[] for _ in services]
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        for service, samples in zip(services, seen, strict=True):
            handles = len(os.listdir(f"/proc/{service.pid}/fd"))
            samples.append((_resident_mb(service.pid), _workers_mb(service.pid), handles))
        time.sleep(min(1.0, seconds / 5))
    return [
        (median(service), median(workers), min(handles))
        for service, workers, handles in (zip(*samples, strict=True) for samples in seen)
    ]


def _restart(services: list[Service], crowd: Crowd, url: str | None) -> None:
    """Kill the workers of each service and then itself, stop it by a signal once it is used again,
    and lose the database at the end."""
    for service in services:
        shapes = crowd.done["shape"]
        for worker in _workers(service.pid):
            os.kill(worker, signal.SIGKILL)
        wait_until(lambda: crowd.done["shape"] > shapes + 1)  # noqa: B023 - used at once
        service.kill()
        service.start().close()
        strokes = crowd.strokes()
        wait_until(lambda: crowd.strokes() > strokes + PAINTERS)  # noqa: B023 - used at once
        assert service.stop() == 0
        service.start().close()
    if url is not None:
        with away(url):
            time.sleep(2.0)


@pytest.mark.timeout(1500 + 2 * SOAK_S)
def test_a_long_day(place: Path | str, tmp_path: Path) -> None:
    url = place if isinstance(place, str) else None
    names = [f"painter-{number}" for number in range(PAINTERS)] + list(WORK)
    with opened(url or tmp_path / "data") as database:
        tokens = {name: Tokens(database).create(name).token for name in names}
    common = {"require_login": "true", "requests_per_s": "1000", "viewer_idle_s": "2"}
    services = [Service(tmp_path, **common)]
    if url is not None:
        services = [
            Service(folder, database_url=url, process_name=folder.name, **common)
            for folder in (tmp_path / "left", tmp_path / "right")
        ]
    with contextlib.ExitStack() as stack:
        for service in services:
            service.log.parent.mkdir(exist_ok=True)
            stack.enter_context(service)
        crowd = Crowd(services, tokens)
        with crowd.at_work():
            time.sleep(0.4 * SOAK_S)
            _restart(services, crowd, url)
            done = dict(crowd.done)
            time.sleep(0.2 * SOAK_S)  # what is loaded once is loaded
            before = _needs(services, 0.1 * SOAK_S)
            time.sleep(0.2 * SOAK_S)
            after = _needs(services, 0.1 * SOAK_S)
            wait_until(lambda: all(crowd.done[kind] > done[kind] for kind in WORK), 600.0)
        assert crowd.faults == [], [service.unexpected() for service in services]
        for painter, service in crowd.painters:
            with httpx.Client(
                base_url=service.url, timeout=120.0, headers=painter.headers
            ) as client:
                painter.check_over_http(client)
        where = f"{'PostgreSQL' if url else 'SQLite'}, {SOAK_S:.0f} s"
        print(f"{where}: {crowd.strokes()} strokes, {crowd.done}, {before} to {after}")  # noqa: T201
        if SOAK_S >= LONG_ENOUGH_S:
            for old, new in zip(before, after, strict=True):
                (old_mb, old_workers_mb, old_handles), (new_mb, new_workers_mb, new_handles) = (
                    old,
                    new,
                )
                assert new_mb <= MORE * old_mb
                assert new_workers_mb <= MORE_OF_WORKERS * old_workers_mb
                assert new_handles <= old_handles + MORE_HANDLES
    if url is None:
        assert is_whole(tmp_path / "data" / "knitcore.sqlite3")
