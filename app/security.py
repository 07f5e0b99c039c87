"""What keeps strangers out: host and origin checks, the token, size limits, response headers.

A browser carries its user's network position to any page it shows, so even a service on loopback
must refuse requests that another site's page makes it send.
"""

from __future__ import annotations

import hmac
from collections.abc import Iterable
from http.cookies import CookieError, SimpleCookie
from urllib.parse import parse_qs, urlsplit

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send
from starlette.websockets import WebSocketClose

from app.problems import Problem, problem_response
from app.settings import Settings

TOKEN_COOKIE = "knitcore_token"  # noqa: S105 - the cookie's name, not a secret
LOOPBACK_NAMES = frozenset({"localhost", "127.0.0.1", "[::1]", "::1"})
OPEN_PATHS = frozenset({"/healthz", "/readyz"})

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


class Guard:
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
        self.token = settings.token.get_secret_value() if settings.token else None

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Check one connection and pass it on."""
        if scope["type"] not in ("http", "websocket"):
            await self.app(scope, receive, send)
            return
        refusal = self._refusal(scope)
        if refusal is not None:
            if scope["type"] == "websocket":
                await WebSocketClose(code=1008, reason="refused")(scope, receive, send)
            else:
                await refusal(scope, receive, send)
            return
        if scope["type"] == "websocket":
            await self.app(scope, receive, send)
            return

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                view = scope["path"].startswith("/view/")
                headers["Content-Security-Policy"] = VIEW_POLICY if view else PAGE_POLICY
                headers["X-Content-Type-Options"] = "nosniff"
                headers["Referrer-Policy"] = "no-referrer"
                headers["Cross-Origin-Opener-Policy"] = "same-origin"
                headers["Cross-Origin-Resource-Policy"] = "same-origin"
            await send(message)

        await self.app(scope, _limited(receive, self.settings.max_body_bytes), send_with_headers)

    def _refusal(self, scope: Scope) -> Response | None:
        headers = Headers(scope=scope)
        host = headers.get("host", "")
        if not self._knows(host):
            return PlainTextResponse("Unknown host name; see KNITCORE_ALLOWED_HOSTS.", 400)
        origin = headers.get("origin")
        changes = scope["type"] == "websocket" or scope["method"] not in ("GET", "HEAD", "OPTIONS")
        if changes and origin is not None and urlsplit(origin).netloc.lower() != host.lower():
            return _refused("origin", "The request comes from a page of another site.", "", 403)
        length = headers.get("content-length", "0")
        if not length.isdigit() or int(length) > self.settings.max_body_bytes:
            return _refused(
                "body",
                "The request is too large.",
                f"Send at most {self.settings.max_body_bytes} bytes.",
                413,
            )
        return self._token_refusal(scope, headers)

    def _knows(self, host: str) -> bool:
        try:
            name = urlsplit(f"//{host}").hostname
        except ValueError:
            return False
        return name is not None and (name in self.hosts or f"[{name}]" in self.hosts)

    def _token_refusal(self, scope: Scope, headers: Headers) -> Response | None:
        if self.token is None or scope["path"] in OPEN_PATHS:
            return None
        if any(hmac.compare_digest(t.encode(), self.token.encode()) for t in _tokens(headers)):
            return None
        offered = parse_qs(scope.get("query_string", b"").decode("latin-1")).get("token", [""])[0]
        if scope["type"] == "http" and hmac.compare_digest(offered.encode(), self.token.encode()):
            # the link with the token: keep it in a cookie and out of the address bar
            response = RedirectResponse(scope["path"], 303)
            response.set_cookie(TOKEN_COOKIE, self.token, httponly=True, samesite="strict")
            return response
        return _refused(
            "token",
            "This service asks for a token.",
            "Open the page as /?token=…, or send the header Authorization: Bearer ….",
            403,
        )


def _tokens(headers: Headers) -> Iterable[str]:
    scheme, _, value = headers.get("authorization", "").partition(" ")
    if scheme.lower() == "bearer":
        yield value.strip()
    try:
        cookie = SimpleCookie(headers.get("cookie", "")).get(TOKEN_COOKIE)
    except CookieError:
        return
    if cookie is not None:
        yield cookie.value


def _refused(field: str, detail: str, remedy: str, status: int) -> Response:
    return problem_response(
        Problem(
            type="refused",
            title="Refused",
            status=status,
            detail=detail,
            field=field,
            remedy=remedy or None,
        )
    )


class BodyTooLargeError(Exception):
    """A body without an honest Content-Length grew beyond the limit."""


def _limited(receive: Receive, limit: int) -> Receive:
    seen = 0

    async def limited() -> Message:
        nonlocal seen
        message = await receive()
        if message["type"] == "http.request":
            seen += len(message.get("body", b""))
            if seen > limit:
                raise BodyTooLargeError
        return message

    return limited
