"""Log lines and numbers for operators: one for every request, with an id to find it by."""

import json
import logging
import re
import secrets
import sys
import time
from collections.abc import Callable
from contextvars import ContextVar
from datetime import UTC, datetime
from typing import Any

from prometheus_client import CollectorRegistry, Counter, Gauge, Histogram, Info, ProcessCollector
from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

from .. import VERSION
from ..identity import current_user

log = logging.getLogger("knitcore.access")
request_id: ContextVar[str | None] = ContextVar("request_id", default=None)

SAFE_ID = re.compile(r"[A-Za-z0-9._-]{1,64}")
QUIET_PATHS = frozenset({"/healthz", "/readyz", "/metrics"})
LIBRARIES = ("websockets", "skfem", "alembic", "uvicorn", "uvicorn.access")
"""Loggers whose routine messages are left out."""
EXTRAS = ("user", "method", "path", "status", "ms", "job", "kind")


class JsonLines(logging.Formatter):
    """One JSON object a line."""

    def format(self, record: logging.LogRecord) -> str:
        """The line of a record."""
        line: dict[str, Any] = {
            "time": datetime.fromtimestamp(record.created, UTC).isoformat(timespec="milliseconds"),
            "level": record.levelname.lower(),
            "logger": record.name,
            "message": record.getMessage(),
        }
        if (request := request_id.get()) is not None:
            line["request_id"] = request
        line |= {name: getattr(record, name) for name in EXTRAS if hasattr(record, name)}
        if record.exc_info:
            line["exception"] = self.formatException(record.exc_info)
        return json.dumps(line, ensure_ascii=False)


class TextLines(logging.Formatter):
    """Lines for people."""

    def __init__(self) -> None:
        super().__init__("%(asctime)s %(levelname)s %(name)s %(message)s")

    def format(self, record: logging.LogRecord) -> str:
        """The line of a record, with its request or job if it has one."""
        extras = {name: getattr(record, name) for name in EXTRAS if hasattr(record, name)}
        if (request := request_id.get()) is not None:
            extras["request"] = request
        context = " ".join(f"{name}={value}" for name, value in extras.items())
        return f"{super().format(record)} {context}".rstrip()


def configure_logging(kind: str) -> None:
    """Log to stderr as ``text`` or ``json`` lines."""
    handler = logging.StreamHandler(sys.stderr)
    handler.setFormatter(JsonLines() if kind == "json" else TextLines())
    logging.basicConfig(level=logging.INFO, handlers=[handler], force=True)
    for library in LIBRARIES:
        logging.getLogger(library).setLevel(logging.WARNING)


class Metrics:
    """Metrics of one application, in their own registry.

    Parameters
    ----------
    gauges : by name, a help text and a function, called each time the metrics are read.
    """

    def __init__(self, gauges: dict[str, tuple[str, Callable[[], float]]]) -> None:
        self.registry = CollectorRegistry()
        self.requests = Counter(
            "knitcore_requests",
            "Requests answered.",
            ["method", "route", "status"],
            registry=self.registry,
        )
        self.seconds = Histogram(
            "knitcore_request_seconds",
            "Time to the end of an answer.",
            ["method", "route"],
            buckets=(0.005, 0.01, 0.025, 0.05, 0.1, 0.25, 0.5, 1.0, 2.5, 10.0, 60.0),
            registry=self.registry,
        )
        Info("knitcore", "The program.", registry=self.registry).info({"version": VERSION})
        ProcessCollector(registry=self.registry)
        for name, (text, value) in gauges.items():
            Gauge(f"knitcore_{name}", text, registry=self.registry).set_function(value)


class Observer:
    """ASGI middleware around everything else: ids, access log and metrics.

    The query is not logged: a link may carry a token in it.
    """

    def __init__(self, app: ASGIApp, metrics: Metrics) -> None:
        self.app = app
        self.metrics = metrics

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Watch one request."""
        if scope["type"] == "websocket":
            await self._watch_socket(scope, receive, send)
            return
        if scope["type"] != "http":
            await self.app(scope, receive, send)
            return
        method = scope["method"]
        if method == "HEAD":  # as GET; the server leaves the content out
            scope = {**scope, "method": "GET"}
        offered = Headers(scope=scope).get("x-request-id", "")
        mark = offered if SAFE_ID.fullmatch(offered) else secrets.token_hex(8)
        request_id.set(mark)
        start, status = time.perf_counter(), 500

        async def watched(message: Message) -> None:
            nonlocal status
            if message["type"] == "http.response.start":
                status = message["status"]
                MutableHeaders(scope=message)["X-Request-ID"] = mark
            await send(message)

        try:
            await self.app(scope, receive, watched)
        finally:
            self._note(scope, method, status, time.perf_counter() - start)

    async def _watch_socket(self, scope: Scope, receive: Receive, send: Send) -> None:
        start, code = time.perf_counter(), 1006  # closed without a word

        async def watched_send(message: Message) -> None:
            nonlocal code
            if message["type"] == "websocket.close":
                code = message.get("code", 1000)
            await send(message)

        async def watched_receive() -> Message:
            nonlocal code
            message = await receive()
            if message["type"] == "websocket.disconnect":
                code = message.get("code", 1005)
            return message

        try:
            await self.app(scope, watched_receive, watched_send)
        finally:
            log.info("websocket", extra=_extra(scope, "GET", code, time.perf_counter() - start))

    def _note(self, scope: Scope, verb: str, status: int, seconds: float) -> None:
        # the route's template (below its prefix), not the address: that would make endless numbers
        route = getattr(scope.get("route"), "path", None) or "other"
        method = verb if verb in METHODS else "other"
        self.metrics.requests.labels(method, route, str(status)).inc()
        self.metrics.seconds.labels(method, route).observe(seconds)
        if scope["path"] in QUIET_PATHS:
            return
        log.info("request", extra=_extra(scope, method, status, seconds))


METHODS = frozenset({"GET", "HEAD", "POST", "PUT", "PATCH", "DELETE", "OPTIONS"})


def _extra(scope: Scope, method: str, status: int, seconds: float) -> dict[str, Any]:
    return {
        "user": current_user.get(),
        "method": method,
        "path": _public_path(scope["path"]),
        "status": status,
        "ms": round(1000 * seconds, 1),
    }


def _public_path(path: str) -> str:
    """A path without the secret of a share link or characters that forge lines or colours."""
    shown = re.sub(r"^(/api/v1/shared/)[^/]+", r"\1…", path)
    return shown.encode("unicode_escape").decode("ascii")[:200]
