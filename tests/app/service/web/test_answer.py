"""An answer ends once, at whatever moment the token or session of its request ends."""

import asyncio
import contextlib
import json
import threading
from collections.abc import Awaitable, Callable, Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import httpx2 as httpx
import pytest
from fastapi import FastAPI
from starlette.background import BackgroundTask
from starlette.requests import ClientDisconnect
from starlette.responses import Response, StreamingResponse
from starlette.types import Message, Receive, Scope, Send

from app.service.limits.user_limits import USER_LIMITS, ConcurrencyLimit
from app.service.main import create_app
from app.service.problems import StoreError
from app.service.settings import Settings
from app.service.web import security, sessions
from app.service.web.answer import PART_BYTES
from app.service.web.security import PAGE_POLICY, AccessControl
from app.service.web.sessions import Tokens
from tests.app.running import on_a_server

CLOSE = {"type": "websocket.close", "code": 1008, "reason": "signed out"}


def _head(length: int | None = None) -> Message:
    headers = [] if length is None else [(b"content-length", str(length).encode())]
    return {"type": "http.response.start", "status": 200, "headers": headers}


def _without_headers(message: Message) -> Message:
    return {**message, "headers": []} if "headers" in message else message


def _part(content: bytes, more: bool = True) -> Message:
    return {"type": "http.response.body", "body": content, "more_body": more}


class Login:
    """A login that a test ends, and that is noticed to be looked at."""

    is_stopping = False
    stop: Callable[[], object]

    def __init__(self) -> None:
        self.has_ended = False
        self.looked = threading.Event()
        self.failure: Exception | None = None

    def by_token(self, _token: str, *, at_once: bool) -> tuple[str, str]:
        return "an-id", "ada"

    def is_open(self, _identifier: str, _session: str, *, at_once: bool) -> bool:
        self.looked.set()
        if self.failure is not None:
            raise self.failure
        return not self.has_ended

    async def until_looked(self, times: int = 1) -> None:
        """Wait until the guard has looked so many times more."""
        for _ in range(times):
            self.looked.clear()
            assert await asyncio.to_thread(self.looked.wait, 60)

    async def until_stopped(self) -> None:
        """End, and wait for the guard to cancel this."""
        self.has_ended = True
        await asyncio.Event().wait()


