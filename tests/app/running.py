"""The service and other programs in processes of their own."""

import contextlib
import os
import re
import socket
import subprocess
import sys
import threading
import time
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import Any

import uvicorn
from starlette.types import ASGIApp

from scripts import serving

POOLS = ("asyncio_", "AnyIO worker", "service_", "drawing_", "pictures_", "QueueFeeder")


def wait_until(true: Callable[[], object], patience_s: float = 150.0) -> None:
    """Wait for something, on a machine that may be busy."""
    deadline = time.monotonic() + patience_s
    while not true():
        assert time.monotonic() < deadline
        time.sleep(0.02)


class Service(serving.Service):
    """The service with one worker, unless the settings say otherwise."""

    def __init__(self, folder: Path, **settings: str) -> None:
        super().__init__(folder, **{"workers": "1"} | settings)

    def unexpected(self) -> str:
        """The first and last lines of each unexpected error in its log."""
        log = self.log.read_text(encoding="utf-8")
        errors = re.findall(r"^.*unexpected error.*(?:\n(?!\d{4}-|\{).*)*", log, re.MULTILINE)
        return "\n\n".join(f"{error[:500]}\n…\n{error[-2_000:]}" for error in errors)


def python(
    *arguments: str | Path, check: bool = True, env: Mapping[str, str] | None = None, **options: Any
) -> subprocess.CompletedProcess[str]:
    """A program of Python that has ended, with variables added to the environment."""
    return subprocess.run(
        [sys.executable, *arguments], check=check, env=os.environ | (env or {}), timeout=300,
        capture_output=True, text=True, **options,
    )  # fmt: skip


def knitcore(
    *arguments: str | Path, env: Mapping[str, str] | None = None
) -> subprocess.CompletedProcess[str]:
    """A command in a process of its own, however it ended."""
    return python("-m", "app.cli.main", *arguments, check=False, env=env)


def threads_of_no_pool() -> list[str]:
    """Names of the threads of this process; pools grow, and on a busy machine more."""
    return [t.name for t in threading.enumerate() if not t.name.startswith(POOLS)]


@contextlib.contextmanager
def on_a_server(app: ASGIApp, **options: Any) -> Iterator[str]:
    """An application on a real server in a thread, with options of uvicorn; yields its address."""
    chosen = {"lifespan": "on"} | options
    server = uvicorn.Server(uvicorn.Config(app, port=0, log_config=None, **chosen))
    with socket.socket() as listener:
        listener.bind(("127.0.0.1", 0))
        thread = threading.Thread(target=server.run, kwargs={"sockets": [listener]})
        thread.start()
        try:
            while not server.started:
                assert thread.is_alive()
                time.sleep(0.01)
            yield f"http://127.0.0.1:{listener.getsockname()[1]}"
        finally:
            server.should_exit = True
            thread.join()
