"""Access control: host and origin checks, the token, size limits, response headers.

A browser carries its user's network position to any page it shows, so even a service on loopback
must refuse requests that another site's page makes it send.
"""

import asyncio
import contextlib
import logging
import sys
from collections.abc import Callable, Mapping
from typing import TypeVar
from urllib.parse import parse_qs, urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.requests import ClientDisconnect
from starlette.responses import RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette.websockets import WebSocketClose

from ..identity import NOBODY, current_session, current_user
from ..limits.fair_queue import FairLock
from ..limits.user_limits import ConcurrencyLimit, RateLimit
from ..problems import (
    RefusedError,
    ServiceError,
    StoppingError,
    StoreError,
    TooLargeError,
    TooManyError,
)
from ..settings import Settings
from .answer import Answer
from .bodies import limited
from .errors import answer_to, unexpected
from .passes import Opener, ViewPasses
from .reference import PAGES
from .sessions import REMEMBERED_S, SESSION_S, Login, NotRememberedError
from .sign_in import PATH, sign_in_form, sign_in_page, token_page

log = logging.getLogger("knitcore.app")
T = TypeVar("T")

SESSION_COOKIE = "knitcore_session"
GONE = 499
"""Status, in the log only, of a request whose client left before it was complete."""
OPENED_BY = "knitcore.opened_by"
"""Token and session of a request, in its scope."""
LIMITS = "knitcore.limits"
"""Headers of the answer about the user's rate of requests, in the scope."""
ON_THEIR_WAY = 3
"""Messages of a view that one unread by its browser keeps in memory: itself and two behind it."""
REFUSED_AFTER_S = 0.5
"""Wait before a request that comes too often is refused: at once, a client that repeats it without
a pause would keep the service busy with refusals."""
LOGIN_FAILURES = 20
"""Unknown tokens that one address may try before it must wait 10 s for each. A right token is
always accepted: 256 random bits cannot be guessed, and a stranger cannot lock others out."""
LOOKUPS = 2
"""Logins that are read from the database at once, one for each user or stranger's address."""
LOOPBACK_NAMES = frozenset({"localhost", "127.0.0.1", "[::1]", "::1"})
HOST_REMEDY = "Use its own address, or add the name to KNITCORE_ALLOWED_HOSTS."
OPEN_PATHS = PAGES | {"/healthz", "/readyz"}

PAGE_POLICY = "; ".join(
    [
        "default-src 'self'",
        "script-src 'self'",
        "style-src 'self' 'unsafe-inline'",  # plotly sets style elements of its own
        "img-src 'self' data: blob:",
        "connect-src 'self'",
        "frame-src 'self'",
        "frame-ancestors 'self'",
        "base-uri 'none'",
        "form-action 'none'",
        "object-src 'none'",
    ]
)
VIEW_POLICY = "; ".join(
    [
        "sandbox allow-scripts",  # even if opened on its own: it must not share our origin
        "default-src 'self' data: blob:",
        # viser's client is one file with inline script and WebAssembly workers
        "script-src 'self' 'unsafe-inline' 'wasm-unsafe-eval' data: blob:",
        "style-src 'self' 'unsafe-inline'",
        "worker-src blob: data: 'self'",
        "connect-src 'self' data: blob:",  # so ?websocket=ws://elsewhere cannot be obeyed
        "frame-ancestors 'self'",
        "base-uri 'none'",
        "form-action 'none'",
        "object-src 'none'",
    ]
)


class StrangeAddressError(RefusedError):
    """Error: the address or its host cannot be one of this service."""

    status = 400


class UnknownUserError(ServiceError):
    """Error: a token is needed."""

    status, type, title = 401, "sign-in", "Sign in"
    headers: Mapping[str, str] = {"WWW-Authenticate": 'Bearer realm="Knitcore"'}


