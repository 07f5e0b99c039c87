"""Services with the settings of a test, and what their clients need."""

import contextlib
from collections.abc import Iterator
from typing import Any

import viser
from fastapi import FastAPI
from fastapi.testclient import TestClient
from starlette.routing import BaseRoute
from starlette.websockets import WebSocketDisconnect

from app.service.limits.user_limits import ConcurrencyLimit, UserLimits
from app.service.main import create_app
from app.service.settings import Settings
from app.service.store.database import Database
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


_ROUTES: dict[int, BaseRoute] = {}
"""Routes of the services so far, by the identity of the router that has them."""


@contextlib.contextmanager
def served(
    base_url: str = "http://127.0.0.1", database: Database | None = None, **settings: Any
) -> Iterator[TestClient]:
    """A client of a service of its own, which has one worker unless the settings say otherwise."""
    app = create_app(Settings(**{"workers": 1} | settings), database)
    _share_routes(app)
    with TestClient(app, base_url=base_url, raise_server_exceptions=False) as client:
        yield client


def _share_routes(app: FastAPI) -> None:
    """Give a service the routes of those before it, which take it as long as the rest to make."""
    for place, route in enumerate(app.router.routes):
        if router := getattr(route, "original_router", None):
            app.router.routes[place] = _ROUTES.setdefault(id(router), route)


def state_of(client: TestClient) -> Any:
    """The state that a service keeps while it runs."""
    return client.app.state  # type: ignore[attr-defined]


@contextlib.contextmanager
def limited(client: TestClient, **most: int) -> Iterator[ConcurrencyLimit]:
    """While the block runs, each user of a service may hold so much at once."""
    state = state_of(client)
    before, state.concurrency = state.concurrency, ConcurrencyLimit(UserLimits(**most))
    try:
        yield state.concurrency
    finally:
        state.concurrency = before


def tokens_of(client: TestClient) -> Tokens:
    """Tokens of the users of a service."""
    return Tokens(state_of(client).database)


def login(client: TestClient, user: str) -> dict[str, str]:
    """The header of requests of a user, with a new token."""
    return bearing(tokens_of(client).create(user).token)


def bearing(token: str) -> dict[str, str]:
    """The header of requests with a token."""
    return {"Authorization": f"Bearer {token}"}


def watching(client: TestClient, address: str, **headers: str) -> Any:
    """The websocket of a browser that shows the view at an address."""
    url = f"{str(client.base_url).replace('http', 'ws')}/{address.lstrip('/')}"
    return client.websocket_connect(url, subprotocols=VIEW_PROTOCOLS, headers=headers)


def drain(socket: Any) -> int:
    """Receive until the service closes a websocket; returns its code."""
    try:
        while True:
            socket.receive_bytes()
    except WebSocketDisconnect as closed:
        return closed.code


def closed_with(client: TestClient, address: str, **headers: str) -> int:
    """The code with which the service closes the websocket of a view at once."""
    try:
        with watching(client, address, **headers) as socket:
            return drain(socket)
    except WebSocketDisconnect as closed:
        return closed.code
