"""Attacks by one ordinary user on a service on loopback, and their effect on other users.

A probe, a process of its own, requests ``/healthz`` throughout. For each attack its waits are
printed, and the CPU time that the service itself took during the longest: on a machine that other
programs keep busy, only that says what the attack did. ``busy`` marks an attack with long waits of
which the service itself took no more than the limit. Further the CPU time of the event loop, and
how far the memory of the service process rose above what it was before. All is bounded in count and
time. Names of attacks choose some of them.

    python benchmarks/attacks.py
    python benchmarks/attacks.py frames large_file
"""

from __future__ import annotations

import contextlib
import functools
import http.client
import json
import multiprocessing
import os
import random
import socket
import sys
import tempfile
import time
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import httpx2 as httpx
import numpy as np
import viser
import websockets.sync.client

sys.path.insert(0, str(Path(__file__).resolve().parent.parent))
from tests.app.running import Service

PROBE_S, MAX_WAIT_S, MAX_RISE_BYTES = 0.01, 0.1, 300_000_000
SIDE = 1000
AT_ONCE = 40


def ask(address: str, pid: int, over: Any, waits: Any) -> None:
    """In the probe: one small request after the other; at the end, how long each took, and how much
    CPU time the service spent meanwhile."""
    found: list[tuple[float, float]] = []
    clock = (~pid << 3) | 2  # Linux: CPU time of another process
    connection = http.client.HTTPConnection(address, timeout=60.0)
    connection.connect()
    waits.send("ready")
    while not found or not over.wait(PROBE_S):
        start, spent = time.perf_counter(), time.clock_gettime(clock)
        connection.request("GET", "/healthz")
        connection.getresponse().read()
        found.append((time.perf_counter() - start, time.clock_gettime(clock) - spent))
    waits.send(found)


@contextlib.contextmanager
def probe(service: Service, waits: list[tuple[float, float]]) -> Iterator[None]:
    """Probe while the block runs; not in this process, whose own work would delay it."""
    spawn = multiprocessing.get_context("spawn")
    over, (theirs, ours) = spawn.Event(), spawn.Pipe(duplex=False)
    address = service.url.removeprefix("http://")
    process = spawn.Process(target=ask, args=(address, service.pid, over, ours))
    process.start()
    theirs.recv()
    try:
        yield
    finally:
        over.set()
        waits += theirs.recv()
        process.join()


def _posted(client: httpx.Client, path: str, bodies: Iterable[bytes]) -> str:
    """All at once; counts the answers by their status."""
    with ThreadPoolExecutor(AT_ONCE) as threads:
        send = functools.partial(client.post, f"/api/v1/{path}")
        asked = [threads.submit(send, content=body, headers=JSON) for body in bodies]
        return _codes(future.result() for future in asked)


JSON = {"Content-Type": "application/json"}


def _chart(side: int, seed: int) -> str:
    rng = random.Random(seed)
    return "\n".join("".join(rng.choices("KP", k=side)) for _ in range(side))


def predictions(client: httpx.Client) -> str:
    body = {"chart": _chart(SIDE, 1), "material": "acrylic"}
    return _posted(client, "predict", [json.dumps(body).encode()] * 6)


def small_predictions(client: httpx.Client) -> str:
    """Each as large as the service answers itself."""
    wishes = [{"chart": _chart(49, seed), "material": "acrylic"} for seed in range(120)]
    return _posted(client, "predict", [json.dumps(wish).encode() for wish in wishes])


def values(client: httpx.Client) -> str:
    region = {"id": "r", "name": "r", "colour": "#112233", "runs": [[0, 0, 1]] * 1_500_000}
    body = {"name": "a", "material": "acrylic", "chart": "K", "regions": [region]}
    return _posted(client, "designs", [json.dumps(body).encode()] * 3)


def nests(client: httpx.Client) -> str:
    """Lists in lists: many values, few commas."""
    nest = b"[" * 150 + b"]" * 150
    return _posted(client, "designs", [b"[" + b",".join([nest] * 20_000) + b"]"] * 2)


