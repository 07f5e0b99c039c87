"""One user attacks, another works: the longest that the other waits, attack by attack.

    python -m studies.speed.attacks [NAME ...] [--seconds 15]

The service runs as for several people, with a login for each. Mallory, who has one, does as much
of each attack as he may. Alice meanwhile asks for what needs nothing (`/healthz`), for what needs
a login, a thread and the database (her designs), for a change (a stroke) and for `/readyz`. The
exit code is 1 if a wait is over its target, which holds on a machine that does nothing else.
"""

import argparse
import base64
import contextlib
import io
import json
import multiprocessing
import os
import random
import socket
import sys
import tempfile
import threading
import time
import zipfile
from collections import Counter
from collections.abc import Callable, Iterator
from multiprocessing.connection import Connection
from multiprocessing.synchronize import Event
from pathlib import Path
from typing import Any

import httpx2 as httpx
import viser
from PIL import Image
from websockets import Subprotocol, WebSocketException
from websockets.sync.client import connect

from app.service.store.database import Database
from app.service.store.schema import migrate
from app.service.web.sessions import Tokens
from scripts.serving import Service
from studies.speed.readers import NUMBERS, workbook
from studies.speed.service import resident_mb

WAIT_MS = 100.0
"""Longest wait of another user on a quiet machine."""
PAUSE_S = 0.05
"""Pause of the other user between two rounds."""
MACHINE = "machine"
"""Column for how late a sleeper wakes, which is no wait for the service."""
FRAME_BYTES = 15_900_000
AT_ONCE = 12
"""Requests that Mallory makes at once."""
STOPS_WITHIN_S = 90.0
FORKED = multiprocessing.get_context("fork")
Attack = Callable[[httpx.Client, int], object]

CHART = {"chart": "KP/PK", "material": "acrylic"}
BIG_CHART = "\n".join(["KP" * 500] * 1000)


def _post(path: str, body: object) -> Attack:
    """An attack that sends the same body again and again."""
    content = body if isinstance(body, bytes) else json.dumps(body).encode()
    return lambda client, _: client.post(path, content=content)


def _uploaded(name: str, content: bytes) -> dict[str, str]:
    return {"name": name, "content": base64.b64encode(content).decode()}


def _picture_bomb() -> bytes:
    """A picture of 16 million pixels in some kilobytes."""
    stream = io.BytesIO()
    Image.new("1", (4000, 4000)).save(stream, "PNG")
    return stream.getvalue()