@pytest.fixture(autouse=True)
def _quick(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in (security, sessions):
        monkeypatch.setattr(module, "REMEMBERED_S", 0.01)


Script = Callable[[Login, Send, Receive], Awaitable[None]]
"""Things that an application does with a request."""


def _sent(
    script: Script,
    kind: str = "http",
    heard: tuple[Message, ...] = (),
    slowly: Callable[[Login, Message], Awaitable[None]] | None = None,
    login: Login | None = None,
) -> list[Message]:
    """Messages of a guarded application to a bare server, which may take one slowly."""
    login, taken = login or Login(), list[Message]()
    waiting = list(heard)
    passes = SimpleNamespace(holder=lambda _: None)
    state = SimpleNamespace(
        passes=passes, login=login, concurrency=ConcurrencyLimit(), stopping=login.is_stopping
    )
    scope: Scope = {
        "type": kind,
        "method": "GET",
        "path": "/api/v1/something",
        "headers": [(b"host", b"127.0.0.1"), (b"authorization", b"Bearer x")],
        "client": ("127.0.0.1", 1),
        "app": SimpleNamespace(state=state),
    }

    async def receive() -> Message:
        return waiting.pop(0) if waiting else await asyncio.Event().wait()  # type: ignore[return-value]

    async def send(message: Message) -> None:
        if slowly is not None:
            await slowly(login, message)
        taken.append(_without_headers(message))

    async def application(_scope: Scope, receive: Receive, send: Send) -> None:
        await script(login, send, receive)

    async def scenario() -> None:
        guard = AccessControl(application, Settings(require_login=True))
        request = asyncio.ensure_future(guard(scope, receive, send))
        loop = asyncio.get_running_loop()
        login.stop = lambda: loop.call_soon_threadsafe(request.cancel)
        async with asyncio.timeout(60):
            await request

    asyncio.run(scenario())
    return taken


END: Message = {"type": "http.response.body", "body": b""}


@pytest.mark.parametrize(
    ("said", "ended"),
    [
        ([_head(), _part(b"some")], [END]),
        ([_head(4), _part(b"some")], [END]),
        ([_head(4), _part(b"so")], []),  # the server closes the connection
    ],
    ids=["a stream", "all bytes", "bytes are missing"],
)
def test_in_its_middle_an_answer_ends_as_far_as_it_is_whole(
    said: list[Message], ended: list[Message]
) -> None:
    async def script(login: Login, send: Send, _receive: Receive) -> None:
        for message in said:
            await send(message)
        try:
            await login.until_stopped()
        finally:
            await send(_part(b"a last word", more=False))  # which is dropped

    assert _sent(script) == [*map(_without_headers, said), *ended]


def test_before_its_start_the_answer_is_a_problem_and_what_fails_then_is_logged(
    caplog: pytest.LogCaptureFixture,
) -> None:
    async def script(login: Login, _send: Send, _receive: Receive) -> None:
        try:
            await login.until_stopped()
        finally:
            raise ZeroDivisionError

    head, body = _sent(script)
    assert (head["status"], b"/problems/sign-in" in body["body"]) == (401, True)
    assert "ZeroDivisionError" in caplog.text


def test_a_stop_during_the_login_is_answered_with_a_problem() -> None:
    class Stopping(Login):
        is_stopping = True

        def by_token(self, token: str, *, at_once: bool = False) -> tuple[str, str]:
            if at_once:
                raise sessions.NotRememberedError("")
            self.stop()
            return super().by_token(token, at_once=at_once)

    async def script(_login: Login, send: Send, _receive: Receive) -> None:
        await send(_head())

    head, body = _sent(script, login=Stopping())
    assert (head["status"], json.loads(body["body"])["type"]) == (503, "/problems/busy")
    assert _sent(script, "websocket", login=Stopping()) == [CLOSE | {"reason": "refused"}]


def test_what_is_complete_is_neither_cancelled_nor_added_to() -> None:
    went_on = []

    async def script(login: Login, send: Send, _receive: Receive) -> None:
        await send(_head())
        await send(_part(b"all", more=False))
        login.has_ended = True
        await login.until_looked(2)  # the second time, the guard has seen the first answer
        went_on.append(True)

    assert _sent(script) == [_head(), _part(b"all", more=False)]
    assert went_on == [True]


def test_a_message_that_the_server_takes_is_not_cut() -> None:
    async def script(login: Login, send: Send, _receive: Receive) -> None:
        await send(_head())
        login.has_ended = True
        await send(_part(b"slow"))
        await asyncio.Event().wait()

    async def slowly(login: Login, message: Message) -> None:
        if message.get("body") == b"slow":
            await login.until_looked()
            await asyncio.sleep(security.REMEMBERED_S)  # the guard would cancel it

    assert _sent(script, slowly=slowly) == [_head(), _part(b"slow"), END]


def test_a_large_answer_is_handed_over_in_parts() -> None:
    content = bytes(range(256)) * 600

    async def whole(_: Login, send: Send, __: Receive) -> None:
        await send(_head(len(content)))
        await send(_part(content, more=False))

    head, *parts = _sent(whole)
    assert head["status"] == 200
    assert b"".join(part["body"] for part in parts) == content
    assert max(len(part["body"]) for part in parts) == PART_BYTES
    assert [part["more_body"] for part in parts] == [True, True, False]


def test_an_answer_beyond_what_may_wait_unread_is_refused() -> None:
    content = bytes(USER_LIMITS.unsent_bytes + 1)

    async def whole(_: Login, send: Send, __: Receive) -> None:
        await send(_head(len(content)))
        await send(_part(content, more=False))

    head, problem = _sent(whole)
    assert head["status"] == 429
    assert json.loads(problem["body"])["field"] == "unsent_bytes"


def test_a_request_outlasts_a_lost_database() -> None:
    async def script(login: Login, send: Send, _receive: Receive) -> None:
        login.failure = StoreError("away")
        await login.until_looked()
        await send(_head())
        await send(_part(b"all", more=False))

    assert _sent(script) == [_head(), _part(b"all", more=False)]


def test_a_request_that_ends_its_own_session_is_answered() -> None:
    """Also where the guard asks just then."""
    scope: Scope = {security.OPENED_BY: ("", "a session")}

    def is_open(*_: str, at_once: bool) -> bool:
        del scope[security.OPENED_BY]
        return False

    login = SimpleNamespace(is_open=is_open)
    scope["app"] = SimpleNamespace(state=SimpleNamespace(login=login))
    guard = AccessControl(SimpleNamespace(), Settings())  # type: ignore[arg-type]
    for _ in range(2):
        assert asyncio.run(guard._is_open(scope))


@pytest.mark.parametrize("before", [[_head()], [_head(), _part(b"all", more=False)]])
def test_a_client_that_leaves_gets_no_second_start(before: list[Message]) -> None:
    async def script(_login: Login, send: Send, _receive: Receive) -> None:
        for message in before:
            await send(_without_headers(message))
        raise ClientDisconnect

    assert _sent(script) == before


@pytest.mark.parametrize("accepts", [False, True])
def test_a_websocket_is_closed(accepts: bool) -> None:
    accept = [{"type": "websocket.accept"}] * accepts

    async def script(login: Login, send: Send, _receive: Receive) -> None:
        for message in accept:
            await send(message)
        await login.until_stopped()

    assert _sent(script, "websocket") == [*accept, CLOSE]


@pytest.mark.parametrize("by", ["application", "client"])
def test_a_closed_websocket_is_not_closed_again(by: str) -> None:
    closed: Message = {"type": "websocket.close", "code": 1000}

    async def script(login: Login, send: Send, receive: Receive) -> None:
        if by == "client":
            await receive()
        else:
            await send(closed)
        login.has_ended = True
        await login.until_looked(2)

    left: Message = {"type": "websocket.disconnect", "code": 1001}
    assert _sent(script, "websocket", (left,)) == ([] if by == "client" else [closed])


def _with_slow_answers(folder: Path) -> tuple[FastAPI, threading.Event]:
    """The service with answers that never end by themselves, and an event for their beginning."""
    app = create_app(Settings(require_login=True, workers=1, data_dir=folder))
    begun = threading.Event()

    async def parts() -> Any:
        yield b"some"
        begun.set()
        await asyncio.Event().wait()

    async def after() -> None:
        begun.set()
        await asyncio.sleep(20 * security.REMEMBERED_S)

    @app.get("/api/v1/slow/{kind}")
    async def slow(kind: str) -> Response:
        if kind == "none":
            begun.set()
            await asyncio.Event().wait()
        if kind == "complete":
            return Response(b"all", background=BackgroundTask(after))
        headers = {"Content-Length": "100"} if kind == "sized" else None
        return StreamingResponse(parts(), headers=headers)

    return app, begun


@contextlib.contextmanager
def _revoked_when(app: FastAPI, begun: threading.Event) -> Iterator[dict[str, str]]:
    """The header of a token that is revoked when an answer has begun."""
    store = Tokens(app.state.database)
    token = store.create("ada")

    def revoke() -> None:
        assert begun.wait(60)
        store.revoke(token.id)

    thread = threading.Thread(target=revoke)
    thread.start()
    yield {"Authorization": f"Bearer {token.token}"}
    thread.join()
    begun.clear()


def test_every_moment_of_an_answer(tmp_path: Path, caplog: pytest.LogCaptureFixture) -> None:
    app, begun = _with_slow_answers(tmp_path)
    with on_a_server(app) as url, httpx.Client(base_url=url, timeout=60.0) as client:
        with _revoked_when(app, begun) as bearer:
            answer = client.get("/api/v1/slow/none", headers=bearer)
        assert (answer.status_code, answer.json()["type"]) == (401, "/problems/sign-in")
        assert answer.headers["content-type"] == "application/problem+json"
        assert answer.headers["Content-Security-Policy"] == PAGE_POLICY
        assert answer.headers["X-Request-ID"]
        for path, content in (("stream", b"some"), ("complete", b"all")):
            with _revoked_when(app, begun) as bearer:
                answer = client.get(f"/api/v1/slow/{path}", headers=bearer)
            assert (answer.status_code, answer.content) == (200, content)
        with _revoked_when(app, begun) as bearer, pytest.raises(httpx.RemoteProtocolError):
            client.get("/api/v1/slow/sized", headers=bearer)
    assert "Traceback" not in caplog.text
    assert "RuntimeError" not in caplog.text