def designs(client: httpx.Client) -> str:
    """Of as many values as are taken, and some more."""
    runs = [[n % SIDE, 0, 1] for n in range(30_000)]
    region = {"id": "r", "name": "r", "colour": "#112233", "runs": runs}
    body = {"name": "a", "material": "acrylic", "chart": _chart(SIDE, 2), "regions": [region]}
    content = json.dumps(body).encode()
    return _posted(client, "designs", [content] * 20)


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
    return _posted(client, "import", [json.dumps({"file": file}).encode()] * 2)


def views(client: httpx.Client) -> str:
    body = json.dumps({"chart": _chart(SIDE, 3), "material": "acrylic"}).encode()
    send = functools.partial(client.put, content=body, headers=JSON)
    with ThreadPoolExecutor(8) as threads:
        asked = [threads.submit(send, f"/api/v1/views/attack-{n}") for n in range(8)]
        return _codes(future.result() for future in asked)


def large_job(client: httpx.Client) -> str:
    file = {"name": "a.csv", "content": "A" * 28_000_000}
    body = {"kind": "compression", "request": {"file": file}}
    return _posted(client, "jobs", [json.dumps(body).encode()] * 2)


def rectangles(client: httpx.Client) -> str:
    """As many views as a user may have, with as much in each as is drawn."""
    body = {"chart": _chart(200, 4), "material": "acrylic", "rectangles": True}
    content = json.dumps(body).encode()
    paths = (f"/api/v1/views/rectangles-{n}" for n in range(16))
    return _codes(client.put(path, content=content, headers=JSON) for path in paths)


def stills(client: httpx.Client) -> str:
    """As large as they are drawn, of few and of many stitches."""
    wishes = [{"chart": _chart(side, side), "material": "acrylic"} for side in (1, 2, 63, 200) * 8]
    bodies = [json.dumps(wish).encode() for wish in wishes]
    return _posted(client, "views/still?width=1600&height=1200", bodies)


def heads(client: httpx.Client) -> str:
    """A header, an address and a trailer without end, and headers without end."""
    begins = (HEAD + b"A: ", b"GET /", CHUNKED + b"0\r\nA: ")
    refused = [_streamed(client, begin, b"a" * 100_000) for begin in begins]
    refused.append(_streamed(client, HEAD, b"a: b\r\n" * 20_000))
    return f"{sum(refused)} of {len(refused)} refused"


def cookie(client: httpx.Client) -> str:
    """Quoted, and full of backslashes."""
    quoted = 'knitcore_session="' + "\\" * 30_000 + '"'
    return _codes(client.get("/api/v1/session", headers={"Cookie": quoted}) for _ in range(5))


def crumbs(client: httpx.Client) -> str:
    """A body in chunks of one byte, and requests sent ahead."""
    refused = [_streamed(client, CHUNKED, b"1\r\n \r\n" * 20_000) for _ in range(4)]
    refused.append(_streamed(client, b"", (HEAD + b"\r\n") * 2_000))
    return f"{sum(refused)} of {len(refused)} refused"


def pings(client: httpx.Client) -> str:
    """On the websocket of a view, without reading an answer."""
    client.put("/api/v1/views/pinged", json={"chart": "KP", "material": "acrylic"})
    upgrade = (
        "GET /view/pinged HTTP/1.1\r\nHost: 127.0.0.1\r\nUpgrade: websocket\r\n"
        "Connection: Upgrade\r\nSec-WebSocket-Version: 13\r\n"
        f"Sec-WebSocket-Protocol: viser-v{viser.__version__}\r\n"
        "Sec-WebSocket-Key: YWFhYWFhYWFhYWFhYWFhYQ==\r\n\r\n"
    )
    ping = bytes([0x89, 0x80]) + b"\0\0\0\0"
    refused = [_streamed(client, upgrade.encode(), ping * 5_000) for _ in range(4)]
    return f"{sum(refused)} of {len(refused)} closed"