def _zip_bomb() -> bytes:
    """A displacement field whose head promises more than it holds."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as packed:
        packed.writestr("displacement.npy", b"\x93NUMPY\x01\x00" + b"0" * 50_000_000)
    return stream.getvalue()


def _connected(client: httpx.Client, head: str) -> socket.socket:
    """A connection of its own that has sent the head of a request."""
    connection = socket.create_connection((client.base_url.host, client.base_url.port or 80), 5)
    login = f"Host: 127.0.0.1\r\nAuthorization: {client.headers['Authorization']}\r\n\r\n"
    connection.sendall(f"{head}\r\n{login}".encode())
    return connection


def _slow_body(client: httpx.Client, turn: int) -> None:
    """A body of a byte a second."""
    del turn
    head = "POST /api/v1/predict HTTP/1.1\r\nContent-Length: 1000"
    with contextlib.suppress(OSError), _connected(client, head) as connection:
        for _ in range(3):
            connection.sendall(b"{")
            time.sleep(1)


def _unread(client: httpx.Client, turn: int) -> None:
    """Connections that ask for a design of 2 MB and read nothing of it."""
    del turn
    body = {"name": "x", "material": "acrylic", "chart": BIG_CHART}
    design = client.post("/api/v1/designs", json=body).json().get("id")
    with contextlib.suppress(OSError), contextlib.ExitStack() as open_ones:
        for _ in range(20):
            head = f"GET /api/v1/designs/{design} HTTP/1.1"
            open_ones.enter_context(_connected(client, head))
        time.sleep(3)


def _unread_view(client: httpx.Client, turn: int) -> None:
    """Browsers that read nothing of a view of 40,000 stitches, each unlike its neighbours."""
    name = f"unread-{turn % 2}"
    chart = "\n".join("".join(_random.choices("KP", k=200)) for _ in range(200))
    upgrade = (
        f"GET /view/{name} HTTP/1.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
        "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\n"
        f"Sec-WebSocket-Protocol: viser-v{viser.__version__}"
    )
    with contextlib.suppress(OSError), contextlib.ExitStack() as open_ones:
        for _ in range(3):
            open_ones.enter_context(_connected(client, upgrade))
        client.put(f"/api/v1/views/{name}", json=CHART | {"chart": chart})
        time.sleep(3)


def _endless_head(client: httpx.Client, turn: int) -> None:
    """Headers of nothing, as long as the service takes them."""
    del turn
    with contextlib.suppress(OSError), _connected(client, "GET /healthz HTTP/1.1") as connection:
        connection.sendall(b"GET /healthz HTTP/1.1\r\nHost: 127.0.0.1\r\n")
        for _ in range(1_000):
            connection.sendall(b"X:\r\n" * 1_000)


def _painted(client: httpx.Client, turn: int) -> httpx.Response:
    """Strokes on charts of a million stitches."""
    if (design := _large_designs.get(client)) is None:
        body = {"name": "x", "material": "acrylic", "chart": BIG_CHART}
        design = client.post("/api/v1/designs", json=body).json()["id"]
        _large_designs[client] = design
    run = {"row": turn % 1000, "column": 0, "stitches": "P"}
    strokes = {"rows": 1000, "columns": 1000, "runs": [run]}
    return client.post(f"/api/v1/designs/{design}/strokes", json=strokes)


def _wrong_token(client: httpx.Client, turn: int) -> httpx.Response:
    wrong = {"Authorization": f"Bearer {turn:032}"}
    return client.get("/api/v1/designs", headers=wrong)


def _kept_yarn(client: httpx.Client, turn: int) -> httpx.Response:
    """Own yarns up to the limit, each replaced again and again."""
    yarn = client.get("/api/v1/materials/acrylic/document").json()
    named = {"identifier": f"mine-{turn % 50}", "name": f"Yarn {turn}"}
    return client.post("/api/v1/materials", json=yarn | named)


def _viewed(client: httpx.Client, turn: int) -> httpx.Response:
    """Views of large charts, and what one view may be asked for."""
    chart = {"fabric": "rib", "columns": 200, "rows": 200}
    body = {"chart": chart, "material": "acrylic"}
    return client.put(f"/api/v1/views/view-{turn % 20:08}", json=body)


def _frames(client: httpx.Client, turn: int) -> None:
    """Frames as large as a view takes them, which are no message of viser's."""
    name = f"frames-{turn % 4}"
    client.put(f"/api/v1/views/{name}", json=CHART)
    address = f"{str(client.base_url).replace('http', 'ws', 1).rstrip('/')}/view/{name}"
    headers = {"Authorization": client.headers["Authorization"]}
    protocols = [Subprotocol(f"viser-v{viser.__version__}")]
    with (
        contextlib.suppress(WebSocketException, OSError),
        connect(address, subprotocols=protocols, additional_headers=headers) as view,
    ):
        view.send(b"\xdd" * FRAME_BYTES)
        view.recv(5)


