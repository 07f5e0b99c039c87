"""The shipped nginx configuration in front of the service; `apt-get install nginx-light`."""

import asyncio
import contextlib
import socket
import time
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor

import httpx2 as httpx
import pytest
import viser
import websockets

from app.service.settings import Settings
from scripts.composition import free_port, nginx, proxied
from tests.app.running import Service

PATIENCE_S = 60.0
MOST_BYTES: int = Settings.model_fields["max_body_bytes"].default
CHART = {"chart": "KP/PK", "material": "acrylic"}

pytestmark = pytest.mark.skipif(nginx() is None, reason="Debian's nginx-light is not installed")


@pytest.fixture(scope="module")
def url(tmp_path_factory: pytest.TempPathFactory) -> Iterator[str]:
    """The address of nginx in front of a service."""
    folder = tmp_path_factory.mktemp("proxy")
    port = free_port()
    changes = {
        r"(listen 127\S+);": r"\1 sndbuf=16k;",
        r"(client_\w+_timeout|send_timeout) \d+s;": r"\1 1s;",
    }
    with (
        Service(folder, trusted_proxies='["127.0.0.1"]') as service,
        proxied(folder, service, port, changes),
    ):
        yield f"http://127.0.0.1:{port}"


@pytest.fixture
def connection(url: str) -> Iterator[socket.socket]:
    """A connection to nginx whose receive buffer is small."""
    host, _, port = url.removeprefix("http://").partition(":")
    with socket.socket() as connection:
        connection.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        connection.settimeout(PATIENCE_S)
        connection.connect((host, int(port)))
        yield connection


def _all_that_comes(connection: socket.socket) -> bytes:
    """Everything until the other side closes the connection."""
    parts = []
    with contextlib.suppress(ConnectionError):
        while part := connection.recv(65_536):
            parts.append(part)
    return b"".join(parts)


def test_the_page_and_an_operation_pass(url: str) -> None:
    with httpx.Client(base_url=url, timeout=PATIENCE_S) as client:
        assert client.get("/healthz").json() == {"status": "ok"}
        assert "<title>" in client.get("/").text
        answer = client.post("/api/v1/predict", json=CHART)
        assert answer.status_code == 200
        assert answer.json()["modulus_course_n_per_mm"] > 0
        origin = {"Origin": "https://elsewhere.example"}
        assert client.post("/api/v1/predict", json=CHART, headers=origin).status_code == 403


@pytest.mark.parametrize(
    ("path", "size", "title"),
    [
        ("/api/v1/fit", MOST_BYTES + 1, "The request is too large"),  # refused by nginx
        ("/api/v1/designs", 20_000_000, "The request is too large"),  # by the service, unread
    ],
)
def test_a_body_over_a_limit_is_explained(url: str, path: str, size: int, title: str) -> None:
    answer = httpx.post(f"{url}{path}", content=bytes(size), timeout=PATIENCE_S)
    assert (answer.status_code, answer.json()["title"]) == (413, title)
    assert answer.json()["field"] == "body"
    assert answer.headers["content-type"] == "application/problem+json"


def test_a_large_body_that_is_refused_unread_is_answered(url: str) -> None:
    origin = {"Origin": "https://elsewhere.example"}
    for _ in range(3):
        answer = httpx.post(
            f"{url}/api/v1/fit", content=bytes(20_000_000), headers=origin, timeout=PATIENCE_S
        )
        assert answer.status_code == 403


@pytest.mark.parametrize("sent", [b"", b"GET / HTTP/1.1\r\nHost: here\r\n"])
def test_a_client_that_sends_no_whole_head_is_disconnected(
    connection: socket.socket, sent: bytes
) -> None:
    connection.sendall(sent)
    assert b"200 OK" not in _all_that_comes(connection)


def test_a_slow_body_is_closed(connection: socket.socket) -> None:
    head = b"POST /api/v1/predict HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: 1000\r\n\r\n"
    connection.sendall(head + b"{")
    assert b"200 OK" not in _all_that_comes(connection)


@pytest.mark.parametrize(
    ("head", "status"),
    [
        (b"GET /" + b"a" * 40_000 + b" HTTP/1.1\r\nHost: here\r\n\r\n", b"414"),
        (b"GET / HTTP/1.1\r\nHost: here\r\nA: " + b"a" * 40_000 + b"\r\n\r\n", b"400"),
        (b"GET / HTTP/1.1\r\nHost: here\r\n" + b"A: b\r\n" * 10_000 + b"\r\n", b"400"),
    ],
    ids=["address", "header", "headers"],
)
def test_a_head_that_is_too_large_is_refused(
    connection: socket.socket, head: bytes, status: bytes
) -> None:
    with contextlib.suppress(ConnectionError):  # closed before all was sent
        connection.sendall(head)
    answer = _all_that_comes(connection)
    assert answer == b"" or answer.startswith(b"HTTP/1.1 " + status)


@pytest.mark.slow
def test_an_unread_answer_is_closed(url: str, connection: socket.socket) -> None:
    whole = httpx.get(
        f"{url}/openapi.json", headers={"Accept-Encoding": "identity"}, timeout=PATIENCE_S
    )
    assert len(whole.content) > 200_000  # more than the kernel's buffers here
    head = b"GET /openapi.json HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: close\r\n\r\n"
    connection.sendall(head)
    time.sleep(2.5)  # over twice the time limit
    assert len(_all_that_comes(connection)) < len(whole.content)


def test_a_view_is_watched_through_a_websocket(url: str) -> None:
    with httpx.Client(base_url=url, timeout=PATIENCE_S) as client:
        name = "a-design-to-watch"
        assert client.put(f"/api/v1/views/{name}", json=CHART).status_code < 300

        async def first_message() -> bytes | str:
            address = f"{url.replace('http', 'ws')}/view/{name}"
            protocol = websockets.Subprotocol(f"viser-v{viser.__version__}")
            origin = websockets.Origin(url)
            async with websockets.connect(
                address, origin=origin, subprotocols=[protocol], max_size=None
            ) as view:
                return await asyncio.wait_for(view.recv(), PATIENCE_S)

        with ThreadPoolExecutor(1) as own_loop:  # this thread may have a loop that runs
            assert own_loop.submit(lambda: asyncio.run(first_message())).result(PATIENCE_S)
