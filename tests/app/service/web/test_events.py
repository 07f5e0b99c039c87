"""Requests that nobody waits for any longer."""

import asyncio
from types import SimpleNamespace
from typing import Any

import pytest
from starlette.requests import Request

from app.service.problems import StoppingError
from app.service.web.events import abandoned


def _request(message: str, *, stopping: bool = False) -> Request:
    async def receive() -> dict[str, Any]:
        return {"type": message}

    app = SimpleNamespace(state=SimpleNamespace(stopping=stopping))
    return Request({"type": "http", "app": app}, receive)


def test_an_answer_is_wanted_until_the_client_goes() -> None:
    assert not asyncio.run(abandoned(_request("http.request")))
    assert asyncio.run(abandoned(_request("http.disconnect")))


def test_a_stopping_service_refuses_what_is_waited_for() -> None:
    with pytest.raises(StoppingError):
        asyncio.run(abandoned(_request("http.request", stopping=True)))