_random = random.Random(1)
_large_designs: dict[httpx.Client, str] = {}
ATTACKS: dict[str, Attack] = {
    "none": lambda client, _: time.sleep(0.2),
    "predictions of large charts": _post("/api/v1/predict", CHART | {"chart": BIG_CHART}),
    "predictions, each another": lambda client, _: client.post(
        "/api/v1/predict", json=CHART | {"chart": "".join(_random.choices("KP", k=2400))}
    ),
    "140,000 JSON values": _post("/api/v1/predict", b"[" + b"1," * 140_000 + b"1]"),
    "deep JSON": _post("/api/v1/predict", b'{"chart":' * 10_000),
    "140,000 wrong names": _post(
        "/api/v1/designs", b"{" + b",".join(b'"%d":1' % n for n in range(140_000)) + b"}"
    ),
    "a name that comes twice": _post(
        "/api/v1/predict", b"{" + b",".join(b'"%d":1' % n for n in range(7_000)) + b',"6999":1}'
    ),
    "numbers of 4,000 digits": _post(
        "/api/v1/designs", b"[" + b",".join([b"9" * 4_000] * 900) + b"]"
    ),
    "designs of 2 MB": _post(
        "/api/v1/designs", {"name": "x", "material": "acrylic", "chart": BIG_CHART}
    ),
    "jobs": lambda client, turn: client.post(
        "/api/v1/jobs",
        json={
            "kind": "stretch",
            "request": CHART | {"direction": "wale", "strain": 0.5 + turn % 99 / 999},
        },
    ),
    "picture bombs": _post("/api/v1/import", {"file": _uploaded("a.png", _picture_bomb())}),
    "workbooks of a million rows": _post(
        "/api/v1/measure/tables", {"file": _uploaded("a.xlsx", workbook(1_000_000, NUMBERS))}
    ),
    "fields that unpack to 50 MB": _post(
        "/api/v1/compare",
        {"field": _uploaded("a.npz", _zip_bomb()), "direction": "wale", "material": "acrylic"},
    ),
    "knitout of a long header": _post(
        "/api/v1/import",
        {"file": _uploaded("a.k", b";!knitout-2\n;;Carriers: " + b"1 " * 100_000)},
    ),
    "CSV of a long head": _post(
        "/api/v1/measure/tables", {"file": _uploaded("a.csv", b"," * 200_000)}
    ),
    "slow bodies": _slow_body,
    "endless heads": _endless_head,
    "strokes on large charts": _painted,
    "unread answers": _unread,
    "unread views": _unread_view,
    "wrong tokens": _wrong_token,
    "own yarns": _kept_yarn,
    "views of large charts": _viewed,
    "frames of a view": _frames,
}  # fmt: skip


def _repeat(url: str, token: str, attack: Attack, stop: Event, sent: Counter[int]) -> None:
    """Repeat an attack, and count its answers by status."""
    headers = {"Authorization": f"Bearer {token}", "Content-Type": "application/json"}
    with httpx.Client(base_url=url, headers=headers, timeout=60) as client:
        turn = _random.randrange(10**6)
        while not stop.is_set():
            turn += 1
            with contextlib.suppress(httpx.TransportError):
                answer = attack(client, turn)
                sent[answer.status_code if isinstance(answer, httpx.Response) else 0] += 1