class AccessControl:
    """ASGI middleware that refuses what must not reach the application.

    Parameters
    ----------
    app : the application behind.
    settings : hosts, token and size limit.
    """

    def __init__(self, app: ASGIApp, settings: Settings) -> None:
        self.app = app
        self.settings = settings
        self.hosts = LOOPBACK_NAMES | {h.lower() for h in settings.allowed_hosts}
        if settings.host not in ("0.0.0.0", "::"):  # noqa: S104 - a comparison, not a bind
            self.hosts |= {settings.host.lower()}
        self.rate = RateLimit(settings.requests_per_s, int(4 * settings.requests_per_s))
        self.failures = RateLimit(0.1, LOGIN_FAILURES)
        self.lookups = FairLock(LOOKUPS, most_each=1, most_waiting=sys.maxsize)

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Check one connection and pass it on."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        scope["headers"] = with_own_cookie_only(scope["headers"])
        if self.settings.asks_for_login:
            current_user.set(NOBODY)  # until the request's token or session is known
        try:
            answer = await self._admitted(scope, receive)
        except ServiceError as error:
            answer = answer_to(error)
        except asyncio.CancelledError:  # the service stops, and does not wait any longer
            if not scope["app"].state.stopping:
                raise
            answer = answer_to(_stopping())
        if scope["type"] == "websocket":
            await self._pass_socket(answer, scope, receive, send)
        else:
            await self._pass_request(answer, scope, receive, send)

    async def _admitted(self, scope: Scope, receive: Receive) -> Response | None:
        """Let a connection in and note whose it is; a response where the application is not asked.

        Raises
        ------
        ServiceError
            If it is refused.
        """
        passes: ViewPasses = scope["app"].state.passes
        opener = passes.holder(scope)
        self._check(scope, has_pass=opener is not None)
        try:
            if opener is not None:
                await self._by_pass(scope, opener)
            elif self.settings.asks_for_login and _is_sign_in(scope):
                return await self._signed_in(scope, receive)
            elif self.settings.asks_for_login and scope["path"] not in OPEN_PATHS:
                return await self._login(scope)
        except TooManyError:
            await asyncio.sleep(REFUSED_AFTER_S)
            raise
        return None

    async def _pass_socket(
        self, answer: Response | None, scope: Scope, receive: Receive, send: Send
    ) -> None:
        if answer is not None:
            await WebSocketClose(code=1008, reason="refused")(scope, receive, send)
            return
        concurrency: ConcurrencyLimit = scope["app"].state.concurrency

        async def send_counted(message: Message) -> None:
            with concurrency.growing("unsent_bytes", current_user.get()) as count:
                count(ON_THEIR_WAY * len(message.get("bytes") or b""))
                await send(message)

        answered = Answer(send_counted)

        async def heard() -> Message:
            return answered.heard(await receive())

        if not await self._run_while_open(scope, heard, answered):
            await answered.end(WebSocketClose(code=1008, reason="signed out"), scope, receive)

    async def _pass_request(
        self, answer: Response | None, scope: Scope, receive: Receive, send: Send
    ) -> None:
        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                view = scope["path"].startswith("/view/")
                headers.setdefault("Content-Security-Policy", VIEW_POLICY if view else PAGE_POLICY)
                headers["X-Content-Type-Options"] = "nosniff"
                headers.setdefault("Referrer-Policy", "no-referrer")
                headers["Cross-Origin-Opener-Policy"] = "same-origin"
                headers["Cross-Origin-Resource-Policy"] = "same-origin"
                headers.setdefault("Cache-Control", "private, no-cache")
                headers.update(scope.get(LIMITS, {}))
            await send(message)

        if answer is not None:
            await answer(scope, receive, send_with_headers)
            return
        concurrency: ConcurrencyLimit = scope["app"].state.concurrency
        user = current_user.get()
        with (
            concurrency.growing("body_bytes", user) as count,
            concurrency.growing("unsent_bytes", user) as count_unsent,
        ):
            received = limited(receive, self.settings.max_body_bytes, count)
            answered = Answer(send_with_headers, count_unsent)
            await self._answer(scope, received, answered, send_with_headers)

    async def _answer(self, scope: Scope, receive: Receive, answered: Answer, send: Send) -> None:
        """Run the application, and end the answer that it could not give."""
        try:
            if not await self._run_while_open(scope, receive, answered):
                await answered.end(answer_to(_signed_out()), scope, receive)
            elif answered.refusal is not None:
                await answered.end(answer_to(answered.refusal), scope, receive)
        except asyncio.CancelledError:
            if answered.started or not scope["app"].state.stopping:
                raise
            await answer_to(_stopping())(scope, receive, send)
        except ClientDisconnect:  # before its request was complete; only the log says so
            if not answered.started:
                await Response(status_code=GONE)(scope, receive, send)
        except Exception as error:  # answered here, so that its answer has the headers, too
            if answered.started:
                raise
            await unexpected(error)(scope, receive, send)

    def _check(self, scope: Scope, *, has_pass: bool) -> None:
        """Refuse other names, changes from pages of other sites, bodies that are too large, and
        addresses with a NUL, which PostgreSQL does not take."""
        headers = Headers(scope=scope)
        hosts = headers.getlist("host")
        host = hosts[0] if len(hosts) == 1 else ""
        if not self._knows(host):
            raise StrangeAddressError(
                "This service does not have that host name.", field="host", remedy=HOST_REMEDY
            )
        origin = headers.get("origin")
        changes = scope["type"] == "websocket" or scope["method"] not in ("GET", "HEAD", "OPTIONS")
        own = has_pass or origin is None or _place_of(origin) == host.lower()
        if changes and not own:
            raise RefusedError("The request comes from a page of another site.", field="origin")
        if "\0" in scope["path"] or b"%00" in scope.get("query_string", b""):
            raise StrangeAddressError(
                "The address holds the character NUL.", field="address", remedy="Leave %00 out."
            )
        length = headers.get("content-length", "0")
        if not length.isdigit() or int(length) > self.settings.max_body_bytes:
            raise TooLargeError(
                "The request is too large.",
                field="body",
                remedy=f"Send at most {self.settings.max_body_bytes} bytes.",
            )

    def _knows(self, host: str) -> bool:
        try:
            name = urlsplit(f"//{host}").hostname
        except ValueError:
            return False
        return name is not None and (name in self.hosts or f"[{name}]" in self.hosts)

    async def _by_pass(self, scope: Scope, opener: Opener) -> None:
        """Let the holder of a pass in while the token or session that asked for it is valid."""
        if opener.opened_by is not None:
            login: Login = scope["app"].state.login
            if not await self._known(scope, login.is_open, *opener.opened_by):
                raise RefusedError(
                    "This pass has ended.", field="pass", remedy="Show the view again."
                )
            scope[OPENED_BY] = opener.opened_by
        current_user.set(opener.user)
        current_session.set(opener.session)
        if opener.opened_by is not None:
            self._count(scope, opener.user)

    async def _login(self, scope: Scope) -> Response | None:
        """Let a known user in, unless requests come too often, and note who it is."""
        login: Login = scope["app"].state.login
        headers = Headers(scope=scope)
        token, cookie = _bearer(headers), _cookie(headers)
        link = _link_token(scope.get("query_string", b""))
        identifier, user, session = await self._known(scope, _who, login, token, link, cookie)
        if not user:
            return self._stranger(scope, tried=bool(token or link))
        current_user.set(user)
        self._count(scope, user)
        current_session.set(session)
        scope[OPENED_BY] = identifier, session
        if link and not (token or session) and scope["type"] == "http" and scope["method"] == "GET":
            return await self._by_link(scope, identifier, user, link)
        return None

    def _stranger(self, scope: Scope, *, tried: bool) -> Response:
        """Ask for a token; after several unknown ones the address must wait."""
        if tried and self.failures.take(_address(scope))[1]:
            raise TooManyError("Too many unknown tokens came from this address.", 10.0)
        if _is_sign_in(scope) or (
            scope["path"] == "/" and "text/html" in Headers(scope=scope).get("accept", "")
        ):
            return token_page(401, "This token is unknown. Ask for a new one." if tried else "")
        raise UnknownUserError(
            "This service requires a token.",
            field="token",
            remedy="Open the page as /?token=…, or send the header Authorization: Bearer ….",
        )

    def _count(self, scope: Scope, user: str) -> None:
        """Refuse more requests than one user may send; say how many are left."""
        left, wait = self.rate.take(user)
        burst = str(self.rate.burst)
        scope[LIMITS] = {"RateLimit-Limit": burst, "RateLimit-Remaining": str(left)}
        if wait:
            raise TooManyError("You are sending requests too often.", wait)
        concurrency: ConcurrencyLimit = scope["app"].state.concurrency
        concurrency.check("connections", user)

    async def _by_link(self, scope: Scope, identifier: str, user: str, link: str) -> Response:
        """Keep a session in a cookie, and the token out of the address; after a click, if another
        site led here or another user is signed in."""
        headers = Headers(scope=scope)
        cookie, login = _cookie(headers), scope["app"].state.login
        before = (await self._known(scope, login.by_session, cookie))[1] if cookie else ""
        led = headers.get("sec-fetch-site", "none") not in ("none", "same-origin")
        if led or before not in ("", user):
            return sign_in_page(user, before, link, scope["path"])
        return await self._begin(scope, identifier, user, scope["path"])

    async def _signed_in(self, scope: Scope, receive: Receive) -> Response:
        """Begin a session after the click on the sign-in page."""
        token, to = await sign_in_form(scope, receive)
        login: Login = scope["app"].state.login
        identifier, user = await self._known(scope, login.by_token, token)
        if user:
            return await self._begin(scope, identifier, user, to)
        return self._stranger(scope, tried=True)

    async def _begin(self, scope: Scope, identifier: str, user: str, to: str) -> Response:
        login: Login = scope["app"].state.login
        own = "/" + to.lstrip("/\\")  # //evil.example would lead to another service
        response = RedirectResponse(own, 303)
        response.set_cookie(
            SESSION_COOKIE,
            await asyncio.to_thread(login.begin, identifier, user),
            max_age=SESSION_S,
            httponly=True,
            samesite="strict",
            secure=scope["scheme"] == "https",
        )
        return response

    async def _run_while_open(self, scope: Scope, receive: Receive, answered: Answer) -> bool:
        """Run the application as long as the token or session of its request is valid, and count
        the request.

        Returns
        -------
        False if the application was stopped, and ``answered`` taken over. It is not stopped once
        the answer is complete.
        """
        if OPENED_BY not in scope:
            await self.app(scope, receive, answered.send)
            return True
        concurrency: ConcurrencyLimit = scope["app"].state.concurrency
        with concurrency.hold("connections", current_user.get()):
            working = asyncio.ensure_future(self.app(scope, receive, answered.send))
            try:
                while not (await asyncio.wait({working}, timeout=REMEMBERED_S))[0]:
                    if not await self._is_open(scope) and await answered.take_over():
                        await _stop(working)
                        return False
                await working
                return True
            finally:
                if not working.done():  # this task itself is cancelled
                    await _stop(working)

    async def _is_open(self, scope: Scope) -> bool:
        """Return whether the token or session of a request is valid. A request that ends its own
        session is answered nevertheless."""
        if OPENED_BY not in scope:
            return True
        login: Login = scope["app"].state.login
        try:
            is_open = await self._known(scope, login.is_open, *scope[OPENED_BY])
        except StoreError:  # connections outlast a lost database
            return True
        return is_open or OPENED_BY not in scope

    async def _known(self, scope: Scope, question: Callable[..., T], *given: object) -> T:
        """The answer of a login: at once where it is remembered, otherwise in the turn of the user
        who was known before, or of the stranger's address."""
        try:
            return question(*given, at_once=True)
        except NotRememberedError as unknown:
            async with self.lookups.turn(unknown.user or _address(scope)):
                with contextlib.suppress(NotRememberedError):  # another request was answered
                    return question(*given, at_once=True)
                return await asyncio.to_thread(question, *given)