HEAD = b"GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\n"
CHUNKED = b"POST /api/v1/predict HTTP/1.1\r\nHost: 127.0.0.1\r\nTransfer-Encoding: chunked\r\n\r\n"


def _streamed(client: httpx.Client, begin: bytes, more: bytes, times: int = 500) -> bool:
    """Send bytes again and again; whether the connection was closed before their end."""
    source = ("127.0.0.2", 0)
    with socket.create_connection((client.base_url.host, client.base_url.port), 5, source) as one:
        try:
            one.sendall(begin)
            time.sleep(0.2)
            for _ in range(times):
                one.sendall(more)
        except OSError:
            return True
    return False


def _codes(answers: Iterable[httpx.Response]) -> str:
    codes = [answer.status_code for answer in answers]
    return ", ".join(f"{codes.count(code)} × {code}" for code in sorted(set(codes)))


def nothing(_: httpx.Client) -> str:
    time.sleep(5)
    return "no attack, for comparison"


ATTACKS: list[Callable[[httpx.Client], str]] = [
    nothing,
    predictions,
    small_predictions,
    values,
    nests,
    designs,
    frames,
    slow,
    views,
    rectangles,
    stills,
    large_file,
    large_job,
    heads,
    cookie,
    crumbs,
    pings,
]


def main(names: list[str]) -> int:
    """Try them one after the other; 1 if one exceeds its limit."""
    missed = 0
    with tempfile.TemporaryDirectory() as folder:
        service = Service(Path(folder), workers="2", worker_priority="low")
        client = service.start()
        client.timeout = httpx.Timeout(180.0)
        try:
            for attack in ATTACKS:
                if names and attack.__name__ not in names:
                    continue
                found: list[tuple[float, float]] = []
                cpu, rss = _loop_s(service.pid), _memory(service.pid, "VmRSS")
                _forget_peak(service.pid)
                with probe(service, found):
                    came = attack(client)
                cpu, rise = _loop_s(service.pid) - cpu, _memory(service.pid, "VmHWM") - rss
                waits, spent = np.array(found).T
                own = np.minimum(waits, spent)
                mark = _mark(float(waits.max()), float(own.max()), rise)
                missed += mark == "FAIL"
                p50, p99 = np.percentile(waits, [50, 99])
                print(
                    f"{mark}  {attack.__name__:17} wait p50 {1e3 * p50:4.1f} "
                    f"p99 {1e3 * p99:4.0f} longest {1e3 * waits.max():4.0f} ms, of CPU p99 "
                    f"{1e3 * np.percentile(own, 99):4.0f} longest "
                    f"{1e3 * own.max():4.0f} ms  "
                    f"event loop {1e3 * cpu:5.0f} ms of CPU  "
                    f"memory {rss / 1e6:4.0f} + {rise / 1e6:3.0f} MB  "
                    f"load {os.getloadavg()[0]:.1f}  ({came})",
                    flush=True,
                )
        finally:
            client.close()
            service.kill()
    return 1 if missed else 0


def _mark(wait_s: float, spent_s: float, rise: int) -> str:
    if spent_s > MAX_WAIT_S or rise > MAX_RISE_BYTES:
        return "FAIL"
    return "pass" if wait_s <= MAX_WAIT_S else "busy"


def _memory(pid: int, what: str) -> int:
    """``VmRSS``, what a process has now, or ``VmHWM``, the most it had; bytes."""
    status = Path(f"/proc/{pid}/status").read_text()
    return 1000 * next(int(line.split()[1]) for line in status.splitlines() if what in line)


def _forget_peak(pid: int) -> None:
    """Make the most memory that a process had what it has now."""
    Path(f"/proc/{pid}/clear_refs").write_text("5")


def _loop_s(pid: int) -> float:
    """CPU time of the main thread."""
    return int(Path(f"/proc/{pid}/task/{pid}/schedstat").read_text().split()[0]) / 1e9


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