def _attack(url: str, token: str, name: str, stop: Event, counted: Connection) -> None:
    """All of Mallory's threads; in a process of its own, or Alice would wait for them here, and a
    nice one, since it would be on another machine."""
    os.nice(10)
    sent = Counter[int]()
    given = url, token, ATTACKS[name], stop, sent
    threads = [threading.Thread(target=_repeat, args=given, daemon=True) for _ in range(AT_ONCE)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(STOPS_WITHIN_S)
    counted.send(sent)


@contextlib.contextmanager
def _attacked(url: str, token: str, name: str) -> Iterator[Counter[int]]:
    """Attack while the block runs; yields the answers by status, which are counted after it."""
    stop, (counted, counting) = FORKED.Event(), FORKED.Pipe(duplex=False)
    mallory = FORKED.Process(target=_attack, args=(url, token, name, stop, counting), daemon=True)
    mallory.start()
    sent = Counter[int]()
    try:
        yield sent
    finally:
        stop.set()
        sent.update(counted.recv())
        mallory.join()


def waits_ms(alice: httpx.Client, design: str, seconds: float) -> dict[str, list[float]]:
    """The waits of each of Alice's requests, and how late this machine woke her, milliseconds."""
    run = {"row": 0, "column": 0, "stitches": "P"}
    stroke = {"rows": 2, "columns": 2, "runs": [run]}
    requests: dict[str, Callable[[], httpx.Response]] = {
        "healthz": lambda: alice.get("/healthz"),
        "list": lambda: alice.get("/api/v1/designs?limit=1"),
        "stroke": lambda: alice.post(f"/api/v1/designs/{design}/strokes", json=stroke),
        "readyz": lambda: alice.get("/readyz"),
    }
    waits: dict[str, list[float]] = {name: [] for name in (*requests, MACHINE)}
    until = time.monotonic() + seconds
    while time.monotonic() < until:
        for name, send in requests.items():
            begun = time.perf_counter()
            answer = send()
            waits[name].append(1000 * (time.perf_counter() - begun))
            if answer.status_code != 200:
                print(f"  {name} of another user: {answer.status_code} {answer.text[:200]}")
        begun = time.perf_counter()
        time.sleep(PAUSE_S)
        waits[MACHINE].append(1000 * (time.perf_counter() - begun - PAUSE_S))
    return waits


def _shown(waits: list[float]) -> str:
    """Median, 99th percentile and longest of some waits."""
    ordered = sorted(waits)
    shown = (ordered[int(part * (len(ordered) - 1))] for part in (0.5, 0.99, 1.0))
    return "/".join(f"{wait:.0f}" for wait in shown)


@contextlib.contextmanager
def _serving(folder: Path) -> Iterator[tuple[Service, dict[str, str]]]:
    """A service with logins, and a token for each of two users."""
    (folder / "data").mkdir()
    with contextlib.closing(Database(f"sqlite:///{folder / 'data' / 'knitcore.sqlite3'}")) as store:
        migrate(store)
        tokens = {name: Tokens(store).create(name).token for name in ("alice", "mallory")}
    with Service(folder, require_login="true") as service:
        yield service, tokens


def main() -> int:
    """Print the longest waits, attack by attack."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", help="parts of the names of attacks; all by default")
    parser.add_argument("--seconds", type=float, default=15.0, help="of each attack")
    given: Any = parser.parse_args()
    chosen = [n for n in ATTACKS if not given.names or any(part in n for part in given.names)]
    missed = 0
    print(
        f"load {os.getloadavg()[0]:.1f}; waits of another user, ms: median, 99th percentile, "
        f"longest (at most {WAIT_MS:g}); last how late the machine wakes a sleeper"
    )
    names = "".join(f"{name:>13}" for name in ("healthz", "list", "stroke", "readyz", MACHINE))
    print(f"{'attack':28}{names}   MB  answers", flush=True)
    with tempfile.TemporaryDirectory() as name, _serving(Path(name)) as (service, tokens):
        headers = {"Authorization": f"Bearer {tokens['alice']}"}
        with httpx.Client(base_url=service.url, headers=headers, timeout=60) as alice:
            design = alice.post(
                "/api/v1/designs", json={"name": "x", "material": "acrylic", "chart": "KP\nPK"}
            ).json()["id"]
            waits_ms(alice, design, 2.0)
            for attack in chosen:
                with _attacked(service.url, tokens["mallory"], attack) as sent:
                    waits = waits_ms(alice, design, given.seconds)
                numbers = "".join(f"{_shown(each):>13}" for each in waits.values())
                memory = resident_mb(service.pid)
                print(
                    f"{attack:28}{numbers} {memory:4.0f}  {dict(sorted(sent.items()))}", flush=True
                )
                missed += max(max(waits[name]) for name in waits if name != MACHINE) > WAIT_MS
    print(f"{missed} of {len(chosen)} over the target; load {os.getloadavg()[0]:.1f}")
    return bool(missed)


if __name__ == "__main__":
    sys.exit(main())
