"""Services with the settings of a test, and what their clients need."""

import contextlib
from collections.abc import Iterator
from typing import Any

import viser
from fastapi.testclient import TestClient

from app.service.main import create_app
from app.service.settings import Settings
from app.service.web.sessions import Tokens

VIEW_PROTOCOLS = [f"viser-v{viser.__version__}"]

LONG = {
    "chart": {"fabric": "garter", "columns": 150, "rows": 150},
    "material": "acrylic",
    "direction": "wale",
    "strain": 0.5,
    "steps": 60,
}
"""A stretch test that takes minutes."""


@contextlib.contextmanager
def served(base_url: str = "http://127.0.0.1", **settings: Any) -> Iterator[TestClient]:
    """A client of a service of its own, which has one worker unless the settings say otherwise."""
    app = create_app(Settings(**{"workers": 1} | settings))
    with TestClient(app, base_url=base_url, raise_server_exceptions=False) as client:
        yield client


def state_of(client: TestClient) -> Any:
    """The state that a service keeps while it runs."""
    return client.app.state  # type: ignore[attr-defined]


def tokens_of(client: TestClient) -> Tokens:
    """Tokens of the users of a service."""
    return Tokens(state_of(client).database)


def bearing(token: str) -> dict[str, str]:
    """The header of requests with a token."""
    return {"Authorization": f"Bearer {token}"}


def watching(client: TestClient, address: str, **headers: str) -> Any:
    """The websocket of a browser that shows the view at an address."""
    url = f"{str(client.base_url).replace('http', 'ws')}/{address.lstrip('/')}"
    return client.websocket_connect(url, subprotocols=VIEW_PROTOCOLS, headers=headers)


def drain(socket: Any) -> None:
    """Receive until the service closes a websocket, which raises."""
    while True:
        socket.receive_bytes()
