"""``knitcore serve``."""

from __future__ import annotations

import contextlib
import json
import logging
import os
import resource
import signal
import socket
import sys
from collections.abc import Iterator
from types import FrameType
from typing import TYPE_CHECKING

import click

from knitcore.base.errors import InputError
from knitcore.base.loading import loading

from ..service.settings import Settings
from .common import json_option, user_settings

if TYPE_CHECKING:
    from ..service.store.database import Database

log = logging.getLogger("knitcore.app")

MAX_HANDLES = 65_536
SWITCH_S = 0.0005
"""Longest time that a thread keeps Python's interpreter while the event loop waits for it. The loop
waits several times in each request, so that Python's default of 5 ms would add up."""
MAX_DIGITS = 640
"""Longest whole number that is read, the least that Python allows: time grows with the square."""
SPARE_HANDLES = 400
"""File handles that are kept for databases, workers, views and files."""


@click.command("serve")
@click.option("--host", help="Address to listen on (default: loopback, or KNITCORE_HOST).")
@click.option("--port", type=click.IntRange(0, 65535), help="Port; 0 takes a free one.")
@json_option
def command(host: str | None, port: int | None, as_json: bool) -> None:
    """Start the service and print its address."""
    given = {k: v for k, v in {"host": host, "port": port}.items() if v is not None}
    settings = Settings.model_validate(user_settings().model_dump() | given).check()
    from ..service.problems import ServiceError
    from ..service.web.observing import configure_logging

    os.umask(0o077)  # files are readable by this user only
    configure_logging(settings.log_format)
    try:
        with contextlib.closing(_listen(settings)) as listener:
            address = _address(settings, listener)
            with _prepared(settings, address) as database:
                click.echo(
                    json.dumps({"url": address})
                    if as_json
                    else f"Knitcore is at {address}  (Ctrl+C stops it)"
                )
                serve_on(settings, listener, database)
    except ServiceError as error:
        remedy = f" {error.remedy}" if error.remedy else ""
        raise click.ClickException(f"{error.detail}{remedy}") from error


@contextlib.contextmanager
def _prepared(settings: Settings, address: str) -> Iterator[Database]:
    """Lock and migrate the data, and report failed checks; yields the database to serve."""
    with loading():
        from ..service.doctor import check_folder, examine
        from ..service.store.database import Database
        from ..service.store.schema import migrate

    check_folder(settings.folder)
    settings.make_folder()
    with (
        contextlib.closing(Database(settings.store_url)) as database,
        database.reserved(settings.process_name, address),
    ):
        database.check_pages()
        migrate(database)
        for check in examine(settings, database).failed:
            log.warning("%s: %s %s", check.name, check.problem, check.remedy)
        yield database


def serve_on(settings: Settings, listener: socket.socket, database: Database) -> None:
    """Serve a database on an open socket until a signal ends the service."""
    sys.setswitchinterval(SWITCH_S)
    sys.set_int_max_str_digits(MAX_DIGITS)
    with loading():
        import uvicorn

        from ..service import memory
        from ..service.main import create_app
        from ..service.web.unread import WatchedProtocol
        from ..viewer.incoming import MAX_BYTES
        from ..viewer.sockets import SizedProtocol

        memory.keep_no_large_blocks()
        app = create_app(settings, database)

    class Server(uvicorn.Server):
        async def startup(self, sockets: list[socket.socket] | None = None) -> None:
            await super().startup(sockets)
            memory.freeze_loaded_objects()

        def handle_exit(self, sig: int, frame: FrameType | None) -> None:
            app.state.stopping = True  # so that open streams end instead of holding it up
            super().handle_exit(sig, frame)

    server = Server(
        uvicorn.Config(
            app,
            proxy_headers=bool(settings.trusted_proxies),
            forwarded_allow_ips=[str(network) for network in settings.trusted_proxies],
            server_header=False,
            log_config=None,
            http=WatchedProtocol,
            ws=SizedProtocol,
            limit_concurrency=max(64, _raise_handles() - SPARE_HANDLES),
            ws_per_message_deflate=False,  # deflate drops most frames of an animation
            ws_max_size=MAX_BYTES,
            ws_max_queue=2,
            # longer than clients and proxies keep theirs, or they send on one that closes just then
            timeout_keep_alive=75,
            timeout_graceful_shutdown=3,
        )
    )
    # uvicorn raises the signal again after a clean stop: end like any program, not killed by it
    signal.signal(signal.SIGTERM, lambda *_: sys.exit(0))
    log.info("starts at %s:%s", *listener.getsockname()[:2])
    with contextlib.suppress(KeyboardInterrupt):
        server.run(sockets=[listener])
    log.info("stopped")


def _raise_handles() -> int:
    """Raise the limit on file handles as far as the system allows; returns it."""
    soft, hard = resource.getrlimit(resource.RLIMIT_NOFILE)
    most = MAX_HANDLES if hard == resource.RLIM_INFINITY else min(hard, MAX_HANDLES)
    if soft == resource.RLIM_INFINITY or soft >= most:
        return most
    resource.setrlimit(resource.RLIMIT_NOFILE, (most, hard))
    return most


def _address(settings: Settings, listener: socket.socket) -> str:
    """Return the address for a browser on this machine."""
    shown = "127.0.0.1" if settings.host in ("0.0.0.0", "::") else settings.host  # noqa: S104
    name = f"[{shown}]" if ":" in shown else shown
    return f"http://{name}:{listener.getsockname()[1]}/"


def _listen(settings: Settings) -> socket.socket:
    family = socket.AF_INET6 if ":" in settings.host else socket.AF_INET
    # asyncio turns off Nagle's delay (40 ms an answer) only where the protocol is named
    listener = socket.socket(family, socket.SOCK_STREAM, socket.IPPROTO_TCP)
    listener.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
    try:
        listener.bind((settings.host, settings.port))
        listener.listen(128)  # from now on browsers wait instead of being turned away
    except OSError as error:
        listener.close()
        raise InputError(
            "port",
            f"{settings.host}:{settings.port} cannot be used ({error.strerror}).",
            "If it is a Knitcore that you started, open that address in a browser; otherwise stop "
            "what listens there, or choose another port (--port 0 takes a free one; with make: "
            "make serve OPTIONS='--port 0').",
        ) from error
    return listener