async def _stop(working: asyncio.Future[None]) -> None:
    """Cancel a task and wait for its end."""
    working.cancel()
    (outcome,) = await asyncio.gather(working, return_exceptions=True)
    if isinstance(outcome, Exception):
        log.warning("a request failed while it was stopped", exc_info=outcome)


def _stopping() -> StoppingError:
    return StoppingError("The service is stopping.")


def _signed_out() -> UnknownUserError:
    return UnknownUserError(
        "The token or session of this request has ended.",
        field="token",
        remedy="Sign in again, or send another token.",
    )


def _is_sign_in(scope: Scope) -> bool:
    return scope["type"] == "http" and (scope["method"], scope["path"]) == ("POST", PATH)


def _address(scope: Scope) -> str:
    return str((scope.get("client") or ("unknown", 0))[0])


def _who(
    login: Login, token: str, link: str, cookie: str, *, at_once: bool = False
) -> tuple[str, str, str]:
    """(token's id, user, session) of a request."""
    if token:  # a header with a token overrides link and cookie
        return *login.by_token(token, at_once=at_once), ""
    if link and (who := login.by_token(link, at_once=at_once))[1]:
        return *who, ""
    session, user = login.by_session(cookie, at_once=at_once) if cookie else ("", "")
    return "", user, session


