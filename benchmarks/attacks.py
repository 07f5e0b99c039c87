"""Attacks by one ordinary user on a service on loopback, and their effect on other users.

A probe requests ``/healthz`` throughout. For each attack the longest wait is printed with its
limit, and the peak memory of the service process. All is bounded in count and time.

    python benchmarks/attacks.py
"""

from __future__ import annotations

import contextlib
import json
import random
import socket
import sys
import tempfile
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import httpx2 as httpx
import viser
import websockets.sync.client

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from tests.app.service import Service

PROBE_S, MOST_WAIT_S, MOST_BYTES = 0.01, 0.1, 700_000_000
SIDE = 1000


class Probe:
    """Sends one small request after the other, and records how long each takes."""

    def __init__(self, url: str) -> None:
        self._url = url
        self.waits: list[float] = []

    @contextlib.contextmanager
    def running(self) -> Iterator[None]:
        over = threading.Event()
        thread = threading.Thread(target=self._ask, args=(over,))
        thread.start()
        try:
            yield
        finally:
            over.set()
            thread.join()

    def _ask(self, over: threading.Event) -> None:
        with httpx.Client(base_url=self._url, timeout=60.0) as client:
            client.get("/healthz")
            while not over.wait(PROBE_S):
                start = time.perf_counter()
                client.get("/healthz")
                self.waits.append(time.perf_counter() - start)


def predictions(client: httpx.Client) -> str:
    rng = random.Random(1)
    rows = ["".join(rng.choices("KP", k=SIDE)) for _ in range(SIDE)]
    body = {"chart": "\n".join(rows), "material": "acrylic"}
    with ThreadPoolExecutor(6) as threads:
        asked = [threads.submit(client.post, "/api/v1/predict", json=body) for _ in range(6)]
        return _codes(future.result() for future in asked)


def values(client: httpx.Client) -> str:
    region = {"id": "r", "name": "r", "colour": "#112233", "runs": [[0, 0, 1]] * 1_500_000}
    body = {"name": "a", "material": "acrylic", "chart": "K", "regions": [region]}
    content = json.dumps(body)
    return _codes(client.post("/api/v1/designs", content=content) for _ in range(3))


def frames(client: httpx.Client) -> str:
    body = {"chart": "KP", "material": "acrylic"}
    client.put("/api/v1/views/an-attack", json=body)
    count = 15_000_000
    nils = b"\xdd" + count.to_bytes(4, "big") + b"\xc0" * count
    address = f"{str(client.base_url).replace('http', 'ws').rstrip('/')}/view/an-attack"
    with websockets.sync.client.connect(
        address, subprotocols=[websockets.Subprotocol(f"viser-v{viser.__version__}")]
    ) as view:
        try:
            view.send(nils)
            while True:
                view.recv(timeout=10)
        except websockets.ConnectionClosed as closed:
            return f"closed {closed.rcvd.code if closed.rcvd else ''}"


def slow(client: httpx.Client) -> str:
    head = b"POST /api/v1/predict HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 900\r\n\r\n{"
    address = client.base_url.host, client.base_url.port
    with contextlib.ExitStack() as stack:
        source = ("127.0.0.2", 0)  # an address of its own, whose connections are counted
        sockets = [
            stack.enter_context(socket.create_connection(address, source_address=source))
            for _ in range(300)
        ]
        refused = 0
        for one in sockets:
            try:
                one.sendall(head)
            except OSError:
                refused += 1
        time.sleep(24)  # longer than a body may take
        closed = 0
        for one in sockets:
            one.settimeout(0.05)
            with contextlib.suppress(TimeoutError):
                try:
                    closed += one.recv(1) == b""
                except OSError:
                    closed += 1
    return f"{closed} of 300 closed"


def large_file(client: httpx.Client) -> str:
    file = {"name": "a.png", "content": "A" * 28_000_000}
    return _codes(client.post("/api/v1/import", json={"file": file}) for _ in range(2))


def _codes(answers: Iterator[httpx.Response]) -> str:
    return " ".join(str(answer.status_code) for answer in answers)


def nothing(_: httpx.Client) -> str:
    time.sleep(5)
    return "no attack, for comparison"


ATTACKS: list[Callable[[httpx.Client], str]] = [
    nothing,
    predictions,
    values,
    frames,
    slow,
    large_file,
]


def main() -> int:
    """Try them one after the other; 1 if one exceeds its limit."""
    missed = 0
    with tempfile.TemporaryDirectory() as folder:
        service = Service(Path(folder), workers="2", worker_priority="low")
        client = service.start()
        client.timeout = httpx.Timeout(180.0)
        try:
            for attack in ATTACKS:
                probe = Probe(service.url)
                with probe.running():
                    came = attack(client)
                wait, rss = max(probe.waits), _most_memory(service.pid)
                good = wait <= MOST_WAIT_S and rss <= MOST_BYTES
                missed += not good
                print(
                    f"{'pass' if good else 'FAIL'}  {attack.__name__:12} longest wait "
                    f"{1000 * wait:6.0f} ms  memory {rss / 1e6:5.0f} MB  ({came})",
                    flush=True,
                )
        finally:
            client.close()
            service.kill()
    return 1 if missed else 0


def _most_memory(pid: int) -> int:
    status = Path(f"/proc/{pid}/status").read_text()
    return 1000 * next(int(line.split()[1]) for line in status.splitlines() if "VmHWM" in line)


if __name__ == "__main__":
    sys.exit(main())