def _place_of(origin: str) -> str | None:
    """Host and port of an origin, or None if it is malformed."""
    try:
        return urlsplit(origin).netloc.lower()
    except ValueError:
        return None


def _bearer(headers: Headers) -> str:
    scheme, _, value = headers.get("authorization", "").partition(" ")
    return value.strip() if scheme.lower() == "bearer" else ""


def _link_token(query: bytes) -> str:
    if b"token=" not in query:
        return ""
    return parse_qs(query.decode("latin-1")).get("token", [""])[0]


def _cookie(headers: Headers) -> str:
    """The session's cookie; our values are never quoted, and need no unquoting."""
    for pair in headers.get("cookie", "").split(";"):
        name, _, value = pair.strip().partition("=")
        if name == SESSION_COOKIE:
            return value
    return ""


def with_own_cookie_only(headers: list[tuple[bytes, bytes]]) -> list[tuple[bytes, bytes]]:
    """Remove cookies of other programs: Python takes seconds to read 30 kB of backslashes."""
    kept = [(name, value) for name, value in headers if name != b"cookie"]
    if len(kept) < len(headers):
        own = _cookie(Headers(raw=headers))
        if own and '"' not in own:
            kept.append((b"cookie", f"{SESSION_COOKIE}={own}".encode("latin-1")))
    return kept
